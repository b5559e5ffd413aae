"""The rows of a linear fit, recording by recording, and what a fit of them says."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.estimation.orthonormal import orthonormal

SINGULAR = 1e6  # condition of a fit beyond which its motions do not tell one column from the others


@dataclass(frozen=True)
class StanceRows:
    """Where a foot steps: the `number` (n,) of each row's stance, which has an offset of its own, and `weight` (n,)."""

    number: NDArray[np.intp]
    weight: Array

    def split(self) -> list[NDArray[np.intp]]:
        """The rows of each stance."""
        return self._rows

    @cached_property
    def _rows(self) -> list[NDArray[np.intp]]:
        order = np.argsort(self.number, kind="stable")
        ends = np.flatnonzero(np.diff(self.number[order])) + 1
        return np.split(order, ends) if order.size else []


@dataclass(frozen=True)
class Block:
    """One recording's rows: `regressor` (n, k) without the offset's column, `response` (n,), `period` [s].

    Rows may be every `thinned`th sample of a filtered signal, `period` apart: white residuals are those of all samples.
    `nuisance` (n, m) are orthonormal columns of this recording alone, fitted beside its offset and then forgotten;
    `noise` (k,) is the variance of what is noise in the regressor's columns.

    Where a foot steps, rows have `stances`, and `common_nuisance` (n, j) are columns that all recordings share beside
    the regressor's; `common_spread` (j,) is the deviation of their coefficients about zero before any data, infinite
    where nothing is known.
    """

    label: str
    regressor: Array
    response: Array
    period: float
    thinned: int = 1
    nuisance: Array | None = None
    noise: Array | None = None
    stances: StanceRows | None = None
    common_nuisance: Array | None = None
    common_spread: Array | None = None

    def part(self, rows: NDArray[np.intp]) -> Block:
        """The block with these rows alone."""
        return replace(
            self,
            regressor=self.regressor[rows],
            response=self.response[rows],
            nuisance=None if self.nuisance is None else orthonormal(self.nuisance[rows]),
            stances=self.stances and StanceRows(self.stances.number[rows], self.stances.weight[rows]),
            common_nuisance=None if self.common_nuisance is None else self.common_nuisance[rows],
        )

    def with_nuisance(self, columns: Array) -> Block:
        """The block with more columns (n, m) of its own to forget, beside those there."""
        own = orthonormal(columns, self.nuisance)
        return replace(self, nuisance=own if self.nuisance is None else np.hstack([self.nuisance, own]))

    @property
    def duration(self) -> float:
        return len(self.response) * self.period

    @property
    def rows(self) -> float:
        """How many rows there are, by their weights."""
        return float(len(self.response) if self.stances is None else self.stances.weight.sum())


@dataclass(frozen=True)
class LinearFit:
    """Parameters common to all recordings, then offsets: one per recording, or a single shared one.

    `values` (k,), `offsets` by recording's label; `covariance` of both, in this order, allows for
    autocorrelated residuals, `white_covariance` assumes white ones (the paper's). `freedom` goes with `covariance`.
    `common_nuisance` (j,) are the coefficients of the blocks' columns of that name.
    """

    values: Array
    offsets: dict[str, float]
    covariance: Array
    white_covariance: Array
    freedom: Array
    residuals: dict[str, Array]
    rank: int
    condition_number: float
    shared_offset: bool
    common_nuisance: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def singular(self) -> bool:
        """Whether the motions do not tell its columns apart."""
        return not self.condition_number <= SINGULAR

    @property
    def std(self) -> Array:
        """Standard deviations of `values`, robust to coloured residuals, (k,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance))[: len(self.values)])

    @property
    def white_std(self) -> Array:
        """Standard deviations of `values` for white residuals, (k,)."""
        return np.asarray(np.sqrt(np.diag(self.white_covariance))[: len(self.values)])

    @property
    def squares(self) -> float:
        """The sum of the residuals' squares."""
        return sum(float(residual @ residual) for residual in self.residuals.values())

    def offset_std(self, label: str) -> float:
        """Standard deviation of a recording's offset."""
        place = 0 if self.shared_offset else list(self.offsets).index(label)
        return float(np.sqrt(self.covariance[len(self.values) + place, len(self.values) + place]))

    def predict(self, regressor: Array, offset: float) -> Array:
        """Response (n,) of `regressor` (n, k) with a given offset."""
        return np.asarray(regressor @ self.values + offset)
