"""The linear fit that fits the recordings: of long segments, or of many short stances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from plantar.conventions import Array
from plantar.estimation.blocks import Block, LinearFit
from plantar.estimation.least_squares import factor_of, fit_linear
from plantar.estimation.stance_least_squares import fit_stances
from plantar.estimation.stance_problem import StanceProblem


def fit_blocks(blocks: Sequence[Block], *, shared_offset: bool = False) -> LinearFit:
    """Least squares over all blocks: an offset for each stance where the blocks have stances, else for each recording,
    or one for all with `shared_offset`."""
    if _step(blocks, shared_offset):
        return fit_stances(blocks)
    return fit_linear(blocks, shared_offset=shared_offset)


def effect_of(blocks: Sequence[Block], changes: Sequence[Array], *, shared_offset: bool = False) -> Array:
    """How `values` (k,) move when each block's response changes by `changes` (n,): it is linear in that."""
    size = blocks[0].regressor.shape[1]
    changed = [replace(block, response=change) for block, change in zip(blocks, changes, strict=True)]
    if _step(blocks, shared_offset):
        prior = StanceProblem.drawn_together(blocks).prior
        return StanceProblem.of(changed, prior).solve().values[:size]
    return factor_of(changed, shared_offset).solve()[:size]


def information_inverse(blocks: Sequence[Block], *, shared_offset: bool = False) -> Array:
    """Inverse (k, k) of the information about `values`: their covariance for residuals of unit variance."""
    size = blocks[0].regressor.shape[1]
    if _step(blocks, shared_offset):
        return StanceProblem.drawn_together(blocks).solve().inverse[:size, :size]
    return factor_of(blocks, shared_offset).information_inverse()[:size, :size]


def _step(blocks: Sequence[Block], shared_offset: bool) -> bool:
    return not shared_offset and blocks[0].stances is not None
