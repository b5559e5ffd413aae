"""Kelvin-Voigt whose spring stiffens (or softens) with deflection."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.models.law import BESIDE, Law, Motion


class Hardening(Law):
    """torque = K·q + C·q̇ + hardening·q³ + offset; K is the slope at zero deflection."""

    name: ClassVar[str] = "hardening"
    terms: ClassVar[tuple[str, ...]] = (*BESIDE, "hardening")
    units: ClassVar[dict[str, tuple[str, str]]] = {"hardening": ("N.m/rad3", "N/m3")}

    def extra(self, motions: Sequence[Motion], shapes: Array, starts: Sequence[Array]) -> list[Array]:
        """The cube of the deflection, (N, 1, b)."""
        return [np.repeat(motion.deflection[:, None, None] ** 3, len(shapes), axis=2) for motion in motions]
