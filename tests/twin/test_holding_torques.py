"""What joints hold of a robot that stands still, by virtual work."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from biped import record, sway
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.robot.model import RobotModel
from plantar.twin.holding_torques import holding_torques

STEP = 1e-6  # rad
FORCE = np.array([30.0, -20.0, 250.0])  # N, in the sensor's axes


def standing(robot: RobotModel, force: np.ndarray) -> MotionLog:
    """A log in which the left foot alone carries `force`."""
    log = record(sway(duration=1.0))
    wrench = {name: np.zeros(len(log)) for foot in robot.feet for name in wrench_columns(foot)}
    return log.with_columns(
        wrench
        | {name: np.full(len(log), one) for name, one in zip(wrench_columns("left")[:3], force, strict=True)}
    )


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_weight_less_what_the_ground_carries(robot: RobotModel, sign: float) -> None:
    """A joint that turns a little lifts masses, and moves the foot along the ground's force."""
    left = robot.feet["left"]
    robot = replace(robot, feet={**robot.feet, "left": replace(left, wrench=replace(left.wrench, sign=sign))})
    log = standing(robot, sign * FORCE)
    before = robot.model.gravity.linear.copy()
    held = holding_torques(robot, log)
    np.testing.assert_array_equal(robot.model.gravity.linear, before)
    model, data = robot.model.copy(), robot.model.createData()
    carrier, seat = robot.frame(left.wrench.placement)
    first = log.positions(robot)[0]

    def placed(positions: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
        q = robot.configuration(positions)
        pin.forwardKinematics(model, data, q)
        pose = data.oMi[carrier] * seat
        return pin.computePotentialEnergy(model, data, q), pose.translation.copy(), pose.rotation.copy()

    pin.forwardKinematics(model, data, robot.configuration(first))
    soles = [robot.frame(foot.sole.placement) for foot in robot.feet.values()]
    soles = [data.oMi[joint].rotation @ place.rotation for joint, place in soles]
    up = np.mean([rotation[:, 2] for rotation in soles], axis=0)
    model.gravity.linear = -9.80665 * up / np.linalg.norm(up)
    _, _, axes = placed(first)
    for joint in range(len(first)):
        ends = [placed(first + side * STEP * (np.arange(len(first)) == joint)) for side in (1.0, -1.0)]
        lifted = (ends[0][0] - ends[1][0]) / (2 * STEP)
        carried = (axes @ FORCE) @ (ends[0][1] - ends[1][1]) / (2 * STEP)
        assert held[0, joint] == pytest.approx(lifted - carried, abs=1e-3), robot.joint_names[joint]
    assert np.abs(held[0]).max() > 10.0


def test_the_last_sample_is_looked_at_wherever_it_falls(robot: RobotModel) -> None:
    """Of 95 samples, each twentieth and the last; between two of them a straight line."""
    log = record(sway(duration=1.0)).select(slice(0, 95))
    held = holding_torques(robot, log)
    for row in (20, 80, 94):
        alone = holding_torques(robot, log.select(slice(row - 1, row + 1)))
        np.testing.assert_allclose(held[row], alone[1], atol=1e-9)
    np.testing.assert_allclose(held[87], (held[80] + held[94]) / 2, atol=1e-9)
    assert np.abs(held[94] - held[80]).max() > 1e-3
