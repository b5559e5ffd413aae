"""Recordings cut into folds, each an R factor for every row of eq. 1 that is measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from scipy import optimize

from plantar.conventions import Array, Mask
from plantar.dynamics import BaseParameters, Equation, EquationStream, Motion, RowFactor
from plantar.dynamics.stream import stacked

FOLDS = 6  # over all recordings


@dataclass(frozen=True)
class Samples:
    """One recording ready for eq. 1: finite samples only.

    measured: right side of each row, (N,); extras: further columns of a row, (N,) each; period [s]; positive: which of
    a row's extras have coefficients that may not be negative.
    """

    name: str
    time: Array
    motion: Motion
    measured: Mapping[int, Array]
    extras: Mapping[int, tuple[Array, ...]]
    period: float
    positive: Mapping[int, tuple[bool, ...]] = field(default_factory=dict)

    def select(self, rows: slice | Mask) -> Samples:
        return replace(
            self,
            time=self.time[rows],
            motion=self.motion.select(rows),
            measured={row: values[rows] for row, values in self.measured.items()},
            extras={row: tuple(column[rows] for column in columns) for row, columns in self.extras.items()},
        )


class Folds:
    """The folds' factors. Solutions x are the inertial parameters (10 n_links,), then the extras row by row.

    positive: places among the extras whose coefficients may not be negative.
    """

    def __init__(
        self,
        base: BaseParameters,
        factors: Sequence[Mapping[int, RowFactor]],
        positive: tuple[int, ...] = (),
    ) -> None:
        self.base = base
        self.factors = list(factors)
        self.rows = tuple(self.factors[0])
        self.counts = {row: self.factors[0][row].extras for row in self.rows}
        self.positive = positive

    @classmethod
    def of(cls, equation: Equation, base: BaseParameters, recordings: Sequence[Samples]) -> Folds:
        """Recordings cut in time, so that there are about `FOLDS` of them, and one or more of each recording."""
        first = recordings[0]
        flags = [flag for row in first.measured for flag in first.positive.get(row, ())]
        each = max(1, -(-FOLDS // len(recordings)))
        factors = [
            factors_of(equation, base, samples.select(slice(start, stop)))
            for samples in recordings
            for start, stop in pairwise(np.linspace(0, len(samples.time), each + 1).astype(int))
            if stop > start
        ]
        return cls(base, factors, tuple(place for place, flag in enumerate(flags) if flag))

    def __len__(self) -> int:
        return len(self.factors)

    def but(self, out: int) -> list[int]:
        """Every fold but one."""
        return [k for k in range(len(self)) if k != out]

    def extras_of(self, x: Array) -> dict[int, Array]:
        """Each row's extras in a solution."""
        size = self.base.grouping.shape[1]
        return {row: x[size + start : size + stop] for row, (start, stop) in self._places().items()}

    def triangle(self, chosen: Sequence[int], weights: Mapping[int, float]) -> Array:
        """R of the chosen folds, each row times its weight: base parameters, extras, measured."""
        parts = [pooled([self.factors[k][row] for k in chosen]) for row in self.rows]
        return stacked(parts, len(self.base), [weights[row] for row in self.rows])

    def error(self, chosen: Sequence[int], row: int, x: Array) -> float:
        """Mean squared error of a row over the chosen folds."""
        base = self.base.grouping @ x[: self.base.grouping.shape[1]]
        extras = self.extras_of(x)[row]
        total, samples = 0.0, 0
        for k in chosen:
            factor = self.factors[k][row]
            solution = np.concatenate([base[factor.columns], extras, [-1.0]])
            total += float(np.sum((factor.upper @ solution) ** 2))
            samples += factor.samples
        return total / max(samples, 1)

    def weighted_error(self, chosen: Sequence[int], x: Array, weights: Mapping[int, float]) -> float:
        """Mean over the rows of the chosen folds' mean squared errors, over their weights."""
        return float(np.mean([self.error(chosen, row, x) * weights[row] ** 2 for row in self.rows]))

    def with_known(self, chosen: Sequence[int], inertial: Array) -> Array:
        """Solution with given inertial parameters: least squares of each row's extras by itself."""
        base = self.base.grouping @ inertial
        return np.concatenate([inertial, *(self._row_extras(chosen, row, base) for row in self.rows)])

    def _row_extras(self, chosen: Sequence[int], row: int, base: Array) -> Array:
        """One row's extras beside known base parameters; some may not be negative."""
        count = self.counts[row]
        if count == 0:
            return np.zeros(0)
        factor = pooled([self.factors[k][row] for k in chosen])
        own = len(factor.columns)
        target = factor.upper[:, -1] - factor.upper[:, :own] @ base[factor.columns]
        first = self._places()[row][0]
        lower = [0.0 if first + k in self.positive else -np.inf for k in range(count)]
        return np.asarray(optimize.lsq_linear(factor.upper[:, own:-1], target, (lower, np.inf)).x)

    def _places(self) -> dict[int, tuple[int, int]]:
        places, start = {}, 0
        for row in self.rows:
            places[row] = (start, start + self.counts[row])
            start += self.counts[row]
        return places


def factors_of(equation: Equation, base: BaseParameters, samples: Samples) -> dict[int, RowFactor]:
    """The R factor of every measured row of one recording."""
    rows = tuple(samples.measured)
    stream = EquationStream(equation, base, rows, {row: len(samples.extras.get(row, ())) for row in rows})
    stream.add(samples.motion, samples.measured, samples.extras)
    return stream.factors()


def pooled(factors: Sequence[RowFactor]) -> RowFactor:
    """One row's factors over several folds as one."""
    first = factors[0]
    size = len(first.columns) + first.extras + 1
    if len(factors) == 1:
        return first
    upper = stacked([RowFactor(f.upper, np.arange(size - 1), 0, f.samples) for f in factors], size - 1)
    return RowFactor(upper, first.columns, first.extras, sum(f.samples for f in factors))
