"""The acceleration of an IMU over soles that stand: that of an accelerometer, without one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from biped import record, sines, sway
from feet_trials import without
from plantar.contact.standing_imu import StandingImu
from plantar.conventions import GRAVITY, rotation_from_quaternion
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel
from plantar.signals.resampling import shifted

INNER = slice(200, -200)  # filters and differences know less at both ends


@pytest.fixture(scope="module")
def log() -> MotionLog:
    torso = (sines((0.03, 0.25, 1.0)), sines((0.04, 0.3, 0.0), (0.02, 1.1, 1.0)), sines((0.0, 0.0, 0.0)))
    return record(sway("sway", duration=20.0, torso=torso))


def standing(robot: RobotModel, log: MotionLog) -> StandingImu:
    found = StandingImu.of(robot, without(log, "linear_acceleration"))
    assert found is not None
    return found


def test_it_is_what_an_accelerometer_reads(robot: RobotModel, log: MotionLog) -> None:
    read, found = log.linear_acceleration("chest")[INNER], standing(robot, log).proper()[INNER]
    moves = np.std(read, axis=0).max()
    assert moves > 0.1
    assert np.abs(found - read).max() < 0.03 * moves


def test_a_robot_at_rest_reads_gravity_along_its_own_up(robot: RobotModel, log: MotionLog) -> None:
    still = log.with_columns({name: np.full(len(log), log.column(name)[0]) for name in log.columns})
    up = rotation_from_quaternion(still.orientation("chest"))[:, 2]
    np.testing.assert_allclose(standing(robot, still).proper(), GRAVITY * up, atol=1e-6)


def test_heading_and_length_of_quaternions_do_not_enter(robot: RobotModel, log: MotionLog) -> None:
    from scipy.spatial.transform import Rotation

    names = imu_columns("chest", "orientation")
    about = Rotation.from_euler("z", 70, degrees=True)
    turned = (about * Rotation.from_quat(log.stack(names), scalar_first=True)).as_quat(scalar_first=True)
    other = log.with_columns(dict(zip(names, 1.02 * turned.T, strict=True)))
    expected = standing(robot, log).proper()
    np.testing.assert_allclose(standing(robot, other).proper(), expected, atol=1e-6)


def test_only_feet_that_carry_the_robot_count(robot: RobotModel, log: MotionLog) -> None:
    """A leg in the air may move as it likes; of a robot that hangs nothing is known."""
    air = [name for name in log.columns if name.startswith("wrench.") and "left" in name]
    lifted = log.with_columns({name: 0.0 * log.column(name) for name in air})
    ankle = next(name for name in log.columns if "left" in name and name.endswith(".position"))
    waved = lifted.with_columns({ankle: lifted.column(ankle) + 0.3 * np.sin(3 * log.time)})
    expected = standing(robot, lifted).proper()
    np.testing.assert_allclose(standing(robot, waved).proper(), expected, atol=1e-9)
    assert np.abs(standing(robot, log.with_columns(waved.columns)).proper() - expected).max() < 1e-9
    wrenches = [name for name in log.columns if name.startswith("wrench.")]
    hangs = log.with_columns({name: 0.2 * log.column(name) for name in wrenches})
    assert np.isnan(standing(robot, hangs).proper()).all()


def test_its_slope_is_that_of_encoders_read_later(robot: RobotModel, log: MotionLog) -> None:
    """Legs that bend move it; read on time and then late by a little, encoders add that slope."""
    one, late = standing(robot, log), 0.003
    bent = replace(one, positions=one.positions + 0.05 * np.sin(2 * log.time)[:, None])
    proper, slope = bent.along_encoders
    np.testing.assert_allclose(proper, bent.proper())
    later = replace(bent, positions=shifted(bent.positions, bent.period, late)).proper()
    moved = (later - proper)[INNER]
    assert np.abs(moved).max() > 1e-3
    assert np.abs(moved - late * slope[INNER]).max() < 0.05 * np.abs(moved).max()
    np.testing.assert_allclose(bent.proper(late)[INNER], later[INNER])


def test_an_imu_that_is_turned_in_its_mount_is_one_of_another_robot_file(
    robot: RobotModel, log: MotionLog
) -> None:
    """But for what lies between bush and sole, which stands upright whatever the IMU says; by its slopes likewise."""
    turn = np.array([0.004, -0.003, 0.02])
    placement = robot.required_imu.placement
    rpy = pin.rpy.matrixToRpy(placement.rotation @ pin.exp3(turn))
    other = replace(robot, imu=replace(robot.required_imu, placement=replace(placement, rpy=rpy)))
    expected, one = standing(other, log).proper(), standing(robot, log)
    change = expected - one.proper()
    turned = one.proper(turn=pin.exp3(turn)) - one.proper()
    by_slope = np.tensordot(turn, one.by_turn, 1)
    for each in (turned, by_slope):
        assert np.abs(each - change).max() < 0.1 * np.abs(change).max()
    assert np.abs(by_slope - turned).max() < 0.02 * np.abs(change).max()


def test_nothing_is_known_without_an_orientation(robot: RobotModel, log: MotionLog) -> None:
    assert StandingImu.of(robot, without(log, "orientation")) is None
    assert StandingImu.of(replace(robot, imu=None), log) is None
