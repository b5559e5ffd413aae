"""Joints' names of several logs together: one that lacks a joint takes nothing away from those that have it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

import numpy as np
import pytest

from plantar.logs.motion_log import MotionLog
from plantar.robot.joint_names import JointNames
from plantar.robot_guess import _with_names

JOINTS = ("left_hip", "left_knee", "right_hip", "right_knee")
TIME = np.arange(3.0)


@dataclass(frozen=True)
class Named:
    """What a draft holds of names."""

    names: JointNames
    numbered: bool = False


@pytest.mark.parametrize("called", ["motor_{place}", "robot/{joint}"])
def test_the_names_are_those_of_all_logs_in_any_order(called: str) -> None:
    """The first log has both legs' hips, the second all but one knee, the third that knee."""
    names = [called.format(place=place, joint=joint) for place, joint in enumerate(JOINTS)]
    logs = [
        MotionLog(f"log_{number}", TIME, {f"joint.{names[place]}.position": TIME + place for place in places})
        for number, places in enumerate(((0, 2), (0, 1, 2), (3,)))
    ]
    for order in permutations(logs):
        draft, read = _with_names(Named(JointNames()), JOINTS, order)  # type: ignore[arg-type]
        assert [draft.names.in_log(joint) for joint in JOINTS] == names
        assert draft.numbered == called.startswith("motor")
        held = {name: values[0] for log in read for name, values in log.columns.items()}
        assert held == {f"joint.{joint}.position": place for place, joint in enumerate(JOINTS)}
