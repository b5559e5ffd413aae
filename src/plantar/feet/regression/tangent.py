"""One axis of one foot linearised about its fit: what disturbs it moves its numbers along."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.estimation import Block, LinearFit, effect_of, fit_blocks, influences_of
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.model_columns import memory_path, own_torque
from plantar.feet.regression.regression_data import all_beside, blocks_of, recordings_of
from plantar.model_selection.variable_projection import SHAPE_STEP


@dataclass(frozen=True)
class Tangent:
    """A `fit`, the `blocks` of eq. 6 linearised about it and the recording that each of them is of; `shared`: all have
    one offset.

    Their columns are the fit's, then the torque's change with each nonlinear parameter, (n, k + s). So what disturbs
    the torque moves these parameters too, and moves the others as much as they then allow. Of a foot that steps, the
    columns alone: the states of its many stances leave little of such a change.
    """

    fit: AxisFit
    blocks: Sequence[Block]
    recordings: Sequence[Recording]
    shared: bool

    @classmethod
    def of(cls, fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> Tangent:
        blocks = blocks_of(recordings, fit.foot, fit.axis, drift=not shared, fit=fit)
        found = cls(fit, blocks, recordings_of(blocks, recordings), shared)
        if len(fit.shape) == 0 or found.steps:
            return found
        steps, slopes = SHAPE_STEP * fit.shape, list[Array]()
        shapes = np.concatenate([fit.shape + np.diag(steps), fit.shape - np.diag(steps)])
        for one in found.recordings:  # the states at the start held
            torque = own_torque(one, fit, [memory_path(one, fit)], shapes)[one.rows(fit.foot)]
            slopes.append((torque[:, : len(steps)] - torque[:, len(steps) :]) / (2 * steps))
        return found.beside(slopes)

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
