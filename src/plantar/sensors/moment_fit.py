"""Newton's law of all logs together, solved for what each sensor may get wrong.

A generalised least-squares fit of what the law misses to the columns of `moment_errors`, which may be as large as the
robot file says, and to what a URDF may get wrong. Its covariance holds coloured noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.estimation.quantiles import MOST_FREEDOM, fisher_quantile
from plantar.estimation.residual_covariance import pooled_freedom
from plantar.robot.model import RobotModel
from plantar.sensors.moment_errors import MomentErrors
from plantar.sensors.sensor_errors import LOOSE, prior_deviations

STRAINED = 2.0  # deviations of its prior and its own, beyond which a gain is of another unit
ANOTHER_UNIT = 10.0  # share: kgf.m for N.m
# Share of a torque, which landings behind filters of unlike sensors make of it in every step of a simulated walk: all
# parts of a walk agree in it.
LANDINGS = 0.01
CHANCE = 0.01  # that sensors without a fault are called wrong, by deviations that are on the safe side


class Part(NamedTuple):
    """One part of a covariance, and the degrees of freedom that it is known with."""

    covariance: Array
    freedom: float


class Beside(NamedTuple):
    """Products of what is missing and its columns beside other columns, which are solved for: `products` (parts,
    k + 1, k + 1), and `shares` (k + 1 + others, k + 1), what of all signals they are."""

    products: Array
    shares: Array


class MomentFit(NamedTuple):
    """Coefficients `values` (k,) of the sensors' columns; `parts` of their covariance: of priors and of noise."""

    values: Array
    parts: list[Part]


def moments_of(robot: RobotModel, logs: Sequence[MomentErrors], steps: bool) -> MomentFit | None:
    """The fit over what each log tells, None without one; `steps`: whether feet step in some."""
    if not logs:
        return None
    prior, gains = prior_deviations(robot), 2 * len(robot.feet)
    fit = solved(logs, prior)
    # Only another unit is so far off: the prior that keeps a gain from passing for other errors would hide it.
    free = solved(logs, np.append(np.full(gains, ANOTHER_UNIT), prior[gains:]))
    if _far_off(free, len(robot.feet)):
        fit = free
    if steps:
        alike = np.zeros(len(prior))
        alike[:gains] = LANDINGS**2
        fit = MomentFit(fit.values, [*fit.parts, Part(np.diag(alike), MOST_FREEDOM)])
    return fit


def _far_off(fit: MomentFit, feet: int) -> bool:
    """Whether the feet's mean gain about an axis is certainly larger than a fault of an amplifier."""
    mean = np.kron(np.eye(len(ROTATIONAL_AXES)), np.full(feet, 1 / feet))
    gains = slice(len(ROTATIONAL_AXES) * feet)
    variance = np.sum([np.diag(mean @ part.covariance[gains, gains] @ mean.T) for part in fit.parts], axis=0)
    return bool((np.abs(mean @ fit.values[gains]) > STRAINED * (LOOSE + np.sqrt(variance))).any())


def is_wrong(values: Array, parts: Sequence[Part], some: list[int]) -> bool:
    """Whether `some` values are larger than their covariance, the sum of `parts`, lets them be by chance."""
    own = np.array([part.covariance[np.ix_(some, some)] for part in parts])
    weights = np.linalg.solve(own.sum(axis=0), values[some])
    count, variances = len(weights), np.einsum("i,kij,j->k", weights, own, weights)
    freedom = float(pooled_freedom(variances[:, None], np.array([[part.freedom] for part in parts]))[0])
    limit = count * fisher_quantile(1 - CHANCE, count, max(freedom - count, 2))
    return bool(weights @ values[some] > limit)


def _positive(products: Array) -> Array:
    """The nearest products (k, k) that real columns can have: noise taken off may leave less than nothing."""
    with suppress(np.linalg.LinAlgError):  # raised where it does
        np.linalg.cholesky(products)
        return products
    sizes, vectors = np.linalg.eigh(products)
    return np.asarray((vectors * np.maximum(sizes, 0.0)) @ vectors.T)


def _beside(products: Array, deviations: Array) -> Beside:
    """Beside the last columns of `products` (parts, k + 1 + others, ...), of which coefficients are drawn towards
    nothing with `deviations` (others,)."""
    kept = products.shape[-1] - len(deviations)
    own, across, others = products[:, :kept, :kept], products[:, kept:, :kept], products[:, kept:, kept:]
    known = np.diag(deviations**-2.0)
    share = np.linalg.solve(_positive(others.sum(axis=0)) + known, across.sum(axis=0))
    taken = share.T @ across
    # What the others' own priors say against a share of them belongs to all parts alike.
    without = own - taken - taken.mT + share.T @ (others @ share) + share.T @ known @ share / len(products)
    return Beside(without, np.vstack([np.eye(kept), -share]))


def _weighed(log: MomentErrors, left: Array) -> Array:
    """Products of a log's rows together, by what the fit has `left` of them (6,), mean squares: a robot that walks, or
    that a hand steadies, misses more than one that stands alone."""
    return np.asarray(np.tensordot(log.share / left, log.products, 1))


def solved(logs: Sequence[MomentErrors], prior: Array) -> MomentFit:
    """The fit with deviations (k,) of the sensors' coefficients before the moments are asked, `prior`."""
    links = logs[0].power.shape[-1] - 1 - len(prior) - len(logs[0].zeros)
    known = np.diag(prior**-2.0)
    left = [log.power[:, 0, 0] for log in logs]
    for _ in range(2):  # weights from what is left, then the coefficients once more
        # No other log shares a log's zeros; all logs share the links.
        each = [_beside(_weighed(*one), one[0].zeros) for one in zip(logs, left, strict=True)]
        parts, shares = _beside(np.concatenate([one.products for one in each]), np.ones(links))
        both = parts.sum(axis=0)
        values = _coefficients(both, known)
        remains = shares @ np.append(1.0, -values)
        left = [
            np.einsum("rjk,j,k->r", log.power, *2 * [one.shares @ remains])
            for one, log in zip(each, logs, strict=True)
        ]
    without = np.array([_coefficients(both - part, known) for part in parts])
    apart = without - without.mean(axis=0)
    inverse, size = np.linalg.inv(_positive(both[1:, 1:]) + known), len(both)
    # What may be wrong by a deviation each: sensors, links and zeros, as shares of the sensors' coefficients.
    wrong = [np.diag(1 / prior), shares[size:, 1:]]
    for one, log in zip(each, logs, strict=True):
        wrong.append(((one.shares @ shares)[len(shares) :] / log.zeros[:, None])[:, 1:])
    moved = inverse @ np.concatenate(wrong).T
    covariances = [
        Part(moved @ moved.T, MOST_FREEDOM),
        # The jackknife: so many columns follow the noise of the few frequencies at which a robot sways that what they
        # leave of it tells too little.
        Part((len(parts) - 1) / len(parts) * (apart.T @ apart), len(parts) - 1),
    ]
    return MomentFit(values, covariances)


def _coefficients(products: Array, known: Array) -> Array:
    """The solution (k,) of products (k + 1, k + 1) of what is missing and its columns, with the prior's `known`."""
    return np.asarray(np.linalg.solve(_positive(products[1:, 1:]) + known, products[1:, 0]))
