"""Which way is up for an IMU, whatever it records."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.logs.motion_log import MotionLog
from plantar.robot_guess.stance import felt_up

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
    told = MotionLog(
        "a", TIME, {f"imu.chest.orientation.{k}": v for k, v in zip("wxyz", quaternions.T, strict=True)}
    )
    read = MotionLog(
        "b", TIME, {f"imu.chest.linear_acceleration.{k}": v for k, v in zip("xyz", felt.T, strict=True)}
    )
    known = np.arange(TIME.size) != 5
    assert felt_up(told, "chest")[known] == pytest.approx(up[known])
    assert np.isnan(felt_up(told, "chest")[5]).all()
    inside = slice(100, -100)  # where the filter is at home
    assert felt_up(read, "chest")[inside] == pytest.approx(up[inside], abs=0.02)
    assert np.isnan(felt_up(MotionLog("c", TIME, {}), "chest")).all()
