"""Kelvin-Voigt whose spring stiffens (or softens) with deflection."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.models.bush_model import BESIDE, BushModel, BushMotion

ZERO_ERROR = 0.01  # rad (m): largest error of the deflection's zero that is looked for


class Hardening(BushModel):
    """torque = K·q + C·q̇ + hardening·((q - e)³ + e³) + offset; K is the slope at zero deflection.

    e is the error of the deflection's zero in each run (attitude bias), in units of `ZERO_ERROR`: a cube
    does not absorb it into the offset as a spring does.
    """

    name: ClassVar[str] = "hardening"
    terms: ClassVar[tuple[str, ...]] = (*BESIDE, "hardening")
    remembers: ClassVar[bool] = True
    fading_memory: ClassVar[bool] = False
    tried_states: ClassVar[tuple[float, ...]] = (-0.5, 0.0, 0.5)
    units: ClassVar[dict[str, tuple[str, str]]] = {"hardening": ("N.m/rad3", "N/m3")}

    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """The cube of the deflection about its true zero, (N, 1, b)."""
        column = np.full((len(motion), 1, len(shapes)), np.nan)
        for place, run in enumerate(motion.runs):
            error = ZERO_ERROR * initial_states[:, place]
            away = motion.deflection[run, None] - error
            column[run, 0] = away * away * away + error**3  # ten times quicker than a power
        return column
