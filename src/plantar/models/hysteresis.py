"""Rate-independent memory: a state z in [-1, 1] that depends on the path of the deflection, not on its speed.

Between two turning points of the path, z runs along one curve, mirrored for the way back: the native core walks along
the path and keeps where on its curve each branch began.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.models.bush_model import BESIDE, BushModel, BushMotion, reach

SMALLEST_SLIP_ANGLE = 0.02  # of the reach: below it the element looks like dry friction
LARGEST_SLIP_ANGLE = 1.3  # of the reach: an element that hardly slips looks like a spring
SURE_SLIP_ANGLE = 0.8  # of the reach: beyond it few turns make the element slip, if any but the first
# Slip angles that are tried, a quarter apart, and closer where few turns are as long: of coarser ones the best led to
# another minimum.
RARE = 0.5  # of the reach: beyond it elements seldom slip, and even steps do
TRIED, TRIED_RARE = 14, 14  # slip angles on either side of that: steps between them are refined later


class Path(NamedTuple):
    """A deflection (N,), and where its r runs begin and end, (r, 2), one after the other: each has its own memory."""

    deflection: Array
    runs: NDArray[np.int64]

    @classmethod
    def of(cls, motion: BushMotion) -> Path:
        """The path of a motion."""
        runs = np.array([(run.start, run.stop) for run in motion.runs], dtype=np.int64)
        return cls(np.ascontiguousarray(motion.deflection), runs.reshape(-1, 2))


class Hysteretic(BushModel):
    """torque = K·q + C·q̇ + slip_torque·z + offset: an element beside the spring that yields around `slip_angle`.

    Before it yields it is a spring of slip_torque / slip_angle. The initial state of a run is z there.
    """

    terms: ClassVar[tuple[str, ...]] = (*BESIDE, "slip_torque")
    shape_terms: ClassVar[tuple[str, ...]] = ("slip_angle",)
    remembers: ClassVar[bool] = True
    tried_states: ClassVar[tuple[float, ...]] = (-0.9, -0.45, 0.0, 0.45, 0.9)
    blind_ends: ClassVar[frozenset[tuple[str, str]]] = frozenset({("slip_angle", "high")})
    dissipative_terms: ClassVar[tuple[str, ...]] = ("slip_torque",)
    units: ClassVar[dict[str, tuple[str, str]]] = {"slip_torque": ("N.m", "N"), "slip_angle": ("rad", "m")}

    @abstractmethod
    def states(self, path: Path, shapes: Array, initial_states: Array) -> Array:
        """z (N, b) along a path of r runs, for b variants of shape (b, s) and initial state (r, b); NaN elsewhere."""

    def candidates(self, motions: Sequence[BushMotion]) -> Array:
        """Slip angles in equal ratios, from what looks like dry friction to what hardly slips in these motions."""
        size = reach(motions) or 1.0
        usual = np.geomspace(SMALLEST_SLIP_ANGLE, RARE, TRIED)
        rare = np.linspace(RARE, LARGEST_SLIP_ANGLE, TRIED_RARE + 1)[1:]
        return size * np.concatenate([usual, rare])[:, None]

    def hardly_shown(self, shape: Array, limits: Array) -> str | None:
        """Where few turns of the path, if any, are as long as it takes to slip."""
        sure = limits[1, 0] * SURE_SLIP_ANGLE / LARGEST_SLIP_ANGLE
        return f"slip_angle {shape[0]:.3g} is hardly reached by these motions" if shape[0] > sure else None

    def initial_states(self, motion: BushMotion, shape: Array) -> Array:
        """State of an element that was loaded from rest to where each run begins."""
        first = np.array([motion.deflection[run.start] for run in motion.runs])
        return np.asarray(np.clip(first / shape[0], -1.0, 1.0))

    def basis_columns(self, motion: BushMotion, shapes: Array, initial_states: Array) -> Array:
        """The state z, (N, 1, b)."""
        return self.states(Path.of(motion), shapes, initial_states.T)[:, None, :]
