"""Kelvin-Voigt beside a Jenkins element: a spring that slips at a given torque."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar import _core
from plantar.conventions import Array
from plantar.models.hysteresis import Branches, Hysteretic


def jenkins_states(branches: Branches, slip_angles: Array, initial_states: Array) -> Array:
    """z (n, r, b): moves with deflection / slip angle (b,) and stops at ±1; `initial_states` (r, b).

    Zero where `branches` are padded behind the end of a run.
    """
    return _core.stop_operator(
        branches.direction,
        branches.length,
        branches.branch,
        branches.travelled,
        np.ascontiguousarray(slip_angles, dtype=np.float64),
        np.ascontiguousarray(initial_states, dtype=np.float64),
    )


class Elastoplastic(Hysteretic):
    """slip_torque·z with dz = dq / slip_angle, stopped at ±1 (a stop operator)."""

    name: ClassVar[str] = "elastoplastic"

    def states(self, branches: Branches, shapes: Array, initial_states: Array) -> Array:
        """z (n, r, b) of one Jenkins element."""
        return jenkins_states(branches, shapes[:, 0], initial_states)
