"""How much of the noise a fit of a memory takes up itself: what residuals do not show of it, deviations lack.

An element slips a few times in half a minute, and its slip torque and slip angle are told by these moments alone. A fit
follows the noise there, so that the residuals just where they decide are too small. By how much is known where the
noise's colour is, and hardly depends on it (R. M. Bell, D. F. McCaffrey, Survey Methodology 28, 2002; G. W. Imbens,
M. Kolesár, Rev. Economics and Statistics 98, 2016): what is left of it here is that of a random walk, as a gyroscope
makes of an attitude.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array
from plantar.estimation.residual_covariance import cosine_count
from plantar.model_selection.data_sets import FilteredDataSet
from plantar.model_selection.partialled_out import Linearised

MOST_TRIED = 16  # cosines of one recording: of long ones, whose many are alike, the sum is known from as many


def lacking(linear: Linearised, prepared: Sequence[FilteredDataSet], durations: Sequence[float]) -> Array:
    """By which factor deviations (p,) of a fit's parameters are larger than its residuals' scores say; at least 1.

    linear: the fit of the `prepared` recordings about its best point, of `durations` [s] each. The factor is the root
    of the variance that a random walk makes of the parameters, over what the scores of its residuals say on average.
    1 where feet step: it is not the attitude that then makes the noise, nor a recording that bounds it.
    """
    count = linear.size
    if any(each.steps is not None for each in prepared):
        return np.ones(count)
    influences = [own[:, :count] for own in linear.influences()]
    solved, cosines = linear.inverse(), [cosine_count(span) for span in durations]

    def walked(columns: Array) -> list[Array]:
        """What the steps of each recording's walk, without its slow part, add to products with columns (n, m)."""
        return [
            np.cumsum(each.without_nuisance(own)[::-1], axis=0)
            for each, own in zip(prepared, linear.by_recording(columns), strict=True)
        ]

    real = sum(np.sum(own**2, axis=0) for own in walked(np.concatenate(influences)))
    columns = walked(linear.columns)
    together = sum(own.T @ own for own in columns)
    shown = np.zeros(count)
    for place in range(MOST_TRIED):
        scores = [_score(own, place, most) for own, most in zip(influences, cosines, strict=True)]
        weighted = np.concatenate(scores)
        left = walked(linear.without_nuisances(weighted))
        for own, score, column, fitted in zip(
            left, scores, columns, linear.by_recording(linear.columns), strict=True
        ):
            taken = solved @ (fitted.T @ score)
            shown += np.sum(own**2, axis=0) - 2 * np.sum((column.T @ own) * taken, axis=0)
            shown += np.sum(taken * (together @ taken), axis=0)
    return np.asarray(np.sqrt(np.maximum(real / np.maximum(shown, np.finfo(float).tiny), 1.0)))


def _score(influence: Array, place: int, most: int) -> Array:
    """Influences (n, p) times the cosine number `place` of those of `most` that are tried, weighted as all are."""
    tried = np.unique(np.linspace(1, most, min(most, MOST_TRIED)).round())
    if place >= len(tried) or not len(influence):
        return np.zeros_like(influence)
    phase = np.pi * tried[place] * (np.arange(len(influence)) + 0.5) / len(influence)
    return np.asarray(np.sqrt(2 / len(tried)) * np.cos(phase)[:, None] * influence)
