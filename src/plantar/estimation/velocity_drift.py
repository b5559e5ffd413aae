"""The drift of an integrated acceleration, told from true motion: what rests has no velocity; what it shows is drift.

A drift goes on at a slope of its own (a tilt of the attitude) that wanders slowly, and jumps by what was lost between
two samples where the acceleration shakes. Motion is what stands out of it for a while: weights that
reject outliers come down from a convex problem (graduated non-convexity), so that no first guess decides what is
motion. At first the drift is stiff: one that bends freely would follow a slide and reject the samples at rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array

OUTLYING = 5.0  # usual deviations: beyond them a sample is motion rather than drift
ANNEALED = 2.0  # by which the weights' reach shrinks in a step
STIFF = 1e8  # by which the first weights are lower than the last
SETTLED = 5  # steps with the final reach
FIRST_DRIFT, FIRST_SLOPE = 1.0, 0.3  # m/s, m/s²: deviations of what is known of both before the first sample
LEAST_JUMP = 1e-10  # m²/s²


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
    seen = np.isfinite(velocity).all(axis=1)
    known = np.nan_to_num(np.concatenate([velocity[None], columns]))
    stacked = known.transpose(1, 0, 2).reshape(len(velocity), -1)
    most = independent / noise**2
    weight = np.asarray(seen * most / STIFF)
    reach, settled = np.inf, 0
    while True:
        matrix = _information(weight, np.maximum(jump, LEAST_JUMP), wander * period, period)
        smooth = _smoothed(matrix, weight, stacked).reshape(len(velocity), -1, 2).transpose(1, 0, 2)
        size = _sizes(known - smooth, weight)
        left = known[0] - smooth[0] - np.tensordot(size, known[1:] - smooth[1:], 1)
        square = seen * (np.sum(left**2, axis=1) / (2 * noise**2) + unrest)
        if settled == SETTLED:
            break
        reach = max(1.0, min(2 * float(square.max()) / OUTLYING**2, reach / ANNEALED))
        settled += reach == 1.0
        allowed = reach * OUTLYING**2
        weight = np.asarray(
            seen * (allowed / (square + allowed)) ** 2 * most / reach**2
        )  # Geman and McClure's
    return Drift(known[0] - left, _deviation(matrix))


def _sizes(left: Array, weight: Array) -> Array:
    """How much of each column, (m,), is in the velocity, from what the smoother leaves of both, (1 + m, n, 2)."""
    flat = (left * np.sqrt(weight)[:, None]).reshape(len(left), -1)
    length = np.linalg.norm(flat, axis=1) + 1e-12
    solved = np.linalg.lstsq((flat[1:] / length[1:, None]).T, flat[0], rcond=1e-6)[0]
    return np.asarray(solved / length[1:])


def _information(weight: Array, jump: Array, wander: float, period: float) -> Array:
    """Information about drift and slope of each sample by turns, as the (4, 2n) upper diagonals of a banded matrix.

    From one sample to the next the drift goes on by slope·period, plus a step of variance `jump`; the slope takes one
    of variance `wander`.
    """
    band, step = np.zeros((4, 2 * len(weight))), 1 / jump[:-1]
    band[3, 0::2] = weight
    band[3, 0:-2:2] += step
    band[3, 2::2] += step
    band[1, 2::2] = -step
    band[3, 1:-2:2] += step * period**2 + 1 / wander
    band[3, 3::2] += 1 / wander
    band[1, 3::2] = -1 / wander
    band[2, 1:-2:2] = step * period
    band[2, 2::2] = -step * period
    band[3, :2] += 1 / FIRST_DRIFT**2, 1 / FIRST_SLOPE**2
    return band


def _smoothed(band: Array, weight: Array, values: Array) -> Array:
    """The drift that fits `values` (n, k) best, each column by itself."""
    from scipy.linalg import solveh_banded  # costs start-up

    right = np.zeros((band.shape[1], values.shape[1]))
    right[0::2] = weight[:, None] * values
    return np.asarray(solveh_banded(band, right)[0::2])


def _deviation(band: Array) -> Array:
    """Deviation (n,) of the drift: the inverse's diagonal, block by block, forth (elimination) and back."""
    own = np.stack([band[3, 0::2], band[2, 1::2], band[3, 1::2]], axis=1).tolist()
    onward = np.stack([band[1, 2::2], band[2, 2::2], band[0, 3::2], band[1, 3::2]], axis=1).tolist()
    inverses: list[tuple[float, float, float]] = []
    a, b, c = own[0]
    for place in range(len(own)):
        if place:
            # The next block less onwardᵀ · inverse · onward of this one.
            (p, q, r), (dd, sd, ds, ss) = inverses[-1], onward[place - 1]
            pd, qd, ps, qs = p * dd + q * sd, q * dd + r * sd, p * ds + q * ss, q * ds + r * ss
            a, b, c = own[place]
            a, b, c = a - dd * pd - sd * qd, b - dd * ps - sd * qs, c - ds * ps - ss * qs
        size = a * c - b * b
        inverses.append((c / size, -b / size, a / size))
    u, v, w = inverses[-1]
    variance = [u]
    for (p, q, r), (dd, sd, ds, ss) in zip(inverses[-2::-1], onward[::-1], strict=True):
        # inverse + gain · covariance of the next · gainᵀ, gain = inverse · onward
        pd, qd, ps, qs = p * dd + q * sd, q * dd + r * sd, p * ds + q * ss, q * ds + r * ss
        u, v, w = (
            p + pd * pd * u + 2 * pd * ps * v + ps * ps * w,
            q + pd * qd * u + (pd * qs + ps * qd) * v + ps * qs * w,
            r + qd * qd * u + 2 * qd * qs * v + qs * qs * w,
        )
        variance.append(u)
    return np.asarray(np.sqrt(variance[::-1]))
