"""Motions of the campaign as they are kept: every joint's way, the base's, where the soles stand, and the hand's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from kept_texts import assert_as_kept, described
from plantar.motions import planned_balance
from plantar.motions.footsteps import footsteps
from plantar.motions.gait import Gait, gait_of
from plantar.twin.robots import hrp2
from twin_samples import plan

KEPT = Path(__file__).parent / "kept"


@pytest.mark.parametrize(
    "motion",
    ["Tilt4", "Manual_right_roll", "Manual_left_pitch", "Manual_both_pitch", "Myrand4", "Myrand5", "Squat"],
)
def test_a_motion_is_as_it_is_kept(motion: str) -> None:
    found = plan(motion)
    ways = {name: found.positions[:, place] for place, name in enumerate(found.joints)}
    told = {"plan": found, "ways": ways, "balance": planned_balance(hrp2.robot(), found)}
    assert_as_kept(described(told), KEPT / f"{motion}.txt", share=1e-4, least=1e-5)


@pytest.mark.parametrize("name", ["WalkTurn_3", "WalkSlow8", "few wide steps"])
def test_footsteps_are_as_they_are_kept(name: str) -> None:
    """From soles that do not stand side by side nor ahead, and whose outlines are not about their frames."""
    soles = {
        foot: pin.SE3(pin.exp3(np.array([0.0, 0.0, 0.3 + turn])), np.array([x, y, 0.0]))
        for foot, turn, x, y in (("left", 0.1, 0.02, 0.11), ("right", -0.05, -0.03, -0.1))
    }
    middles = {"left": np.array([0.02, 0.01, 0.1, 0.05]), "right": np.array([0.01, -0.01, 0.11, 0.06])}
    gait = Gait(0.3, 0.7, -0.1, 3, 2) if " " in name else gait_of(name, period=None)
    steps = footsteps(gait, soles, middles)
    time = np.arange(0.0, steps.duration + 1.0, 0.05)
    told = {
        "gait": gait, "steps": {"start": steps.start, "swings": steps.swings[-3:], "points": steps.waypoints},
        "zmp": steps.zmp(time), "soles": steps.soles(time), "stands": steps.stands(time),
        "heading": steps.heading(time),
    }  # fmt: skip
    assert_as_kept(described(told), KEPT / f"{name.replace(' ', '_')}.txt", share=1e-6, least=1e-8)
