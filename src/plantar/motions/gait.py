"""How a robot walks: step length, step period and turn, by the names of walks."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.errors import MotionError

WALKS: Final = (
    "Walk8", "Walk12", "Walk16", "Walk20", "WalkSlow8", "WalkSlow12", "WalkQuick8", "WalkQuick12", "WalkTurn",
    "WalkInPlace",
)  # fmt: skip
NAME: Final = re.compile(
    r"Walk((?P<pace>Slow|Quick)?(?P<centimetres>[1-9]\d?)|(?P<kind>Turn|InPlace))(_(?P<trial>\d{1,4}))?"
)
PERIODS: Final = {None: 1.0, "Slow": 4.0, "Quick": 0.8}  # s
# s: quicker, and the feet have to accelerate more than joints allow; slower, and a log holds too few steps
SHORTEST, LONGEST = 0.6, 6.0
WALKING: Final = 24.0  # s of steps in one log
TURN: Final = np.radians(8.0)  # rad a step, inside the yaw that hips have
TURN_STEP: Final = 0.08  # m: a step of a robot that turns, where the walk's name tells none


@dataclass(frozen=True)
class Gait:
    """A walk of equal steps.

    `step` [m]: from one footfall to the next of the other foot, along the walk; `period` [s]: of one step, its
    double support included; `turn` [rad]: to the left, in each step; `steps`: how many, the last one brings the feet
    level; `trial`: of several of one name, each lands a little otherwise.
    """

    step: float
    period: float
    turn: float
    steps: int
    trial: int


def is_walk(name: str) -> bool:
    """Whether a motion's name is a walk's."""
    return NAME.fullmatch(name) is not None


def gait_of(name: str, period: float | None) -> Gait:
    """The gait of a walk's name, which is one of WALKS or such a name with another length in cm; `_2` for trial 2.

    `period` [s] replaces the name's own. Raises MotionError for a name that is no walk's and for a period
    that no walk has.
    """
    match = NAME.fullmatch(name)
    if match is None:
        raise MotionError(f"unknown walk '{name}'", valid=", ".join(WALKS))
    chosen = PERIODS[match["pace"]] if period is None else period
    if not SHORTEST <= chosen <= LONGEST:
        valid = f"{SHORTEST:g} to {LONGEST:g} s"
        raise MotionError(f"{name}: no period of a step", value=chosen, valid=valid)
    turns = match["kind"] == "Turn"
    length = int(match["centimetres"]) / 100 if match["centimetres"] else TURN_STEP if turns else 0.0
    return Gait(length, chosen, TURN if turns else 0.0, round(WALKING / chosen), int(match["trial"] or 0))
