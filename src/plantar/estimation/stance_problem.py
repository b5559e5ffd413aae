"""The normal equations of a fit over many short stances, kept by stance, so that any of them can be left out.

    response = regressor · values + common_nuisance · a + nuisance · n_r + O_r + d_s + error

`values` and `a` are common to all recordings, `n_r` and `O_r` belong to recording r, `d_s` to its stance s. The offsets
of one recording's stances scatter about O_r: d_s has a prior of mean zero (random effects).
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import ROUNDING, Array
from plantar.estimation.blocks import Block

NEVER_FREE = 1e-9  # of a stance's weight, the least prior of its offset: keeps the recording's offset defined
REGULAR = 1e-2 / ROUNDING  # condition up to which an inverse needs no eigenvalues
LEAST_SHARE = 1e-3  # of the offsets' scatter that counts as the stances' own: keeps the prior finite
SHORTEST_HALF = 2  # rows of a stance's half, for its mean to be worth comparing


@dataclass(frozen=True)
class Solution:
    """`values` (k,) common to all recordings; of each recording its nuisances and offset, `own` (R, m + 1); `inverse`
    (k, k) of the information about the values; `squares` that are left."""

    values: Array
    own: Array
    inverse: Array
    squares: float


@dataclass(frozen=True)
class StanceProblem:
    """Products (S, c, c) of [common columns, nuisance, 1, response] over each of S stances, the recording of each
    (S,), how many columns are common to all (k), and the `prior` weight that draws a stance's offset to O_r."""

    products: Array
    recording: NDArray[np.intp]
    common: int
    prior: float

    @classmethod
    def of(cls, blocks: Sequence[Block], prior: float) -> StanceProblem:
        """Of blocks with stances and weights."""
        widest = max(0 if block.nuisance is None else block.nuisance.shape[1] for block in blocks)
        products, owner = [], []
        for place, block in enumerate(blocks):
            assert block.stances is not None, "blocks of a foot that steps"
            columns = np.column_stack([design(block, widest), block.response])
            columns *= np.sqrt(block.stances.weight)[:, None]
            own = [columns[rows] for rows in block.stances.split()]
            products += [part.T @ part for part in own]
            owner += [place] * len(own)
        common = common_columns(blocks[0]).shape[1]
        return cls(np.array(products), np.array(owner, dtype=np.intp), common, prior)

    @classmethod
    def drawn_together(cls, blocks: Sequence[Block]) -> StanceProblem:
        """With the prior that the blocks' own scatter of offsets gives."""
        free = cls.of(blocks, 0.0)
        return replace(free, prior=_offset_prior(blocks, free.solve()))

    @property
    def own_share(self) -> float:
        """How much of a usual stance's offset is its own, 0 to 1."""
        usual = float(np.median(self.products[:, -2, -2]))
        return usual / (usual + self.prior)

    @property
    def recordings(self) -> int:
        return int(self.recording.max()) + 1

    def solve(self) -> Solution:
        """The solution of all recordings."""
        back, total = self._parts[1], self._total
        values, inverse = _solved(total)
        own = back[:, :, -1] - back[:, :, :-1] @ values
        return Solution(values, own, inverse, float(total[-1, -1] - values @ total[:-1, -1]))

    def influences(self, blocks: Sequence[Block]) -> list[Array]:
        """How far the response of each row of the problem's blocks moves the values, (k, n) of each block."""
        found, inverse = [], self.solve().inverse
        for place, (block, back) in enumerate(zip(blocks, self._parts[1], strict=True)):
            assert block.stances is not None, "blocks of a foot that steps"
            stances, drawn = self.products[self.recording == place], design(block, len(back) - 1)
            for rows, ones, share in zip(
                block.stances.split(), stances[:, -2, :-1], self._shares(stances), strict=True
            ):
                drawn[rows] -= share * ones
            common = drawn[:, : self.common] - drawn[:, self.common :] @ back[:, :-1]
            found.append(inverse @ (block.stances.weight[:, None] * common).T)
        return found

    @cached_property
    def without_each_stance(self) -> Array:
        """Values (S, k) of the fits that lack one stance each."""
        found = []
        for place in range(self.recordings):
            stances = np.flatnonzero(self.recording == place)
            drawn = self._drawn(stances)
            less = self._own_eliminated(drawn.sum(axis=0) - drawn)[0] if len(stances) > 1 else 0.0
            totals = self._total - self._parts[0][place] + less
            found.append(_solved(np.broadcast_to(totals, (len(stances), *self._total.shape)))[0])
        return np.concatenate(found)

    def without_each_recording(self) -> Array:
        """Values (R, k) of the fits that lack one recording each."""
        return _solved(self._total - self._parts[0])[0]

    @cached_property
    def _parts(self) -> tuple[Array, Array]:
        """`_own_eliminated` of each recording's stances, (R, ...)."""
        each = (np.flatnonzero(self.recording == place) for place in range(self.recordings))
        return self._own_eliminated(np.array([self._drawn(stances).sum(axis=0) for stances in each]))

    @cached_property
    def _total(self) -> Array:
        return np.asarray(self._parts[0].sum(axis=0))

    def _drawn(self, stances: NDArray[np.intp]) -> Array:
        """Products (s, ...) of each of one recording's stances, their offsets drawn together."""
        sums = self.products[stances]
        ones = sums[:, :, -2]
        return np.asarray(sums - self._shares(sums)[:, None, None] * ones[:, :, None] * ones[:, None, :])

    def _shares(self, sums: Array) -> Array:
        """What a unit of each stance's sum (s, ...) moves its offset by, (s,)."""
        weight = sums[:, -2, -2]
        least = NEVER_FREE * float(weight.max(initial=0.0)) or 1.0
        return np.asarray(1 / (weight + max(self.prior, least)))

    def _own_eliminated(self, drawn: Array) -> tuple[Array, Array]:
        """Products (..., k + 1, k + 1) of sums (..., n, n) over stances, all that is a recording's own eliminated, and
        the map (..., m + 1, k + 1) that gives its own back."""
        own, kept = slice(self.common, -1), [*range(self.common), drawn.shape[-1] - 1]
        both = drawn[..., kept]
        back = _scaled_inverse(drawn[..., own, own]) @ both[..., own, :]
        return both[..., kept, :] - drawn[..., kept, own] @ back, back


def common_columns(block: Block) -> Array:
    """The regressor and the nuisances that all recordings share, (n, k)."""
    if block.common_nuisance is None:
        return block.regressor
    return np.hstack([block.regressor, block.common_nuisance])


def design(block: Block, widest: int) -> Array:
    """All columns of a block, its own nuisances filled up to `widest` by zeros, (n, k + widest + 1)."""
    own = np.zeros((len(block.response), widest))
    if block.nuisance is not None:
        own[:, : block.nuisance.shape[1]] = block.nuisance
    return np.column_stack([common_columns(block), own, np.ones(len(block.response))])


def _solved(total: Array) -> tuple[Array, Array]:
    """Values (..., k) by normal equations (..., k + 1, k + 1), and the inverse (..., k, k) of their left side."""
    inverse = _scaled_inverse(total[..., :-1, :-1])
    return np.asarray((inverse @ total[..., :-1, -1:])[..., 0]), inverse


def _scaled_inverse(square: Array) -> Array:
    """Pseudo-inverse of positive semidefinite matrices (..., k, k), their rows scaled alike first: newtons and radians
    meet here."""
    # Of a column that hardly changes within stances rounding leaves less than nothing.
    scale = np.sqrt(np.maximum(np.diagonal(square, axis1=-2, axis2=-1), 0.0))
    scale = np.where(scale > 0, scale, 1.0)
    outer = scale[..., :, None] * scale[..., None, :]
    scaled = square / outer
    with suppress(np.linalg.LinAlgError):  # where one is singular
        inverse = np.linalg.inv(scaled)
        condition = np.linalg.norm(scaled, axis=(-2, -1)) * np.linalg.norm(inverse, axis=(-2, -1))
        if (condition < REGULAR).all():
            return np.asarray(inverse / outer)
    return np.asarray(np.linalg.pinv(scaled, rcond=ROUNDING, hermitian=True) / outer)


def _offset_prior(blocks: Sequence[Block], free: Solution) -> float:
    """Weight that draws a stance's offset to its recording's: large where stances differ by no more than errors do.

    What both halves of a stance have in common beyond their recording is the stance's own; how far its mean scatters
    beyond that is error.
    """
    together = scattered = weight = 0.0
    count = 0
    for block, own in zip(blocks, free.own, strict=True):
        assert block.stances is not None, "blocks of a foot that steps"
        left = block.response - (design(block, own.size - 1) @ np.concatenate([free.values, own[:-1], [0.0]]))
        long = [rows for rows in block.stances.split() if len(rows) >= 2 * SHORTEST_HALF]
        if long:
            weight += float(block.stances.weight[np.concatenate(long)].sum())
        if len(long) > 1:
            halves = _means_of_halves(left, long)
            apart = halves - halves.mean()
            together += float(np.sum(apart[:, 0] * apart[:, 1]))
            scattered += float(np.sum(apart.mean(axis=1) ** 2))
            count += len(halves)
    if scattered <= 0:
        return 0.0
    share = min(max(together / scattered, LEAST_SHARE), 1.0)
    return weight / count * (1 / share - 1)


def _means_of_halves(values: Array, stances: Sequence[NDArray[np.intp]]) -> Array:
    """Means (s, 2) of the first and the second half of each of some stances' values."""
    lengths = np.array([len(rows) for rows in stances])
    sizes = np.column_stack([(lengths + 1) // 2, lengths // 2])
    firsts = np.cumsum(sizes) - sizes.ravel()
    return np.asarray(np.add.reduceat(values[np.concatenate(stances)], firsts).reshape(-1, 2) / sizes)
