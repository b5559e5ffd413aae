"""A simulated robot beside its record: attitudes in one world, torques at the bush, soles on the ground, by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped_robot import Frame, Mounting, make_robot
from plantar.contact.balance import soles_in_root
from plantar.conventions import rotation_from_rpy
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.robot.model import RobotModel
from plantar.twin.replay import _bush_wrench, _root, _torques, moved_onto, pitch_and_roll

TIME = np.arange(2000) / 200  # s: ten whole seconds
WAVE = np.cos(2 * np.pi * 0.3 * (TIME + 0.0025))  # three whole periods, even: no straight line is in it


def turned(x: np.ndarray, y: np.ndarray, z: np.ndarray | float = 0.0) -> np.ndarray:
    return Rotation.from_rotvec(np.column_stack([x, y, z + 0 * TIME])).as_matrix()


def test_pitch_and_roll_are_those_of_one_rotation_after_the_other() -> None:
    rpy = np.array([[0.4, -0.3, 2.0], [-0.9, 0.8, -1.0]])
    up = np.array([rotation_from_rpy(one)[2] for one in rpy])
    assert pitch_and_roll(up) == pytest.approx(rpy[:, [1, 0]])


def test_a_records_world_that_drifts_and_faces_elsewhere_is_not_the_feets() -> None:
    """The record's world leans by a degree and ever more, and is turned by one radian; the robot sways in both."""
    other = turned(0.05 * WAVE, 0.08 * np.sin(TIME))
    world = turned(0.02 + 0.001 * TIME, -0.01 + 0.002 * TIME) @ turned(0 * TIME, 0 * TIME, 1.0)
    recorded = world @ other
    assert moved_onto(recorded, other) == pytest.approx(recorded[:, 2, :], abs=2e-5)
    assert np.abs(other[:, 2, :] - recorded[:, 2, :]).max() > 0.01


def test_what_sways_otherwise_stays() -> None:
    """A record that stands still: of the other, its sway is left, less its lean and its drift."""
    sway = 0.03 * WAVE
    other = turned(0.02 + 0.001 * TIME + sway, 0 * TIME)
    found = pitch_and_roll(moved_onto(np.tile(np.eye(3), (TIME.size, 1, 1)), other))
    assert found[:, 1] == pytest.approx(sway, abs=1e-4)
    assert found[:, 0] == pytest.approx(0 * TIME, abs=1e-9)


def test_a_wrench_is_moved_to_the_bush_and_turned_into_its_axes(tmp_path: Path) -> None:
    bush, sensor = Frame((0.01, -0.02, -0.06), (0.1, -0.2, 0.3)), Frame((0.03, 0.01, -0.02), (-0.4, 0.2, 0.9))
    robot = make_robot(tmp_path, Mounting(bush=bush, wrench=sensor, sign=-1))
    read = np.array([[10.0, -20.0, 300.0, 4.0, -5.0, 6.0], [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]])
    columns = dict(zip(wrench_columns("left"), read.T, strict=True))
    log = MotionLog("m", np.array([0.0, 1.0]), columns)
    force, torque = _bush_wrench(robot, robot.feet["left"], log)
    for row, one in enumerate(-read):
        in_ankle, moment = sensor.rotation @ one[:3], sensor.rotation @ one[3:]
        moment = moment + np.cross(np.array(sensor.xyz) - bush.xyz, in_ankle)
        assert bush.rotation @ force[row] == pytest.approx(in_ankle)
        assert bush.rotation @ torque[row] == pytest.approx(moment)


def test_torques_are_told_from_their_mean_in_the_first_second(tmp_path: Path) -> None:
    """Of a log whose clock begins at five seconds; pitch is about y and roll about x."""
    robot = make_robot(tmp_path, Mounting(bush=Frame(), wrench=Frame()))
    columns = {name: np.zeros(4) for foot in robot.feet for name in wrench_columns(foot)}
    columns["wrench.right.torque.x"], columns["wrench.right.torque.y"] = np.array(
        [[1, 3, 7, 9], [-4, -6, 5, 2]]
    )
    found = _torques(robot, MotionLog("m", 5.0 + np.array([0.0, 0.5, 1.0, 1.5]), columns))
    assert set(found) == {(foot, axis) for foot in ("left", "right") for axis in ("pitch", "roll")}
    assert found["right", "roll"].tolist() == [-1.0, 1.0, 5.0, 7.0]
    assert found["right", "pitch"].tolist() == [1.0, -1.0, 10.0, 7.0]
    assert not found["left", "roll"].any()


@pytest.mark.parametrize(
    ("lower", "standing", "raised"),
    [(0.004, {"left", "right"}, 0.004), (-0.004, {"left", "right"}, 0.0), (0.004, {"left"}, 0.0)],
)
def test_no_sole_that_stands_is_below_the_ground(
    lower: float, standing: set[str], raised: float, robot: RobotModel
) -> None:
    """The left sole lies where it is told to; of the right one, a little lower, the lowest corner is on the ground."""
    positions = np.zeros(len(robot.joint_names))
    positions[robot.joint_names.index("right_leg_z")] = -lower
    level = np.eye(4)
    level[:2, 3] = 0.3, -0.2
    left = soles_in_root(robot, positions)["left"]
    root = _root(robot, positions, {"left": level, "right": np.eye(4)}, standing)
    found = root @ left
    assert found[:3, :3] == pytest.approx(np.eye(3))
    assert found[:3, 3] == pytest.approx([0.3, -0.2, raised])
