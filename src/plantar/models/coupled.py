"""Kelvin-Voigt in which each axis also feels the other axes' deflections and rates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.errors import DataError
from plantar.models.bush_model import BESIDE, BushModel, BushMotion


class Coupled(BushModel):
    """torque = K·q + C·q̇ + cross_stiffness·p + cross_damping·ṗ + offset, p the deflection of the other axis.

    A bush whose principal axes are turned against the foot's (or a bush centre that is not where the robot
    file puts it) shows up here. `BushMotion.across` holds p as its first column.
    """

    name: ClassVar[str] = "coupled"
    terms: ClassVar[tuple[str, ...]] = (*BESIDE, "cross_stiffness", "cross_damping")
    units: ClassVar[dict[str, tuple[str, str]]] = {
        "cross_stiffness": ("N.m/rad", "N/rad"),
        "cross_damping": ("N.m.s/rad", "N.s/rad"),
    }

    def applies(self, motions: Sequence[BushMotion]) -> bool:
        """Whether every motion has the other axis."""
        return all(motion.across is not None and motion.across_rate is not None for motion in motions)

    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """Deflection and rate of the other axis, (N, 2, b). Raises DataError where a motion lacks them."""
        if motion.across is None or motion.across_rate is None:
            raise DataError("the coupled model needs the deflection of the foot's other axis")
        pair = np.column_stack([motion.across[:, 0], motion.across_rate[:, 0]])
        return np.repeat(pair[:, :, None], len(shapes), axis=2)
