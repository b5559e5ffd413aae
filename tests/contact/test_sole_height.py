"""What a robot file may be off by changes the height between two soles as geometry says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sway
from feet_trials import noisy, without
from plantar.contact.deflection import bush_states
from plantar.contact.relative_pose import relative_pose
from plantar.contact.sole_height import height_changes
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT, Uncertainty


def height(robot: RobotModel, log: MotionLog) -> np.ndarray:
    still = np.zeros((len(log.time), 3))
    positions, unloaded = log.positions(robot), {foot: np.zeros((len(log.time), 6)) for foot in robot.feet}
    attitude = log.orientation(robot.imu.name)
    states = bush_states(robot, positions, np.zeros_like(positions), attitude, still, unloaded)
    return relative_pose(*(states[foot] for foot in robot.feet)).position[:, 2]


def test_a_zero_of_a_joint_and_a_bush_beside_its_place(robot: RobotModel) -> None:
    log = record(sway("sway", 3))
    robot = replace(robot, uncertainty=Uncertainty())
    changes = dict(height_changes(log, robot, rows=slice(None)))
    joint = next(name for name in changes if name.endswith("ankle_roll"))
    column = f"joint.{joint}.position"
    moved = log.with_columns({column: log.columns[column] + 0.001})
    np.testing.assert_allclose(changes[joint], height(robot, moved) - height(robot, log), atol=2e-6)
    foot = robot.feet["left"]
    aside = foot.bush.xyz + 0.003 * foot.bush.rotation[:, 0]
    other = replace(robot, feet={**robot.feet, "left": replace(foot, bush=replace(foot.bush, xyz=aside))})
    np.testing.assert_allclose(changes["left x"], height(other, log) - height(robot, log), atol=2e-6)
    assert np.ptp(changes["left x"]) > 1e-5  # a sole that leans rises and falls about it


def test_an_exact_robot_has_no_causes(robot: RobotModel) -> None:
    assert (
        list(height_changes(record(sway("sway", 3)), replace(robot, uncertainty=EXACT), rows=slice(None)))
        == []
    )


def test_changes_follow_the_deviations(robot: RobotModel) -> None:
    log = record(sway("sway", 3))
    once, twice = (
        dict(height_changes(log, replace(robot, uncertainty=Uncertainty(imu_mount=mount)), rows=slice(None)))
        for mount in (0.01, 0.02)
    )
    np.testing.assert_allclose(twice["imu x"], 2 * once["imu x"])
    assert np.abs(once["imu x"]).max() == pytest.approx(np.abs(np.median(once["imu x"])), rel=0.1)


def test_an_imu_that_is_turned_about_each_axis(robot: RobotModel) -> None:
    """As a log whose attitude is turned by the mount's deviation about that axis of the IMU."""
    log = record(sway("sway", 3))
    changes = dict(
        height_changes(log, replace(robot, uncertainty=Uncertainty(imu_mount=0.01)), rows=slice(None))
    )
    names = [f"imu.{robot.imu.name}.orientation.{axis}" for axis in "wxyz"]
    believed = Rotation.from_quat(log.stack(names), scalar_first=True)
    assert {name for name in changes if name.startswith("imu ")} == {"imu x", "imu y", "imu z"}
    for place, axis in enumerate("xyz"):
        found = []
        for sign in (1.0, -1.0):
            turned = (believed * Rotation.from_rotvec(sign * 0.01 * np.eye(3)[place])).as_quat(
                scalar_first=True
            )
            moved = log.with_columns(dict(zip(names, turned.T, strict=True)))
            found.append(height(robot, moved) - height(robot, log))
        apart = [np.abs(one - changes[f"imu {axis}"]).max() for one in found]
        assert min(apart) < 0.05 * np.abs(changes[f"imu {axis}"]).max() + 2e-5


def test_a_log_without_orientation_has_the_same_causes(robot: RobotModel) -> None:
    """One without causes would pass for one in which nothing can be wrong, and so would all logs beside it."""
    log, robot = noisy(record(sway("sway", 3)), 3), replace(robot, uncertainty=Uncertainty())
    known, derived = (
        dict(height_changes(one, robot, rows=slice(None))) for one in (log, without(log, "orientation"))
    )
    assert derived.keys() == known.keys()
    for cause, change in known.items():
        np.testing.assert_allclose(derived[cause], change, atol=0.1 * np.abs(change).max() + 2e-6)


def test_a_hole_in_a_joint_leaves_the_samples_beside_it(robot: RobotModel) -> None:
    log, robot = record(sway("sway", 3)), replace(robot, uncertainty=Uncertainty())
    column = log.columns["joint.left_leg_z.position"].copy()
    column[498:562] = np.nan
    spoiled = log.with_columns({"joint.left_leg_z.position": column})
    for cause, change in height_changes(spoiled, robot, np.isfinite(column)):
        assert np.isfinite(change).all(), cause
