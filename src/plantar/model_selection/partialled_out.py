"""Partialled-out regression: one offset for each recording and one initial state for each run are eliminated.

Columns that belong to one run or one recording only are eliminated there (Frisch, Waugh and Lovell), so that hundreds
of runs cost nothing. What is left are the columns of the model's own parameters, and each sample's influence on them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array
from plantar.estimation.residual_covariance import cosine_covariance, pooled_freedom
from plantar.estimation.triangular import TriangularFactor

NEGLIGIBLE = 1e-9  # of a column's square left after projection: nothing of its own is left in it


class Linearised:
    """Least squares of `responses` (n,) on `designs` (n, p) of each recording, nuisances projected out.

    `memories` (n,) is the effect of each run's initial state, `runs` (n,) the run of each sample and `counts` how
    many runs each recording has, those without a used sample among them. A shared offset is one more column at the end.
    """

    def __init__(
        self,
        designs: Sequence[Array],
        responses: Sequence[Array],
        shared_offset: bool,
        memories: Sequence[Array] | None = None,
        runs: Sequence[Array] | None = None,
        counts: Sequence[int] = (),
    ) -> None:
        self.responses = list(responses)
        self.shared_offset = shared_offset
        self._designs = list(designs)
        self._memories, self._runs, self._counts = memories, runs, counts
        self._ones = [
            self._project(place, np.ones((len(y), 1)))[:, 0] for place, y in enumerate(self.responses)
        ]
        wide = [np.column_stack([x, np.ones(len(x))]) for x in designs] if shared_offset else self._designs
        self.columns = [self._reduced(place, x) for place, x in enumerate(wide)]
        self._reduced_responses = [
            self._reduced(place, y[:, None])[:, 0] for place, y in enumerate(self.responses)
        ]
        parts = [
            TriangularFactor.of(np.column_stack([x, y]))
            for x, y in zip(self.columns, self._reduced_responses, strict=True)
        ]
        self._factor = parts[0]
        for part in parts[1:]:
            self._factor = self._factor + part
        self._width = designs[0].shape[1]

    def _project(self, place: int, columns: Array) -> Array:
        """Columns (n, m) of one recording without what the runs' initial states explain."""
        if self._memories is None or self._runs is None:
            return columns
        return np.asarray(
            columns - self._memories[place][:, None] * self._shares(place, columns)[self._runs[place]]
        )

    def _shares(self, place: int, columns: Array) -> Array:
        """Share of columns (n, m) that each run's initial state explains, (runs, m); zero where no sample is used."""
        assert self._memories is not None, "asked only where there is a memory"
        assert self._runs is not None, "a memory has runs"
        memory, run, count = self._memories[place], self._runs[place], self._counts[place]
        square = np.bincount(run, memory * memory, count)
        products = np.column_stack([np.bincount(run, memory * column, count) for column in columns.T])
        known = square > NEGLIGIBLE * max(square.max(initial=0.0), 1e-300)
        return np.asarray(np.where(known[:, None], products / np.where(known, square, 1.0)[:, None], 0.0))

    def _reduced(self, place: int, columns: Array) -> Array:
        columns = self._project(place, columns)
        ones = self._ones[place]
        if self.shared_offset or not self._has_offset(place):
            return columns
        return np.asarray(columns - ones[:, None] * (ones @ columns) / (ones @ ones))

    def _has_offset(self, place: int) -> bool:
        ones = self._ones[place]
        return bool(ones @ ones > NEGLIGIBLE * len(ones))

    def solve(self) -> Array:
        """Parameters (p,); the shared offset is left out."""
        return self._factor.solve()[: self._width]

    def offsets(self, values: Array) -> Array:
        """Offset (recordings,) that goes with parameters (p,), initial states held."""
        left = [y - x @ values for x, y in zip(self._designs, self.responses, strict=True)]
        if self.shared_offset:
            return np.full(len(left), np.concatenate(left).mean())
        return np.array([each.mean() for each in left])

    def initial_states(self, values: Array) -> list[Array]:
        """Change of each run's initial state (runs,) that goes with parameters (p,), offsets moving along."""
        if self._memories is None or self._runs is None:
            return [np.zeros(1) for _ in self.responses]
        result = []
        for place, (design, response) in enumerate(zip(self._designs, self.responses, strict=True)):
            left, ones = response - design @ values, self._ones[place]
            if self._has_offset(place) and not self.shared_offset:
                left = left - (ones @ left) / (ones @ ones)
            result.append(self._shares(place, left[:, None])[:, 0])
        return result

    def inverse_diagonal(self) -> Array:
        """Diagonal (p,) of the inverse information: variances for residuals of unit variance."""
        return np.asarray(np.diag(self._factor.information_inverse())[: self._width])

    def influences(self) -> list[Array]:
        """What each sample's response adds to parameters and offsets, (n, p + recordings) for every recording."""
        inverse = self._factor.information_inverse()
        result, count = [], len(self.columns)
        slopes = []
        for place, design in enumerate(self._designs):
            ones = self._ones[place] if self._has_offset(place) else np.zeros(len(design))
            slopes.append((ones @ design) / max(float(ones @ ones), 1e-300))
        for place, columns in enumerate(self.columns):
            own = columns @ inverse
            if self.shared_offset:
                result.append(np.column_stack([own[:, :-1], np.repeat(own[:, -1:], count, axis=1)]))
                continue
            offsets = -own @ np.array(slopes).T
            if self._has_offset(place):
                ones = self._ones[place]
                offsets[:, place] += ones / (ones @ ones)
            result.append(np.column_stack([own, offsets]))
        return result


def robust_covariance(
    linear: Linearised, residuals: Sequence[Array], durations: Sequence[float]
) -> tuple[Array, Array]:
    """Covariance (p + recordings, same) of parameters and offsets with coloured residuals, and degrees of freedom."""
    parts, freedoms = [], []
    for influence, residual, duration in zip(linear.influences(), residuals, durations, strict=True):
        part, freedom = cosine_covariance(influence * residual[:, None], duration)
        parts.append(part)
        freedoms.append(freedom)
    variances = np.array([np.diag(part) for part in parts])
    return np.sum(parts, axis=0), pooled_freedom(variances, np.array(freedoms, dtype=float)[:, None])
