"""What a feet result holds of feet that step: each stance, each walk by itself, each swing's zero of the sensor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from plantar.conventions import Axis

Interval = tuple[float, float]
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class StanceStiffness:
    """Stiffness [N·m/rad] by one stance, with an offset of its own; what else the torque holds is as in the whole fit.

    `start` and `end` [s] are those of its used samples. `share`: how much it says beside all fitted stances of this
    foot and axis, by load and motion; the mean of fitted stances with these weights is nearly the whole fit's value.
    """

    motion: str
    role: Literal["fit", "validate"]
    foot: str
    axis: Axis
    start: float
    end: float
    stiffness: float
    share: float


@dataclass(frozen=True)
class WalkStiffness:
    """Stiffness [N·m/rad] by one recording alone: the whole fit repeated on its stances, with everything free.

    `interval95` comes from refits without one of its `stances` each. Causes that all recordings share are not in it.
    """

    motion: str
    role: Literal["fit", "validate"]
    foot: str
    axis: Axis
    stances: int
    stiffness: float
    interval95: Interval


@dataclass(frozen=True)
class SwingZero:
    """What a force sensor read in the middle of one swing, at `time` [s], in its own frame [N, N·m], and what was
    taken off there as its zero."""

    motion: str
    foot: str
    time: float
    force: Vector
    torque: Vector
    force_zero: Vector
    torque_zero: Vector
