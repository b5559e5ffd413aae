"""How likely joints bend, by what each seems to, and how far: a mean over what may be.

Either all joints are as stiff as the robot file says, or all that carry the robot bend, or those of its legs, or those
next to its feet, as far as each other within their own size, which is one of many. In each case other errors may make
joints seem to bend or to push: one or two of them, or all. What the values say of each case weighs it (Bayesian model
averaging).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array

# rad, with the robot's weight at a metre: how far joints may bend that do.
SIZES = np.geomspace(0.003, 0.3, 14)
# Shares of their size by which joints that bend differ from it, all together and each by itself: gears of one robot are
# of one kind, and not of one size.
TOGETHER, OWN = 1.0, 0.5
BEFORE = (
    0.5  # chance that joints bend, before anything is known: half of robots read encoders before the gear
)
# rad, likewise: what other errors, such as an encoder that slips or a link's mass, make one or two joints seem to bend
# by; or all, of these deviations. As likely as not there are none; else one kind is as likely as the other.
SINGLE = 0.25
ALL = np.geomspace(0.01, 0.25, 6)
NONE = 0.5


class BendingOdds(NamedTuple):
    """Chance that joints bend beyond what the robot file says, `chance`; by how much each does, `mean` (k,) and
    `covariance` (k, k): over all cases."""

    chance: float
    mean: Array
    covariance: Array


def bending_odds(values: Array, covariance: Array, bending: Sequence[Array], told: float) -> BendingOdds:
    """By what each joint seems to bend by, `values` (k,) with their `covariance` (k, k).

    bending: which joints may bend while the others are stiff, (k,) of ones and zeros each. told: how far the robot file
    says that they bend. All are of the same unit, with sizes as of `SIZES`.
    """
    every = np.ones(len(values))
    cases = [(0.0 * every, told**2 * alike(every))]
    cases += [(size * some, size**2 * alike(some)) for some in bending for size in np.hypot(SIZES, told)]
    before, errors = _other_errors(len(values))
    chances, means, squares = zip(
        *(_case(values, covariance + errors, expected, spread) for expected, spread in cases), strict=True
    )
    logs = np.log(before) + np.array(chances)
    weights = np.exp(logs - logs.max())
    weights[0] *= (1 - BEFORE) / BEFORE * (len(cases) - 1)
    weights /= weights.sum()
    mean = np.einsum("ct,cti->i", weights, np.array(means))
    square = np.einsum("ct,ctij->ij", weights, np.array(squares))
    return BendingOdds(float(1 - weights[0].sum()), mean, square - np.outer(mean, mean))


def alike(some: Array) -> Array:
    """Covariance (k, k) of how far `some` joints (k,) bend that have a size of one."""
    return TOGETHER**2 * np.outer(some, some) + OWN**2 * np.diag(some)


def _other_errors(count: int) -> tuple[Array, Array]:
    """Chances (t,) and covariances (t, count, count) of what other errors may do."""
    single = np.eye(count)
    few = SINGLE**2 * np.array([*single, *(one + other for one, other in combinations(single, 2))])
    variances = np.vstack([np.zeros(count), few, np.outer(ALL**2, np.ones(count))])
    kind = (1 - NONE) / 2
    chances = np.repeat([NONE, kind / len(few), kind / len(ALL)], [1, len(few), len(ALL)])
    return chances, variances[:, :, None] * np.eye(count)


def _case(values: Array, covariances: Array, expected: Array, spread: Array) -> tuple[Array, Array, Array]:
    """Of joints that bend by `expected` (k,), give or take `spread` (k, k), beside errors of each of the `covariances`
    (t, k, k): logarithms (t,) of how likely the values are, and by how much the joints then bend, means (t, k) and mean
    squares (t, k, k)."""
    seen, off = covariances + spread, values - expected
    likely = -0.5 * (np.linalg.slogdet(seen)[1] + off @ np.linalg.solve(seen, off[:, None])[..., 0].T)
    gains = spread @ np.linalg.inv(seen)
    means = expected + gains @ off
    return likely, means, spread - gains @ spread + means[:, :, None] * means[:, None, :]
