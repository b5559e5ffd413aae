"""Newton's law of all logs together, solved for what each sensor may get wrong.

A generalised least-squares fit of what the law misses to the columns of `moment_errors`, which may be as large as the
robot file says. Its covariance holds coloured noise and a wrong URDF.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.estimation.quantiles import MOST_FREEDOM, fisher_quantile
from plantar.estimation.residual_covariance import pooled_freedom
from plantar.robot.model import RobotModel
from plantar.sensors.moment_errors import LOOSE, MomentErrors, prior_deviations

STRAINED = 2.0  # deviations of its prior, beyond which a gain is looked for anew
ANOTHER_UNIT = 10.0  # share: kgf.m for N.m
# Share of a torque, which landings behind filters of unlike sensors make of it in every step of a simulated walk: all
# parts of a walk agree in it.
LANDINGS = 0.015
CHANCE = 0.01  # that sensors without a fault are called wrong, by deviations that are on the safe side


class Part(NamedTuple):
    """One part of a covariance, and the degrees of freedom that it is known with."""

    covariance: Array
    freedom: float


class Weighted(NamedTuple):
    """One log's rows together, beside its own zeros: `products` (parts, k + 1, k + 1) of missing and columns, `drawn`
    (k, draws) of columns and wrong URDFs, and `beside` (k + 1 + z, k + 1), what of all the log's signals they are.
    """

    products: Array
    drawn: Array
    beside: Array

    def left(self, log: MomentErrors, values: Array) -> Array:
        """What the coefficients `values` (k,) and the zeros that go with them leave of what is missing, (6, n)."""
        shares = self.beside @ np.concatenate([[1.0], -values])
        return np.asarray(shares[0] * log.missing + shares[1:] @ log.columns)


class MomentFit(NamedTuple):
    """Coefficients `values` (k,) of the columns; `parts` of their covariance: of priors, noise and wrong URDFs."""

    values: Array
    parts: list[Part]


def moments_of(robot: RobotModel, logs: Sequence[MomentErrors], steps: bool) -> MomentFit | None:
    """The fit over what each log tells, None without one; `steps`: whether feet step in some."""
    if not logs:
        return None
    prior, gains = prior_deviations(robot), 2 * len(robot.feet)
    fit = solved(logs, prior)
    if np.abs(fit.values[:gains]).max() > STRAINED * LOOSE:
        # Only another unit is so far off: the prior that keeps a gain from passing for other errors would hide it.
        prior[:gains] = ANOTHER_UNIT
        fit = solved(logs, prior)
    if steps:
        alike = np.zeros(len(prior))
        alike[:gains] = LANDINGS**2
        fit = MomentFit(fit.values, [*fit.parts, Part(np.diag(alike), MOST_FREEDOM)])
    return fit


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


def _weights(logs: Sequence[MomentErrors], left: Sequence[Array]) -> list[Array]:
    """Of each log's rows, (6,), by what the fit has `left` of it (6, n): a robot that walks, or that a hand steadies,
    misses more than one that stands alone."""
    return [log.independent / np.mean(own**2, axis=1) for own, log in zip(left, logs, strict=True)]


def _beside_zeros(log: MomentErrors, weights: Array) -> Weighted:
    """What a log tells with its rows weighted (6,), its zeros solved for: no other log shares them."""
    products, drawn = np.einsum("r,prjk->pjk", weights, log.products), np.tensordot(weights, log.drawn, 1)
    shared = products.shape[-1] - len(log.zeros)
    both, known = products.sum(axis=0), np.diag(log.zeros**-2.0)
    share = np.linalg.solve(_positive(both[shared:, shared:]) + known, both[shared:, :shared])
    beside = np.vstack([np.eye(shared), -share])
    # What the zeros' own priors say against a share of them belongs to all parts alike.
    products = beside.T @ products @ beside + share.T @ known @ share / len(products)
    return Weighted(products, beside[:, 1:].T[:, 1:] @ drawn, beside)


def solved(logs: Sequence[MomentErrors], prior: Array) -> MomentFit:
    """The fit with deviations (k,) of the coefficients before the moments are asked, `prior`."""
    values: Array = np.zeros(len(prior))
    known = np.diag(prior**-2.0)
    left = [log.missing for log in logs]
    for _ in range(2):  # weights from what is left, then the coefficients once more
        weighted = [_beside_zeros(*one) for one in zip(logs, _weights(logs, left), strict=True)]
        own = np.concatenate([one.products for one in weighted])
        both = own.sum(axis=0)
        values = _coefficients(both, known)
        left = [one.left(log, values) for one, log in zip(weighted, logs, strict=True)]
    without = np.array([_coefficients(both - part, known) for part in own])
    apart = without - without.mean(axis=0)
    wrong = sum(one.drawn for one in weighted)
    inverse = np.linalg.inv(_positive(both[1:, 1:]) + known)
    moved = inverse @ wrong
    draws = max(moved.shape[1], 1)
    parts = [
        Part(inverse @ known @ inverse, MOST_FREEDOM),
        # The jackknife: so many columns follow the noise of the few frequencies at which a robot sways that what they
        # leave of it tells too little.
        Part((len(own) - 1) / len(own) * (apart.T @ apart), len(own) - 1),
        Part(moved @ moved.T / draws, draws),
    ]
    return MomentFit(values, parts)


def _coefficients(products: Array, known: Array) -> Array:
    """The solution (k,) of products (k + 1, k + 1) of what is missing and its columns, with the prior's `known`."""
    return np.asarray(np.linalg.solve(_positive(products[1:, 1:]) + known, products[1:, 0]))
