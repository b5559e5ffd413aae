"""Covariance of a regularised fit: from autocorrelated residuals and from the regularisation itself."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.estimation.residual_covariance import cosine_covariance
from plantar.whole_body.folds import Samples
from plantar.whole_body.regularised_fit import RegularisedFit, normal_of

CHUNK = 2048  # samples whose regressor is held at a time
# Weight where the inertial parameters are given: they have no deviation of their own.
GIVEN_REGULARISATION = 1e12


@dataclass(frozen=True)
class Uncertainty:
    """Standard deviations of the base parameters (n_base,), of each row's extras, and Student's degrees of freedom."""

    base: Array
    extras: dict[int, Array]
    freedom: float


def uncertainty(fit: RegularisedFit, recordings: Sequence[Samples]) -> Uncertainty:
    """`uncertainty_from` recordings that are all in memory."""
    return uncertainty_from(fit, [score_covariance(fit, samples) for samples in recordings])


def score_covariance(fit: RegularisedFit, samples: Samples) -> tuple[Array, float]:
    """Covariance (n, n) of the sum of one recording's scores, and on how many cosines it rests."""
    return cosine_covariance(_scores(fit, samples), len(samples.time) * samples.period)


def uncertainty_from(fit: RegularisedFit, scored: Iterable[tuple[Array, float]]) -> Uncertainty:
    """Sandwich H⁻¹ (S + s² t² 1) H⁻¹ in the prior's units: S from the coloured scores, s the regularisation weight.

    The second part is the bias of the regularisation: t² is how far the CAD is from the robot, judged by how far the
    fit moved in the directions that the data decide.

    scored: of each recording, as `score_covariance` gives it.
    """
    n_base, size = len(fit.base), len(fit.prior.cad)
    normal = normal_of(fit.base, fit.prior, fit.triangle)
    onto = np.zeros((n_base + len(normal.scale), size + len(normal.scale)))
    onto[:n_base, :size] = fit.base.grouping @ fit.prior.spread
    onto[n_base:, size:] = np.diag(normal.scale)
    given = np.isinf(fit.regularisation)
    regularisation = GIVEN_REGULARISATION if given else fit.regularisation
    ridge = np.concatenate([np.full(size, regularisation), np.full(len(normal.scale), 1e-9)])
    inverse = np.linalg.inv(normal.square + np.diag(ridge))
    moved = np.linalg.solve(fit.prior.spread, fit.inertial - fit.prior.cad)
    # Share of the truth's distance that the fit shows.
    kept = np.eye(size) - regularisation * inverse[:size, :size]
    decided = max(float(np.sum(kept * kept.T)), 1.0)
    error = 0.0 if given else regularisation**2 * float(moved @ moved) / decided
    meat = np.diag(np.concatenate([np.full(size, error), np.zeros(len(normal.scale))]))
    freedom = 0.0
    for covariance, cosines in scored:
        meat += onto.T @ covariance @ onto
        freedom += cosines
    spread = onto @ inverse @ meat @ inverse @ onto.T
    std = np.sqrt(np.maximum(np.diag(spread), 0.0))
    extras, start = {}, n_base
    for row, values in fit.extras.items():
        extras[row] = std[start : start + len(values)]
        start += len(values)
    return Uncertainty(std[:n_base], extras, freedom)


def _scores(fit: RegularisedFit, samples: Samples) -> Array:
    """Weighted regressor times residual of every sample, (N, n_base + n_extras)."""
    predicted = fit.predict(samples)
    rows = list(samples.measured)
    residual = {row: fit.weights[row] ** 2 * (samples.measured[row] - predicted[row]) for row in rows}
    total = len(fit.base) + sum(len(values) for values in fit.extras.values())
    scores = np.zeros((len(samples.time), total))
    masks = fit.base.masks
    for start in range(0, len(samples.time), CHUNK):
        part = slice(start, start + CHUNK)
        regressor = fit.equation.regressor(samples.motion.select(part), masks)
        for row in rows:
            scores[part, : len(fit.base)] += (regressor[row] * residual[row][part]).T
    column = len(fit.base)
    for row, values in fit.extras.items():
        for k in range(len(values)):
            scores[:, column] = samples.extras[row][k] * residual[row]
            column += 1
    return scores
