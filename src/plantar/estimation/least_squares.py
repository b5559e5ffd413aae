"""Linear fits over several recordings (eq. 6 and 7) with an offset each, or one for all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array
from plantar.estimation.blocks import Block, LinearFit
from plantar.estimation.orthonormal import without
from plantar.estimation.residual_covariance import cosine_count, pooled_freedom, score_cosines
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


def factor_of(blocks: Sequence[Block], shared_offset: bool) -> TriangularFactor:
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
    rests = [[*parts[:place], *parts[place + 1 :]] for place in range(len(parts))]
    return np.array([TriangularFactor.together(rest).solve()[:columns] for rest in rests])


def sureness_of_own(blocks: Sequence[Block], column: int) -> Array:
    """By how many deviations the coefficient of one of the regressor's columns is another in each recording than in all
    others, (blocks,): of fits with one more column each, which is that one in one recording.

    All these fits follow from products of the rows, and their scores, which are products of two rows' columns, from
    the cosines of such products.
    """
    size = blocks[0].regressor.shape[1] + 1  # the response is the last
    own, cosines = list[Array](), list[Array]()
    first, second = np.triu_indices(size)
    for block in blocks:
        rows = _rows(block)
        offset, others = rows[:, size - 1], np.delete(rows, size - 1, axis=1)
        others = others - np.outer(offset, offset @ others / (offset @ offset))
        own.append(others.T @ others)
        coloured = np.zeros((size, size, max(cosine_count(block.duration), 1)))
        told = score_cosines(others[:, first] * others[:, second], block.duration).T
        coloured[first, second, : told.shape[1]] = coloured[second, first, : told.shape[1]] = told
        cosines.append(coloured)
    together = np.sum(own, axis=0)
    sureness = np.zeros(len(blocks))
    for place, apart in enumerate(own):
        products = np.block([[together, apart[:, column, None]], [apart[column], apart[column, column]]])
        products = np.roll(products, 1, axis=(0, 1))  # its own column first, the response last
        scale = np.sqrt(np.maximum(np.diag(products)[:-1], np.finfo(float).tiny))
        inverse = np.linalg.pinv(products[:-1, :-1] / np.outer(scale, scale), hermitian=True)
        inverse /= np.outer(scale, scale)
        values, along = inverse @ products[:-1, -1], np.append(inverse[0, 1:], 0.0)
        left, variance = np.append(-values[1:], 1.0), 0.0
        for at, coloured in enumerate(cosines):
            moved, missed = along.copy(), left.copy()
            moved[column] += (at == place) * inverse[0, 0]
            missed[column] -= (at == place) * values[0]
            variance += float(np.sum(np.einsum("a,abc,b->c", moved, coloured, missed) ** 2))
        sureness[place] = abs(values[0]) / np.sqrt(variance) if variance > 0 else 0.0
    return sureness


def _places(blocks: Sequence[Block], shared_offset: bool) -> tuple[list[Array], int]:
    """Where each block's values and offset stand among all parameters, and how many these are."""
    columns = blocks[0].regressor.shape[1]
    size = columns + (1 if shared_offset else len(blocks))
    return [
        np.array([*range(columns), columns + (0 if shared_offset else i)]) for i in range(len(blocks))
    ], size


def _factor(rows: Sequence[Array], places: Sequence[Array], size: int) -> TriangularFactor:
    return TriangularFactor.together(
        [TriangularFactor.of(part).among(own, size) for part, own in zip(rows, places, strict=True)]
    )


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
