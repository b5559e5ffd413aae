"""Partialled-out regression: one offset for each recording and one initial state for each run are eliminated.

Columns that belong to one run or one recording only are eliminated there (Frisch, Waugh and Lovell), so that hundreds
of runs cost nothing. What is left are the columns of the model's own parameters, and each sample's influence on them.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.estimation.orthonormal import RANK_TOLERANCE
from plantar.estimation.residual_covariance import cosine_covariance, pooled_freedom
from plantar.estimation.triangular import TriangularFactor


class Memory(NamedTuple):
    """The `effect` (n,) of each run's initial state, the `run` (n,) of each sample, numbered through all recordings,
    and how many runs each recording has, `counts` (recordings,), those without a used sample among them."""

    effect: Array
    run: NDArray[np.intp]
    counts: Sequence[int]


class Linearised:
    """Least squares of `response` (n,) on `design` (n, p), nuisances projected out.

    Samples of all recordings stand one below the other, `rows` (recordings,) of each. A shared offset is one more
    column at the end.
    """

    def __init__(
        self,
        design: Array,
        response: Array,
        rows: Sequence[int],
        shared_offset: bool,
        memory: Memory | None = None,
    ) -> None:
        self.shared_offset = shared_offset
        self._design, self._response, self._rows, self._memory = design, response, rows, memory
        ends = np.cumsum(rows)
        self._own = [slice(end - count, end) for end, count in zip(ends, rows, strict=True)]
        self._ones = self._project(np.ones((len(response), 1)))[:, 0]
        square = self._products(self._ones[:, None])[:, 0]
        self._has_offset = square > RANK_TOLERANCE * np.asarray(rows)
        self._square = np.where(self._has_offset, square, np.inf)
        wide = np.column_stack(
            [design, np.ones(len(design)), response] if shared_offset else [design, response]
        )
        reduced = self._reduced(wide)
        self._columns = reduced[:, :-1]
        self._factor = TriangularFactor.of(reduced)

    def _products(self, columns: Array) -> Array:
        """Of columns (n, m) with what is left of each recording's offset, (recordings, m)."""
        return np.array([self._ones[own] @ columns[own] for own in self._own])

    def _project(self, columns: Array) -> Array:
        """Columns (n, m) without what the runs' initial states explain."""
        if self._memory is None:
            return columns
        return np.asarray(columns - self._memory.effect[:, None] * self._shares(columns)[self._memory.run])

    def _shares(self, columns: Array) -> Array:
        """Share of columns (n, m) that each run's initial state explains, (runs, m); zero where no sample is used."""
        assert self._memory is not None, "asked only where there is a memory"
        effect, run, counts = self._memory
        products = np.column_stack([np.bincount(run, effect * column, sum(counts)) for column in columns.T])
        return np.asarray(products / self._effects[:, None])

    @cached_property
    def _effects(self) -> Array:
        """Square of each run's effect, (runs,); infinite where nothing is left of it."""
        assert self._memory is not None, "asked only where there is a memory"
        effect, run, counts = self._memory
        square = np.bincount(run, effect * effect, sum(counts))
        largest = np.maximum.reduceat(square, np.cumsum([0, *counts[:-1]]))
        known = square > RANK_TOLERANCE * np.repeat(np.maximum(largest, 1e-300), counts)
        return np.where(known, square, np.inf)

    def _reduced(self, columns: Array) -> Array:
        columns = self._project(columns)
        if self.shared_offset:
            return columns
        levels = self._products(columns) / self._square[:, None]
        return np.asarray(columns - self._ones[:, None] * np.repeat(levels, self._rows, axis=0))

    def solve(self) -> Array:
        """Parameters (p,); the shared offset is left out."""
        return self._factor.solve()[: self.size]

    def offsets(self, values: Array) -> Array:
        """Offset (recordings,) that goes with parameters (p,), initial states held."""
        left = self._response - self._design @ values
        if self.shared_offset:
            return np.full(len(self._rows), left.mean())
        return np.array([left[own].mean() for own in self._own])

    def initial_states(self, values: Array) -> Array:
        """Change of each run's initial state (runs,) that goes with parameters (p,), offsets moving along; zero without
        a memory."""
        if self._memory is None:
            return np.zeros(1)
        left = self._response - self._design @ values
        if not self.shared_offset:
            left = left - np.repeat(self._products(left[:, None])[:, 0] / self._square, self._rows)
        return self._shares(left[:, None])[:, 0]

    @property
    def size(self) -> int:
        """Parameters, p; the shared offset is left out."""
        return int(self._design.shape[1])

    @property
    def columns(self) -> Array:
        """What is left of the design, and of a shared offset's column, beside the nuisances, (n, p or p + 1)."""
        return self._columns

    def by_recording(self, columns: Array) -> list[Array]:
        """Columns (n, m), those of each recording."""
        return [columns[own] for own in self._own]

    def nuisances(self) -> list[Array]:
        """Orthonormal columns (n, m) of what each recording's offset and its runs' initial states explain."""
        found = []
        for place, own in enumerate(self._own):
            columns = np.zeros((self._rows[place], 0))
            if not self.shared_offset:
                columns = self._ones[own, None] / np.sqrt(self._square[place])
            if self._memory is not None:
                effect, run, counts = self._memory
                runs = np.arange(counts[place]) + sum(counts[:place])
                states = np.where(run[own, None] == runs, effect[own, None], 0.0)
                columns = np.column_stack([columns, states / np.sqrt(self._effects[runs])])
            found.append(columns)
        return found

    def inverse(self) -> Array:
        """The inverse information of `columns`."""
        return self._factor.information_inverse()

    def inverse_diagonal(self) -> Array:
        """Diagonal (p,) of the inverse information: variances for residuals of unit variance."""
        return np.asarray(np.diag(self.inverse())[: self.size])

    def influences(self) -> list[Array]:
        """What each sample's response adds to parameters and offsets, (n, p + recordings) for every recording."""
        own, count = self._columns @ self._factor.information_inverse(), len(self._rows)
        if self.shared_offset:
            both = np.column_stack([own[:, :-1], np.repeat(own[:, -1:], count, axis=1)])
        else:
            slopes = self._products(self._design) / self._square[:, None]
            offsets = -own @ slopes.T
            for place, samples in enumerate(self._own):
                offsets[samples, place] += self._ones[samples] / self._square[place]
            both = np.column_stack([own, offsets])
        return [both[samples] for samples in self._own]


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
