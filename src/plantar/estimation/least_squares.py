"""Linear fits over several recordings (eq. 6 and 7) with an offset each, or one for all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array
from plantar.estimation.intervals import cosine_covariance, pooled_freedom
from plantar.estimation.triangular import TriangularFactor


@dataclass(frozen=True)
class Block:
    """One recording's rows: `regressor` (n, k) without the offset's column, `response` (n,), `period` [s].

    `nuisance` (n, m) are columns of this recording alone, fitted beside its offset and then forgotten; `noise` (k,) is
    the variance of what is noise in the regressor's columns.
    """

    label: str
    regressor: Array
    response: Array
    period: float
    nuisance: Array | None = None
    noise: Array | None = None

    @property
    def duration(self) -> float:
        return len(self.response) * self.period


@dataclass(frozen=True)
class LinearFit:
    """Parameters common to all recordings, then offsets: one per recording, or a single shared one.

    `values` (k,), `offsets` by recording's label; `covariance` of values, offsets and nuisances, in this order, holds
    with coloured residuals, `white_covariance` assumes white ones (the paper's). `freedom` goes with `covariance`.
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

    @property
    def std(self) -> Array:
        """Standard deviations of `values`, robust to coloured residuals, (k,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance))[: len(self.values)])

    @property
    def white_std(self) -> Array:
        """Standard deviations of `values` for white residuals, (k,)."""
        return np.asarray(np.sqrt(np.diag(self.white_covariance))[: len(self.values)])

    def offset_std(self, label: str) -> float:
        """Standard deviation of a recording's offset."""
        place = 0 if self.shared_offset else list(self.offsets).index(label)
        return float(np.sqrt(self.covariance[len(self.values) + place, len(self.values) + place]))

    def predict(self, regressor: Array, offset: float) -> Array:
        """Response (n,) of `regressor` (n, k) with a given offset."""
        return np.asarray(regressor @ self.values + offset)


def fit_linear(blocks: Sequence[Block], *, shared_offset: bool = False) -> LinearFit:
    """Least squares of response = regressor · values + offset over all blocks.

    With `shared_offset` one offset serves every recording, as in the paper; otherwise each has its own.
    """
    columns = blocks[0].regressor.shape[1]
    places, size = _places(blocks, columns, shared_offset)
    total = _factor(blocks, places, size)
    solution = total.solve()
    residuals = [
        block.response - _design(block) @ solution[own] for block, own in zip(blocks, places, strict=True)
    ]
    inverse = total.information_inverse()
    covariance, freedom = _robust(blocks, places, residuals, inverse)
    variance = total.residual_norm**2 / max(total.rows - total.rank, 1)
    labels = [block.label for block in blocks]
    return LinearFit(
        values=solution[:columns],
        offsets={label: float(solution[own[columns]]) for label, own in zip(labels, places, strict=True)},
        covariance=covariance,
        white_covariance=variance * inverse,
        freedom=freedom,
        residuals=dict(zip(labels, residuals, strict=True)),
        rank=total.rank,
        condition_number=total.condition_number,
        shared_offset=shared_offset,
    )


def factor_of(blocks: Sequence[Block], shared_offset: bool = False) -> TriangularFactor:
    """Triangular factor of all blocks' rows: parameters in the order of `LinearFit.covariance`."""
    places, size = _places(blocks, blocks[0].regressor.shape[1], shared_offset)
    return _factor(blocks, places, size)


def _places(blocks: Sequence[Block], columns: int, shared_offset: bool) -> tuple[list[Array], int]:
    """Where each block's own columns stand among all parameters: common ones, offsets, then nuisances; and how many."""
    size = columns + (1 if shared_offset else len(blocks))
    places = []
    for i, block in enumerate(blocks):
        extra = 0 if block.nuisance is None else block.nuisance.shape[1]
        offset = columns + (0 if shared_offset else i)
        places.append(np.array([*range(columns), offset, *range(size, size + extra)]))
        size += extra
    return places, size


def _factor(blocks: Sequence[Block], places: Sequence[Array], size: int) -> TriangularFactor:
    total = TriangularFactor(np.zeros((size + 1, size + 1)), 0)
    for block, own in zip(blocks, places, strict=True):
        total = total + TriangularFactor.of(_design(block), block.response).among(own, size)
    return total


def _design(block: Block) -> Array:
    """The block's regressor with its offset's column and its nuisances, (n, k + 1 + m)."""
    parts = [block.regressor, np.ones(len(block.response))]
    return np.column_stack(parts if block.nuisance is None else [*parts, block.nuisance])


def _robust(
    blocks: Sequence[Block], places: Sequence[Array], residuals: Sequence[Array], inverse: Array
) -> tuple[Array, Array]:
    """Sandwich covariance with the coloured scores of each recording inside, and degrees of freedom."""
    parts, freedoms = [], []
    for block, own, residual in zip(blocks, places, residuals, strict=True):
        middle, freedom = cosine_covariance(_design(block) * residual[:, None], block.duration)
        parts.append(inverse[:, own] @ middle @ inverse[own])
        freedoms.append(freedom)
    variances = np.array([np.diag(part) for part in parts])
    return np.sum(parts, axis=0), pooled_freedom(variances, np.array(freedoms, dtype=float)[:, None])


def effect_of(blocks: Sequence[Block], changes: Sequence[Array], *, shared_offset: bool = False) -> Array:
    """How `values` (k,) move when each block's response changes by `changes` (n,): it is linear in that."""
    changed = [replace(block, response=change) for block, change in zip(blocks, changes, strict=True)]
    return factor_of(changed, shared_offset).solve()[: blocks[0].regressor.shape[1]]
