"""Kelvin-Voigt beside a Jenkins element: a spring that slips at a given torque."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar import _core
from plantar.conventions import Array
from plantar.models.hysteresis import Hysteretic, Path


class Elastoplastic(Hysteretic):
    """slip_torque·z with dz = dq / slip_angle, stopped at ±1 (a stop operator)."""

    name: ClassVar[str] = "elastoplastic"

    def states(self, path: Path, shapes: Array, initial_states: Array) -> Array:
        """z (N, b) of one Jenkins element."""
        slips, starts = np.ascontiguousarray(shapes[:, 0]), np.ascontiguousarray(initial_states)
        return _core.stop_operator(path.deflection, path.runs, slips, starts)
