"""Joints that never move: at rest with those of the other leg, or alone, and then a dead encoder."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from feet_trials import noisy
from plantar.faults.joints.still_joints import check_still_joints
from plantar.feet.assess.data_faults import UNMENDED
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel


def log_of(robot: RobotModel, still: list[str], reach: float = 0.1, noise: float = 1.0) -> MotionLog:
    """Of ten joints between IMU and feet, of which these stand and the others turn by `reach` [rad]; `noise`: of the
    sensors, times a usual one."""
    exact = record(sway())
    loud = noisy(exact, 1)
    log = exact.with_columns(
        {
            name: exact.column(name) + noise * (loud.column(name) - exact.column(name))
            for name in exact.columns
        }
    )
    assert robot.imu is not None
    moving = {f"joint.{name}.position": np.linspace(0.0, reach, len(log)) for name in robot.path_joints}
    assert len(moving) == 10
    return log.with_columns(moving | {f"joint.{name}.position": np.full(len(log), 0.1) for name in still})


@pytest.mark.parametrize("axis", ["pitch", "roll"])
def test_a_joint_that_stands_while_the_other_legs_turns_is_doubted(robot: RobotModel, axis: str) -> None:
    (found,) = check_still_joints(robot, log_of(robot, [f"left_ankle_{axis}"]))
    assert (found.code, found.severity, found.fatal) == ("stuck_channel", "warning", False)
    assert found.text == (
        f"column 'joint.left_ankle_{axis}.position': never changes while the same joint of another leg moves; the "
        "encoder is dead, or its column repeats an old value (valid: leave such cells empty)"
    )
    assert found.code in UNMENDED, "no number of such a log is usable"


@pytest.mark.parametrize(("noise", "code"), [(0.0007, "stuck_channel"), (0.0005, "still_joint")])
def test_motors_of_a_simulation_without_noise_may_hold_as_they_are_told(
    robot: RobotModel, noise: float, code: str
) -> None:
    """A usual noise is a sixth of what these sensors read."""
    (found,) = check_still_joints(robot, log_of(robot, ["left_ankle_roll"], noise=noise))
    assert found.code == code


def test_joints_of_both_legs_that_stand_are_at_rest(robot: RobotModel) -> None:
    (found,) = check_still_joints(robot, log_of(robot, ["left_ankle_roll", "right_ankle_roll"]))
    assert (found.code, found.severity) == ("still_joint", "info")
    assert found.text == (
        "columns 'joint.left_ankle_roll.position', 'joint.right_ankle_roll.position': never change; right if the joint "
        "stood still, else the channel is dead"
    )


@pytest.mark.parametrize(("reach", "code"), [(0.0203, "still_joint"), (0.0205, "stuck_channel")])
def test_the_other_leg_has_to_turn_by_more_than_a_servo_hunts(
    robot: RobotModel, reach: float, code: str
) -> None:
    """98 % of a ramp of 20.4 mrad are 20 mrad."""
    (found,) = check_still_joints(robot, log_of(robot, ["left_ankle_roll"], reach))
    assert found.code == code


def test_a_spike_of_the_other_leg_is_no_motion(robot: RobotModel) -> None:
    log = log_of(robot, ["left_ankle_roll"])
    spike = np.full(len(log), 0.1)
    spike[100] = 1.0
    (found,) = check_still_joints(robot, log.with_columns({"joint.right_ankle_roll.position": spike}))
    assert found.code == "still_joint"


@pytest.mark.parametrize(("count", "told"), [(4, True), (5, False)])
def test_of_a_robot_that_stands_still_they_say_nothing(robot: RobotModel, count: int, told: bool) -> None:
    """Fewer than half of the legs' joints may be dead."""
    still = sorted(robot.path_joints)[:count]
    found = [*check_still_joints(robot, log_of(robot, still))]
    assert bool(found) is told
    assert all(any(name in one.text for one in found) for name in still if told)
