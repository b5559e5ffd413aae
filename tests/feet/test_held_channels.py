"""Sensors at their full scale or frozen for a while: these samples serve nowhere, the others give the right numbers."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from feet_trials import LINEAR, assert_truth, codes, noisy
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

TORQUES = ("wrench.left.torque.x", "wrench.left.torque.y")


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return noisy(record(sway(duration=40.0)), 1)


def test_a_clipped_torque_is_left_out(robot: RobotModel, log: MotionLog) -> None:
    def clipped(name: str) -> np.ndarray:
        values = log.column(name)
        middle, reach = np.median(values), 0.6 * float(np.ptp(values)) / 2
        return np.clip(values, middle - reach, middle + reach)

    found = identify_feet(
        robot, [log.with_columns({name: clipped(name) for name in TORQUES})], settings=LINEAR
    )
    assert_truth(found, 0.01)
    assert "stuck_channel" in codes(found)
    told = [phase for phase in found.phases if phase.reason and "stands still" in phase.reason]
    assert {phase.foot for phase in told} == {"left"}


@pytest.mark.parametrize("sensor", ["wrench.left.", "imu.chest."])
def test_a_frozen_sensor_is_left_out(robot: RobotModel, log: MotionLog, sensor: str) -> None:
    def frozen(name: str) -> np.ndarray:
        values = log.column(name).copy()
        values[1500:2300] = values[1500]
        return values

    names = [name for name in log.columns if name.startswith(sensor)]
    found = identify_feet(robot, [log.with_columns({name: frozen(name) for name in names})], settings=LINEAR)
    assert_truth(found, 0.01)
    (said,) = [note for note in found.notes if note.code == "stuck_channel"]
    assert f"columns '{sensor}*', t = 15 to 22.99 s" in said.text
    assert "left out" in said.text
