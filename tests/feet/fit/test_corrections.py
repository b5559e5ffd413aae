"""A cube about a wrong zero of the deflection: the attitude's bias is another in each recording."""

from __future__ import annotations

from dataclasses import replace

import pytest
from scipy.spatial.transform import Rotation

from biped import TRUTH, record, sway
from biped_robot import FEET
from feet_trials import AXES, PUNCTUAL, noisy
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

HARDENING = 30000.0  # N·m/rad³


def leaning(log: MotionLog, angle: float) -> MotionLog:
    """The log of an IMU that believes itself pitched by `angle` [rad], and rolled by a part of it."""
    orientation = log.orientation("chest")
    assert orientation is not None
    believed = Rotation.from_rotvec([0.4 * angle, angle, 0]) * Rotation.from_quat(
        orientation, scalar_first=True
    )
    quaternions = believed.as_quat(scalar_first=True)
    return log.with_columns(
        {f"imu.chest.orientation.{axis}": quaternions[:, place] for place, axis in enumerate("wxyz")}
    )


def test_a_cube_is_found_about_its_own_zero(robot: RobotModel) -> None:
    """Taken about the recorded zero, it would come out half as large in pitch."""
    truth = {key: replace(law, hardening=HARDENING) for key, law in TRUTH.items()}
    motions = [sway(f"sway_{seed}", seed, duration=40.0, truth=truth) for seed in (3, 4)]
    logs = [
        leaning(noisy(record(motion), 1), bias) for motion, bias in zip(motions, (0.01, -0.006), strict=True)
    ]
    found = identify_feet(robot, logs, settings=replace(PUNCTUAL, model="hardening_elastoplastic"))
    for foot in FEET:
        for axis in AXES:
            assert found.parameter(foot, axis, "hardening").value == pytest.approx(HARDENING, rel=0.1)
            stiffness = found.parameter(foot, axis, "stiffness").value
            assert stiffness == pytest.approx(TRUTH[foot, axis].stiffness, rel=0.02)
