"""Zener's solid: beside spring and damper, a second spring that relaxes through its own damper."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from plantar import _core
from plantar.conventions import Array
from plantar.models.bush_model import BESIDE, BushModel, BushMotion

FASTEST = 0.05  # s: faster relaxation is a damper in the band that a bush is identified in
RELAXATION_TIME = "relaxation_time"
LONGEST_SHARE = 0.1  # of the longest run: slower relaxation is drift


class StandardLinearSolid(BushModel):
    """torque = K·q + C·q̇ + relaxing_stiffness·x + offset, with relaxation_time·ẋ + x = relaxation_time·q̇.

    K is the relaxed stiffness; a fast movement feels K + relaxing_stiffness. The initial state of a run is the
    relaxing spring's deflection x there, as a share of the run's largest deflection from its middle.
    """

    name: ClassVar[str] = "standard_linear_solid"
    terms: ClassVar[tuple[str, ...]] = (*BESIDE, "relaxing_stiffness")
    shape_terms: ClassVar[tuple[str, ...]] = (RELAXATION_TIME,)
    remembers: ClassVar[bool] = True
    tried_states: ClassVar[tuple[float, ...]] = (-0.3, 0.0, 0.3)
    blind_ends: ClassVar[frozenset[tuple[str, str]]] = frozenset(
        {(RELAXATION_TIME, "low"), (RELAXATION_TIME, "high")}
    )
    dissipative_terms: ClassVar[tuple[str, ...]] = ("relaxing_stiffness",)
    units: ClassVar[dict[str, tuple[str, str]]] = {
        "relaxing_stiffness": ("N.m/rad", "N/m"),
        RELAXATION_TIME: ("s", "s"),
    }

    def candidates(self, motions: Sequence[BushMotion]) -> Array:
        """Relaxation times between what looks like a damper and what looks like drift, in equal ratios."""
        longest = max(
            (motion.period * (run.stop - run.start) for motion in motions for run in motion.runs), default=1.0
        )
        return np.geomspace(FASTEST, max(LONGEST_SHARE * longest, 4 * FASTEST), 12)[:, None]

    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """Deflection of the relaxing spring, (N, 1, b), exact for a deflection linear between samples."""
        column = np.full((len(motion), 1, len(shapes)), np.nan)
        ratio = motion.period / shapes[:, 0]
        for place, run in enumerate(motion.runs):
            column[run, 0] = _core.relaxation(
                np.ascontiguousarray(motion.deflection[run]),
                np.exp(-ratio),
                -np.expm1(-ratio) / ratio,
                initial_states[:, place] * motion.swing,
            )
        return column
