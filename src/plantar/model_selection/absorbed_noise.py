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
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.estimation.residual_covariance import cosine_count
from plantar.model_selection.partialled_out import Linearised

MOST_TRIED = 16  # cosines of one recording: of long ones, whose many are alike, the sum is known from as many
# Stretches in half a period of the quickest cosine: within one it is a constant, and a sum of noise's steps a sample.
STRETCHES = 32


def lacking(linear: Linearised, drifts: Sequence[Array], durations: Sequence[float]) -> Array:
    """By which factor deviations (p,) of a fit's parameters are larger than its residuals' scores say; at least 1.

    linear: the fit about its best point, of recordings of `durations` [s] each, their orthonormal `drifts` (n, m)
    projected out. The factor is the root of the variance that a random walk makes of the parameters, over what the
    scores of its residuals say on average. Not where feet step: it is not the attitude that then makes the noise, nor a
    recording that bounds it.
    """
    count = linear.size
    parts = [
        _Stretches(max(1, len(drift) // (STRETCHES * cosine_count(span))), len(drift))
        for drift, span in zip(drifts, durations, strict=True)
    ]
    columns = linear.by_recording(linear.columns)
    slow = [part.walked(own) for part, own in zip(parts, columns, strict=True)]
    solved, together = linear.inverse(), sum(own.T @ own for own in slow)
    real, shown = np.zeros(count), np.zeros(count)
    nuisances = linear.nuisances()
    for place, (drift, part) in enumerate(zip(drifts, parts, strict=True)):
        influence = columns[place] @ solved[:, :count]
        cosines = part.cosines(cosine_count(durations[place]))
        of_rows = part.spread(cosines)
        forgotten = nuisances[place]
        walked = part.walked(np.column_stack([forgotten - drift @ (drift.T @ forgotten), drift]))
        beside = np.column_stack([columns[place], forgotten, drift])
        real += np.sum(part.walked(influence) ** 2, axis=0)
        for number, own in enumerate(influence.T):
            taken, told = np.split(beside.T @ (own[:, None] * of_rows), [len(solved)])
            left = part.walk(part.sums(own)[:, None] * cosines) - walked @ told
            taken = solved @ taken
            shown[number] += np.sum(left**2) + np.sum(taken * (together @ taken - 2 * (slow[place].T @ left)))
    return np.asarray(np.sqrt(np.maximum(real / np.maximum(shown, np.finfo(float).tiny), 1.0)))


class _Stretches:
    """The `rows` of a recording in stretches of a few, `length`, and what the steps of a random walk over them add."""

    def __init__(self, length: int, rows: int) -> None:
        self._length, self._rows = length, rows
        self._first: NDArray[np.intp] = np.arange(0, rows, length)

    def sums(self, columns: Array) -> Array:
        """Sums of columns (rows, ...) over each stretch."""
        return np.asarray(np.add.reduceat(columns, self._first)) if self._rows else columns

    def spread(self, values: Array) -> Array:
        """Values (stretches, m) at each of the rows, (rows, m)."""
        return np.repeat(values, self._length, axis=0)[: self._rows]

    def walk(self, sums: Array) -> Array:
        """What each step of the walk, one at the start of every stretch, adds to the products with such sums."""
        return np.asarray(np.sqrt(self._length) * np.cumsum(sums[::-1], axis=0))

    def walked(self, columns: Array) -> Array:
        """What each step of the walk adds to the products with columns (rows, m)."""
        return self.walk(self.sums(columns))

    def cosines(self, most: int) -> Array:
        """Those of the recording's cosines, `most` of them, that are tried, weighted as all are."""
        tried = np.unique(np.linspace(1, most, min(most, MOST_TRIED)).round())
        middle = (self._first + np.minimum(self._first + self._length, self._rows)) / 2
        return np.asarray(
            np.sqrt(2 / len(tried)) * np.cos(np.pi * middle[:, None] * tried / max(self._rows, 1))
        )
