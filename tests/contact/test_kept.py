"""What standing feet tell of a robot's balance and of its IMU, as it is kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from biped import record, sway
from biped_robot import Frame, Mounting, make_robot
from feet_trials import noisy, stepping
from kept_texts import assert_as_kept, described
from plantar.contact.balance import flat_soles, measured_balance
from plantar.contact.standing_imu import StandingImu

KEPT = Path(__file__).parent / "kept"
MOUNTING = Mounting(imu=Frame((0.05, 0.02, 0.3), (0.1, -0.2, 0.4)))


@pytest.mark.parametrize("steps", [False, True])
def test_a_standing_robot_is_as_it_is_kept(steps: bool, tmp_path: Path) -> None:
    robot = make_robot(tmp_path, MOUNTING)
    log = noisy(record(sway("sway", 6, 6.0), MOUNTING), 6)
    log = stepping(log) if steps else log
    measured = measured_balance(robot, log, None)
    placed = {name: pose @ pin.SE3(pin.exp3(np.array([0.0, 0.0, 0.3])), np.array([0.1, 0.2, 0.0])).homogeneous
              for name, pose in flat_soles(robot, log.positions(robot)[100]).items()}  # fmt: skip
    imu = StandingImu.of(robot, log)
    assert imu is not None
    elsewhere = measured_balance(robot, log, placed)
    told = {
        "balance": measured, "polygon": measured.polygon, "margin": measured.margin, "worst": measured.worst(),
        "elsewhere": elsewhere, "worst there": elsewhere.worst(),
        "shares": imu.shares, "proper": imu.proper(), "late": imu.proper(0.004),
        "turned": imu.proper(turn=pin.exp3(np.array([0.02, -0.01, 0.03]))),
        "along": imu.along_encoders, "by turn": imu.by_turn,
    }  # fmt: skip
    assert_as_kept(described(told), KEPT / f"standing_{steps}.txt", share=1e-5, least=1e-8)
