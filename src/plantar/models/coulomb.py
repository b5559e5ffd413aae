"""Kelvin-Voigt with dry friction that follows the sign of the rate, smoothed around rest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from plantar.conventions import Array
from plantar.models.bush_model import BESIDE, BushModel, BushMotion

SMOOTHEST = 0.3  # of the motions' fast rate: wider than that, friction is a damper
SHARPEST = 0.003  # likewise: sharper looks the same to sensors


class Coulomb(BushModel):
    """torque = K·q + C·q̇ + coulomb·tanh(q̇ / slip_rate) + offset.

    No memory: it jumps wherever the rate changes sign, so it has no slope before slip (see `Elastoplastic`).
    """

    name: ClassVar[str] = "coulomb"
    terms: ClassVar[tuple[str, ...]] = (*BESIDE, "coulomb")
    shape_terms: ClassVar[tuple[str, ...]] = ("slip_rate",)
    blind_ends: ClassVar[frozenset[tuple[str, str]]] = frozenset({("slip_rate", "high")})
    dissipative_terms: ClassVar[tuple[str, ...]] = ("coulomb",)
    units: ClassVar[dict[str, tuple[str, str]]] = {"coulomb": ("N.m", "N"), "slip_rate": ("rad/s", "m/s")}

    def candidates(self, motions: Sequence[BushMotion]) -> Array:
        """Rates of transition as shares of the motions' fast rate (98th percentile)."""
        rates = np.concatenate(
            [np.abs(motion.rate[run]) for motion in motions for run in motion.runs] or [np.zeros(1)]
        )
        fast = float(np.percentile(rates, 98)) or 1.0
        return np.geomspace(SHARPEST * fast, SMOOTHEST * fast, 9)[:, None]

    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """Sign of the rate, smooth: (N, 1, b)."""
        return np.asarray(np.tanh(motion.rate[:, None, None] / shapes[:, 0]))
