"""The drift of an integrated acceleration, told from true motion: what rests has no velocity; what it shows is drift.

A drift goes on at a slope of its own (a tilt of the attitude) that wanders slowly, and jumps by what was lost between
two samples where the acceleration shakes. Motion is what stands out of it for a while: weights that
reject outliers come down from a convex problem (graduated non-convexity), so that no first guess decides what is
motion. At first the drift is stiff: one that bends freely would follow a slide and reject the samples at rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar import _core
from plantar.conventions import SURE, Array
from plantar.estimation.normal_equations import solved

ANNEALED = 2.0  # by which the weights' reach shrinks in a step
STIFF = 1e8  # by which the first weights are lower than the last
SETTLED = 5  # steps with the final reach
FIRST_DRIFT, FIRST_SLOPE = 1.0, 0.3  # m/s, m/s²: deviations of what is known of both before the first sample
LEAST_JUMP = 1e-10  # m²/s²: a variance above zero, by which the chain of samples can be solved


@dataclass(frozen=True)
class Drift:
    """`value`: (n, 2) [m/s], the columns' part in it; `deviation`: (n,), of either axis [m/s]."""

    value: Array
    deviation: Array


def fit_drift(
    velocity: Array,
    columns: Array,
    unrest: Array,
    jump: Array,
    wander: float,
    noise: float,
    independent: float,
    period: float,
) -> Drift:
    """The drift in a velocity (n, 2) [m/s], NaN where nothing that may rest is seen.

    columns: (m, n, 2), errors of unknown but constant size that may be in it; unrest: (n,), what else says that it
    moves, as a square in usual deviations; jump: (n,), variance of the drift's step from each sample to the next
    [m²/s²]; wander: of its slope, variance in a second [(m/s²)²/s]; noise: deviation of the velocity [m/s], of which a
    share `independent` of the samples shows new one.
    """
    seen, n = np.isfinite(velocity).all(axis=1), len(velocity)
    known = np.nan_to_num(np.concatenate([velocity[None], columns])).transpose(1, 2, 0).reshape(n, -1)
    most = independent / noise**2
    weight = np.asarray(seen * most / STIFF)
    # From one sample to the next the drift goes on by its slope, plus a step; the slope takes one, too.
    chain = (np.maximum(jump, LEAST_JUMP), wander * period, period, (FIRST_DRIFT**-2, FIRST_SLOPE**-2))
    reach, settled = np.inf, 0
    while True:
        beyond = known - _core.smooth_drift(weight, *chain, known)
        # How much of each column is in the velocity, from what the smoother leaves of both, along x and y.
        both = ((beyond * weight[:, None]).T @ beyond).reshape(2, 1 + len(columns), 2, 1 + len(columns))
        products = both[0, :, 0] + both[1, :, 1]
        sizes = solved(products[1:, 1:], products[1:, 0])
        left = beyond.reshape(2 * n, -1) @ np.append(1.0, -sizes)
        square = seen * (np.sum(left.reshape(n, 2) ** 2, axis=1) / (2 * noise**2) + unrest)
        if settled == SETTLED:
            break
        reach = max(1.0, min(2 * float(square.max()) / SURE**2, reach / ANNEALED))
        settled += reach == 1.0
        allowed = reach * SURE**2
        # Geman and McClure's.
        weight = np.asarray(seen * (allowed / (square + allowed)) ** 2 * most / reach**2)
    drift = (known.reshape(2 * n, -1)[:, 0] - left).reshape(n, 2)
    return Drift(drift, np.sqrt(_core.drift_variance(weight, *chain)))
