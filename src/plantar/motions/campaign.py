"""The paper's fourteen motions, and walks, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.contact.balance import Balance
from plantar.errors import MotionError
from plantar.motions.body import Body
from plantar.motions.feasible import check
from plantar.motions.gait import WALKS, gait_of, is_walk
from plantar.motions.manual import manual_plan
from plantar.motions.plan import Plan
from plantar.motions.stance import STEP_ASIDE, STEP_FORWARD, Stance, on_one_leg, stand, with_arms
from plantar.motions.tilt import squat_plan, tilt_plan
from plantar.motions.upper import sweep_plan
from plantar.motions.walk import walk_plan
from plantar.robot.model import RobotModel

FIT: Final = ("Manual_right_roll", "Manual_right_pitch", "Manual_left_roll", "Manual_left_pitch", "Tilt3")
DEMO: Final = (*FIT, "Tilt1", "Squat")
CAMPAIGN: Final = (
    "Tilt1", "Tilt2", "Tilt3", "Tilt4", "Tilt5", "Tilt6",
    "Manual_right_roll", "Manual_right_pitch", "Manual_left_roll", "Manual_left_pitch", "Manual_both_pitch",
    "Myrand4", "Myrand5", "Squat",
)  # fmt: skip


@dataclass(frozen=True)
class Postures:
    """What a robot's motions start from: joint positions [rad] of standing and of the arm states D and E.

    None lets the knees bend a little from the neutral position; arms that are not named stay as they are.
    """

    standing: Mapping[str, float] | None = None
    arms_aside: Mapping[str, float] | None = None
    arms_forward: Mapping[str, float] | None = None


def plan_motion(
    name: str,
    robot: RobotModel,
    postures: Postures | None = None,
    *,
    sway: float | None = None,
    vertical: float | None = None,
    apart: float | None = None,
    period: float | None = None,
) -> Plan:
    """One of the paper's motions, or a walk, for a robot with two feet and an IMU.

    `sway` [m]: how far tilts move the chest (0.02 as in the paper) and how far the operator's hand leads it;
    `vertical` [m]: how far the chest goes down in Tilt4 to Tilt6 (0.07) and squats (0.1); `apart` [m]: between the
    soles (as in the posture); `period` [s]: of one step of a walk (as its name says). Raises MotionError, in one line
    that says when and by how much, where the name is unknown, a place out of reach, a joint's limit passed or the
    balance lost.
    """
    if name not in CAMPAIGN and not is_walk(name):
        raise MotionError(f"unknown motion '{name}'", valid=", ".join((*CAMPAIGN, *WALKS)))
    gait = gait_of(name, period) if is_walk(name) else None
    body, postures = Body(robot), postures or Postures()
    if gait is not None:
        plan = walk_plan(body, name, _standing(body, postures, "A", apart), gait)
    else:
        plan = _plan(body, name, postures, sway, vertical, apart)
    check(body, plan)
    return plan


def planned_balance(robot: RobotModel, plan: Plan) -> Balance:
    """The zero-moment point that a plan asks for, over the soles that stand (figures 4 and 6 of the paper)."""
    return check(Body(robot), plan)


def _plan(
    body: Body, name: str, postures: Postures, sway: float | None, vertical: float | None, apart: float | None
) -> Plan:
    if name.startswith("Tilt"):
        number = int(name[-1])
        lower = (0.07 if vertical is None else vertical) if number > 3 else 0.0
        start = _standing(body, postures, "ABC"[(number - 1) % 3], apart)
        return tilt_plan(body, name, start, 0.02 if sway is None else sway, lower)
    start = _standing(body, postures, "A", apart)
    if name == "Squat":
        return squat_plan(body, name, start, 0.1 if vertical is None else vertical)
    if name.startswith("Myrand"):
        return sweep_plan(body, name, start, int(name[-1]))
    _, foot, axis = name.split("_")
    arms = (postures.arms_aside if axis == "roll" else postures.arms_forward) or {}
    start = with_arms(body, start, arms) if foot == "both" else on_one_leg(body, start, foot, arms)
    reach = None if sway is None else np.array([sway, sway])
    return manual_plan(body, name, start, "pitch" if axis == "pitch" else "roll", reach)


def _standing(body: Body, postures: Postures, state: str, apart: float | None) -> Stance:
    """The paper's states of the legs: regular (A), right leg aside (B), right leg forward (C)."""
    steps = {"A": (0.0, 0.0), "B": (0.0, -STEP_ASIDE), "C": (STEP_FORWARD, 0.0)}[state]
    return stand(body, postures.standing, {"right": steps}, apart)
