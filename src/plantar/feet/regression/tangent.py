"""One axis of one foot linearised about its fit: what disturbs it moves its numbers along."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.estimation import Block, LinearFit, effect_of, fit_blocks, influences_of
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside, recordings_of, tangent_blocks


@dataclass(frozen=True)
class Tangent:
    """A `fit`, the `blocks` of eq. 6 linearised about it (`tangent_blocks`) and the recording that each of them is of;
    `shared`: all have one offset."""

    fit: AxisFit
    blocks: Sequence[Block]
    recordings: Sequence[Recording]
    shared: bool

    @classmethod
    def of(cls, fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> Tangent:
        blocks = tangent_blocks(recordings, fit, drift=not shared)
        return cls(fit, blocks, recordings_of(blocks, recordings), shared)

    @property
    def steps(self) -> bool:
        """Whether the foot steps in any of the recordings."""
        return self.blocks[0].stances is not None

    @cached_property
    def least_squares(self) -> LinearFit:
        """Of the blocks as they are."""
        return fit_blocks(self.blocks, shared_offset=self.shared)

    @cached_property
    def influences(self) -> list[Array]:
        """How far each row's torque moves the numbers, (k, n) of each block."""
        return influences_of(self.blocks, shared_offset=self.shared)

    def effect(self, changes: Sequence[Array]) -> Array:
        """How the numbers (k, ...) move when each block's torque changes by `changes` (n, ...)."""
        return effect_of(self.influences, changes)

    def rows(self, values: Callable[[Recording], NDArray[Any]]) -> list[NDArray[Any]]:
        """What `values` makes of each recording, (N, ...), at the rows of its block, (n, ...)."""
        return [values(one)[one.rows(self.fit.foot)] for one in self.recordings]

    def beside(self, columns: Sequence[Array]) -> Tangent:
        """The same with more columns (n, m) at the end of each block."""
        return replace(self, blocks=all_beside(self.blocks, columns))
