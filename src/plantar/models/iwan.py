"""Kelvin-Voigt beside many Jenkins elements that slip one after the other (Iwan's parallel-series model)."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.models.elastoplastic import Elastoplastic
from plantar.models.hysteresis import Path

ELEMENTS = 8  # in parallel, whose slip angles spread from near zero to twice their mean


class Iwan(Elastoplastic):
    """slip_torque·z, z the mean of elements of equal stiffness whose slip angles spread evenly from 0 to 2·slip_angle.

    The stiffness before any slips is slip_torque / slip_angle, as for one element; it bends over in a parabola until
    the last slips at 2·slip_angle. In a run's first part all elements start from the same state.
    """

    name: ClassVar[str] = "iwan"
    elaborates: ClassVar[str | None] = Elastoplastic.name

    def states(self, path: Path, shapes: Array, initial_states: Array) -> Array:
        """z (N, b): torques of the elements, each its slip angle's share."""
        spread = 2.0 * (np.arange(ELEMENTS) + 0.5) / ELEMENTS  # slip angles over their mean
        total: Array = np.zeros(())
        for ratio in spread:
            total = total + ratio * super().states(path, ratio * shapes, initial_states)
        return np.asarray(total / ELEMENTS)
