"""Rubber that both stiffens and slips: a cube beside the Jenkins element."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.models.bush_model import BushMotion
from plantar.models.elastoplastic import Elastoplastic
from plantar.models.hardening import Hardening


class HardeningElastoplastic(Elastoplastic):
    """torque = K·q + C·q̇ + slip_torque·z + hardening·q³ + offset; K is the slope of the spring at zero deflection.

    The cube is taken about the recorded zero: here the initial state of a run is z, not an error of the zero as in
    `Hardening`. A fit has to allow for such an error.
    """

    name: ClassVar[str] = "hardening_elastoplastic"
    terms: ClassVar[tuple[str, ...]] = (*Elastoplastic.terms, "hardening")
    zero_matters: ClassVar[bool] = True
    elaborates: ClassVar[str | None] = Elastoplastic.name
    units: ClassVar[dict[str, tuple[str, str]]] = {**Elastoplastic.units, **Hardening.units}

    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """The state z and the cube, (N, 2, b)."""
        slip = super().basis_columns(motion, shapes, initial_states)
        both = np.repeat(slip, 2, axis=1)
        both[:, 1] = np.where(np.isfinite(slip[:, 0, :1]), motion.deflection[:, None] ** 3, np.nan)
        return both
