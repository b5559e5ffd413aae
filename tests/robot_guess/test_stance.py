"""Which way is up for an IMU, whatever it records."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from plantar.feet.interval_width.force_gain import CARRIED
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.robot_guess.stance import _rows, felt_up

TIME = 0.01 * np.arange(1000)


def test_attitude_and_accelerometer_feel_the_same_up() -> None:
    """A lean in each axis, slow beside what an accelerometer reads of gravity, and a shake of 0.3 g at 15 Hz."""
    lean = np.column_stack([0.4 + 0.1 * np.sin(0.5 * TIME), -0.3 + 0.1 * np.cos(0.4 * TIME), 0.2 * TIME])
    attitude = Rotation.from_rotvec(lean)
    up = attitude.inv().apply([0.0, 0.0, 1.0])
    shake = 3.0 * np.sin(2 * np.pi * 15 * TIME)
    felt = 9.81 * up + shake[:, None] * [1.0, -1.0, 0.5]
    quaternions = attitude.as_quat(scalar_first=True)
    quaternions[5] = 0.0  # as loggers write where nothing was received
    quaternions[6] *= 0.4  # between that and a reading
    told = MotionLog(
        "a", TIME, {f"imu.chest.orientation.{k}": v for k, v in zip("wxyz", quaternions.T, strict=True)}
    )
    read = MotionLog(
        "b", TIME, {f"imu.chest.linear_acceleration.{k}": v for k, v in zip("xyz", felt.T, strict=True)}
    )
    known = (np.arange(TIME.size) != 5) & (np.arange(TIME.size) != 6)
    assert felt_up(told, "chest")[known] == pytest.approx(up[known])
    assert np.isnan(felt_up(told, "chest")[5:7]).all()
    inside = slice(100, -100)  # where the filter is at home
    assert felt_up(read, "chest")[inside] == pytest.approx(up[inside], abs=0.02)
    assert np.isnan(felt_up(MotionLog("c", TIME, {}), "chest")).all()


def test_only_samples_are_taken_that_every_sensor_and_joint_has_read_under_the_robot() -> None:
    """Gaps of a force sensor, of the attitude and of each of three joints; early on the feet carry too little."""
    model = pin.buildSampleModelManipulator()
    names = list(model.names)[1:4]
    weight = 500.0
    columns = {f"imu.chest.orientation.{axis}": np.full(1000, float(axis == "w")) for axis in "wxyz"}
    columns |= {f"joint.{name}.position": np.zeros(1000) for name in names}
    columns |= {column: np.zeros(1000) for side in ("left", "right") for column in wrench_columns(side)}
    columns["wrench.left.force.z"][:] = columns["wrench.right.force.z"][:] = 0.51 * CARRIED * weight
    columns["wrench.left.force.z"][:100] = 0.48 * CARRIED * weight
    missing = {"wrench.right.torque.x": 200, "imu.chest.orientation.x": 300}
    missing |= {f"joint.{name}.position": 400 + 100 * place for place, name in enumerate(names)}
    for column, sample in missing.items():
        columns[column][sample - 10 : sample + 10] = np.nan
    taken = _rows(MotionLog("a", TIME, columns), {"l": "left", "r": "right"}, "chest", weight, model)
    left_out = {sample for middle in missing.values() for sample in range(middle - 10, middle + 10)}
    assert not left_out & set(taken.tolist())
    assert taken.min() >= 100
    assert len(taken) > 40
