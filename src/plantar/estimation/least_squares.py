"""Linear fits over several recordings (eq. 6 and 7) with an offset each, or one for all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array
from plantar.estimation.blocks import Block, LinearFit
from plantar.estimation.orthonormal import without
from plantar.estimation.residual_covariance import pooled_freedom, score_cosines
from plantar.estimation.triangular import TriangularFactor


def fit_linear(blocks: Sequence[Block], *, shared_offset: bool = False) -> LinearFit:
    """Least squares of response = regressor · values + offset over all blocks.

    With `shared_offset` one offset is used for every recording, as in the paper; otherwise each has its own.
    """
    columns = blocks[0].regressor.shape[1]
    places, size = _places(blocks, shared_offset)
    rows = [_rows(block) for block in blocks]
    total = _factor(rows, places, size)
    solution = total.solve()
    residuals = [own[:, -1] - own[:, :-1] @ solution[at] for own, at in zip(rows, places, strict=True)]
    inverse = total.information_inverse()
    covariance, freedom = _robust(blocks, rows, places, residuals, inverse)
    forgotten = sum(block.nuisance.shape[1] for block in blocks if block.nuisance is not None)
    variance = total.residual_norm**2 / max(total.rows - total.rank - forgotten, 1)
    labels = [block.label for block in blocks]
    return LinearFit(
        values=solution[:columns],
        offsets={label: float(solution[own[columns]]) for label, own in zip(labels, places, strict=True)},
        covariance=covariance,
        white_covariance=variance * inverse * total.rows / sum(len(b.response) * b.thinned for b in blocks),
        freedom=freedom,
        residuals=dict(zip(labels, residuals, strict=True)),
        rank=total.rank,
        condition_number=total.condition_number,
        shared_offset=shared_offset,
    )


def factor_of(blocks: Sequence[Block], shared_offset: bool = False) -> TriangularFactor:
    """Triangular factor of all blocks' rows: parameters in the order of `LinearFit.covariance`."""
    places, size = _places(blocks, shared_offset)
    return _factor([_rows(block) for block in blocks], places, size)


def influences(blocks: Sequence[Block], shared_offset: bool) -> list[Array]:
    """How far each row's response moves the parameters, (p, n) of each block."""
    places, size = _places(blocks, shared_offset)
    rows = [_rows(block) for block in blocks]
    inverse = _factor(rows, places, size).information_inverse()
    return [inverse[:, own] @ part[:, :-1].T for part, own in zip(rows, places, strict=True)]


def values_without_each(blocks: Sequence[Block]) -> Array:
    """The values (blocks, k) of fits of all blocks but one each, every recording with an offset of its own."""
    columns = blocks[0].regressor.shape[1]
    places, size = _places(blocks, shared_offset=False)
    parts = [
        TriangularFactor.of(_rows(block)).among(own, size) for block, own in zip(blocks, places, strict=True)
    ]
    none = TriangularFactor(np.zeros((size + 1, size + 1)), 0)
    rests = [sum((*parts[:place], *parts[place + 1 :]), none) for place in range(len(parts))]
    return np.array([rest.solve()[:columns] for rest in rests])


def _places(blocks: Sequence[Block], shared_offset: bool) -> tuple[list[Array], int]:
    """Where each block's values and offset stand among all parameters, and how many these are."""
    columns = blocks[0].regressor.shape[1]
    size = columns + (1 if shared_offset else len(blocks))
    return [
        np.array([*range(columns), columns + (0 if shared_offset else i)]) for i in range(len(blocks))
    ], size


def _factor(rows: Sequence[Array], places: Sequence[Array], size: int) -> TriangularFactor:
    total = TriangularFactor(np.zeros((size + 1, size + 1)), 0)
    for part, own in zip(rows, places, strict=True):
        total = total + TriangularFactor.of(part).among(own, size)
    return total


def _rows(block: Block) -> Array:
    """The block's regressor, its offset's column and its response, (n, k + 2), beside its nuisances.

    A fit of these gives what one with the nuisances gives (R. Frisch, F. V. Waugh, Econometrica 1, 1933).
    """
    rows = np.column_stack([block.regressor, np.ones(len(block.response)), block.response])
    return rows if block.nuisance is None else without(block.nuisance, rows)


def _robust(
    blocks: Sequence[Block],
    rows: Sequence[Array],
    places: Sequence[Array],
    residuals: Sequence[Array],
    inverse: Array,
) -> tuple[Array, Array]:
    """Sandwich covariance with the coloured scores of each recording inside, and degrees of freedom."""
    parts, freedoms = [], []
    for block, part, own, residual in zip(blocks, rows, places, residuals, strict=True):
        moved = score_cosines(part[:, :-1] * residual[:, None], block.duration) @ inverse[own]
        parts.append(moved.T @ moved)
        freedoms.append(len(moved))
    variances = np.array([np.diag(part) for part in parts])
    return np.sum(parts, axis=0), pooled_freedom(variances, np.array(freedoms, dtype=float)[:, None])
