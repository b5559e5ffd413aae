"""Wrenches that a controller writes in the world's axes instead of the sensors'."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from plantar.faults.standing import check_balance
from plantar.logs.motion_log import MotionLog
from plantar.twin import PAPER, PRESETS
from plantar.twin.recording import record
from plantar.twin.robots import hrp2
from twin_samples import tilted

SENSORS = PRESETS["sensors"]


@pytest.fixture(scope="module")
def tilt() -> MotionLog:
    """Both feet, nobody near."""
    return record(tilted(), hrp2.robot(), SENSORS.physics(PAPER), SENSORS, 0).log


def in_the_world(log: MotionLog, degrees: float) -> MotionLog:
    """Rows of the log of a robot that faces another way, each wrench turned to the world's axes by Pinocchio."""
    robot, rows = hrp2.robot(), slice(0, len(log), 10)
    assert robot.imu is not None
    log = MotionLog(log.name, log.time[rows], {name: log.column(name)[rows] for name in log.columns})
    names = [f"imu.{robot.imu.name}.orientation.{axis}" for axis in "wxyz"]
    attitude = Rotation.from_quat(log.stack(names), scalar_first=True)
    attitude = Rotation.from_euler("z", degrees, degrees=True) * attitude
    turned = dict(zip(names, attitude.as_quat(scalar_first=True).T, strict=True))
    mounts = [
        robot.frame(robot.imu.placement),
        *(robot.frame(f.wrench.placement) for f in robot.feet.values()),
    ]
    data = robot.model.createData()
    world = np.empty((len(robot.feet), len(log), 3, 3))
    for row, q in enumerate(log.positions(robot)):
        pin.forwardKinematics(robot.model, data, q)
        imu, *sensors = (data.oMi[joint].rotation @ place.rotation for joint, place in mounts)
        world[:, row] = [attitude[row].as_matrix() @ imu.T @ sensor for sensor in sensors]
    for foot, turns in zip(robot.feet.values(), world, strict=True):
        for kind in ("force", "torque"):
            columns = [f"wrench.{foot.wrench.name}.{kind}.{axis}" for axis in "xyz"]
            turned |= dict(zip(columns, np.einsum("nij,nj->in", turns, log.stack(columns)), strict=True))
    return log.with_columns(turned)


@pytest.mark.parametrize("degrees", [0.0, 35.0, -70.0, 140.0])
def test_wrenches_in_the_world_s_axes_are_told(tilt: MotionLog, degrees: float) -> None:
    (finding,) = check_balance(hrp2.robot(), in_the_world(tilt, degrees))
    assert finding.code == "wrench_turned"
    assert "read as in the world's axes" in finding.text
