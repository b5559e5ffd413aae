"""Kelvin-Voigt beside a Jenkins element: a spring that slips at a given torque."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar import _core
from plantar.conventions import Array
from plantar.models.hysteresis import Hysteretic, Path


def jenkins_states(path: Path, slip_angles: Array, initial_states: Array) -> Array:
    """z (N, b): moves with deflection / slip angle (b,) and stops at ±1, from `initial_states` (r, b); NaN where there
    is no run."""
    slips, starts = np.ascontiguousarray(slip_angles), np.ascontiguousarray(initial_states)
    return _core.stop_operator(path.deflection, path.runs, slips, starts)


class Elastoplastic(Hysteretic):
    """slip_torque·z with dz = dq / slip_angle, stopped at ±1 (a stop operator)."""

    name: ClassVar[str] = "elastoplastic"

    def states(self, path: Path, shapes: Array, initial_states: Array) -> Array:
        """z (N, b) of one Jenkins element."""
        return jenkins_states(path, shapes[:, 0], initial_states)
