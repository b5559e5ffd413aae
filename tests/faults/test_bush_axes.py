"""Bushes whose axes the robot file has wrong: pitch and roll would be exchanged, and nothing else would show it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import FEET, make_robot, robot_entry
from plantar.faults.bush_frames import check_bush_axes
from plantar.feet.identify import identify_feet
from plantar.robot.model import RobotModel


def turned(folder: Path, degrees: float) -> RobotModel:
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    for foot in feet.values():
        foot["bush"] = {**foot["bush"], "rpy": [0.0, 0.0, float(np.radians(degrees))]}
    return make_robot(folder, feet=feet)


@pytest.mark.parametrize(("degrees", "count"), [(0, 0), (20, 0), (-30, 0), (90, 2), (-90, 2)])
def test_an_x_axis_that_points_to_the_other_foot_is_told(tmp_path: Path, degrees: float, count: int) -> None:
    found = list(check_bush_axes(turned(tmp_path, degrees), record(sway())))
    assert len(found) == count
    assert all(one.code == "bush_axes" and not one.fatal for one in found)
    assert [one.text for one in found] == [
        f"robot file, feet.{foot}.bush.rpy: its x axis points to the other foot: pitch and roll would be exchanged "
        "(valid: x to the toes, y to the left, z up)"
        for foot in ("left", "right")[:count]
    ]


@pytest.mark.parametrize("names", [{}, {"left": "right", "right": "left"}])
def test_a_foot_that_is_named_after_the_other_side_is_told(tmp_path: Path, names: dict[str, str]) -> None:
    feet = robot_entry()["feet"]
    assert isinstance(feet, dict)
    robot = make_robot(tmp_path, feet={names.get(name, name): foot for name, foot in feet.items()})
    text = (
        "robot file, feet: the foot 'left' stands to the right of the foot 'right' (valid: exchange the two names; or, "
        "where x of their bushes points to the heels, turn it to the toes)"
    )
    found = [(one.code, one.text) for one in check_bush_axes(robot, record(sway()))]
    assert found == [("feet_exchanged", text)] * bool(names)


@pytest.mark.parametrize("pitch", [0.0, 1.2])
def test_bushes_turn_and_move_with_their_ankles(tmp_path: Path, pitch: float) -> None:
    """Far above and below their ankles, they stay beside each other in ankles that pitch alike; before and behind them
    they do not."""
    log = record(sway(duration=4.0))
    log = log.with_columns({f"joint.{foot}_ankle_pitch.position": np.full(len(log), pitch) for foot in FEET})
    for offset, count in (([0.0, 0.0, 0.5], 0), ([0.5, 0.0, 0.0], 2)):
        feet = robot_entry()["feet"]
        assert isinstance(feet, dict)
        for foot, sign in zip(FEET, (1, -1), strict=True):
            feet[foot]["bush"] = {"xyz": [sign * each for each in offset]}
        assert len(list(check_bush_axes(make_robot(tmp_path, feet=feet), log))) == count


def test_no_number_of_such_a_foot_is_usable(tmp_path: Path) -> None:
    found = identify_feet(turned(tmp_path, 90), [record(sway())])
    assert not [row for row in found.parameters if row.axis != "z" and row.verdict == "usable"]
