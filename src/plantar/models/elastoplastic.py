"""Kelvin-Voigt beside a Jenkins element: a spring that slips at a given torque."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.models.hysteresis import Branches, Hysteretic


def jenkins_states(branches: Branches, slip_angles: Array, initial_states: Array) -> Array:
    """z (n, r, b): moves with deflection / slip angle (b,) and stops at ±1; `initial_states` (r, b)."""
    way = branches.length[:, :, None] / slip_angles
    begins = np.empty_like(way)
    # On each branch z = direction·(place - 1): `place` is how far z stands from the end it came from, 0 to 2.
    place = 1.0 + branches.direction[0][:, None] * np.clip(initial_states, -1.0, 1.0)
    for turn, onward in enumerate(way):
        begins[turn] = place
        place = np.maximum(2.0 - (place + onward), 0.0)
    runs = np.arange(branches.length.shape[1])
    placed = begins[branches.branch, runs] + branches.travelled[:, :, None] / slip_angles
    return np.asarray(branches.direction[branches.branch, runs][:, :, None] * (np.minimum(placed, 2.0) - 1.0))


class Elastoplastic(Hysteretic):
    """slip_torque·z with dz = dq / slip_angle, stopped at ±1 (a stop operator)."""

    name: ClassVar[str] = "elastoplastic"

    def states(self, branches: Branches, shapes: Array, initial_states: Array) -> Array:
        """z (n, r, b) of one Jenkins element."""
        return jenkins_states(branches, shapes[:, 0], initial_states)
