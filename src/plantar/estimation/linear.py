"""The linear fit that fits the recordings: of long segments, or of many short stances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array
from plantar.estimation.blocks import Block, LinearFit
from plantar.estimation.least_squares import factor_of, fit_linear, influences
from plantar.estimation.orthonormal import without
from plantar.estimation.stance_least_squares import fit_stances
from plantar.estimation.stance_problem import StanceProblem, common_columns
from plantar.estimation.triangular import TriangularFactor


def fit_blocks(blocks: Sequence[Block], *, shared_offset: bool = False) -> LinearFit:
    """Least squares over all blocks: an offset for each stance where the blocks have stances, else for each recording,
    or one for all with `shared_offset`."""
    if _step(blocks, shared_offset):
        return fit_stances(blocks)
    return fit_linear(blocks, shared_offset=shared_offset)


def influences_of(blocks: Sequence[Block], *, shared_offset: bool = False) -> list[Array]:
    """How far each row's response moves `values`, (k, n) of each block."""
    size = blocks[0].regressor.shape[1]
    if _step(blocks, shared_offset):
        return [own[:size] for own in StanceProblem.drawn_together(blocks).influences(blocks)]
    return [own[:size] for own in influences(blocks, shared_offset)]


def effect_of(influences: Sequence[Array], changes: Sequence[Array]) -> Array:
    """How `values` (k, ...) move when each block's response changes by `changes` (n, ...): it is linear in that."""
    return np.asarray(sum(own @ change for own, change in zip(influences, changes, strict=True)))


def fits_of_halves(block: Block) -> tuple[LinearFit, LinearFit]:
    """The fits of the first and of the last half of a block's stances, each alone; of two stances at least."""
    assert block.stances is not None, "a block of a foot that steps"
    stances = block.stances.split()
    parts = (stances[: len(stances) // 2], stances[len(stances) // 2 :])
    first, last = (fit_blocks([block.part(np.sort(np.concatenate(part)))]) for part in parts)
    return first, last


def information_inverse(blocks: Sequence[Block], *, shared_offset: bool = False) -> Array:
    """Inverse (k, k) of the information about `values`: their covariance for residuals of unit variance."""
    size = blocks[0].regressor.shape[1]
    if _step(blocks, shared_offset):
        return StanceProblem.drawn_together(blocks).solve().inverse[:size, :size]
    return factor_of(blocks, shared_offset).information_inverse()[:size, :size]


def least_left(blocks: Sequence[Block], columns: Sequence[Array]) -> Array:
    """The squares (c,) that a fit with one more column at least leaves, of each of several `columns` (n, c) of blocks.

    Whatever the weights of rows and the priors of offsets: these are the squares without either. One factor tells all.
    """
    size = common_columns(blocks[0]).shape[1]
    factors = []  # block by block: rows of an hour take tens of megabytes
    for block, more in zip(blocks, columns, strict=True):
        own = block.with_nuisance(np.ones((len(more), 1))).nuisance
        assert own is not None, "it has one column at least"
        rows = without(own, np.column_stack([common_columns(block), more, block.response]))
        factors.append(TriangularFactor.of(rows))
    left = TriangularFactor.together(factors).factor[size:, size:]
    along, squares = left[:, -1] @ left[:, :-1], np.sum(left[:, :-1] ** 2, axis=0)
    return np.asarray(left[:, -1] @ left[:, -1] - along**2 / np.maximum(squares, np.finfo(float).tiny))


def _step(blocks: Sequence[Block], shared_offset: bool) -> bool:
    return not shared_offset and blocks[0].stances is not None
