"""Headings that are set anew: taken out where nothing turned, and nothing else is."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sines, sway
from feet_trials import codes
from plantar.conventions import Array
from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.signals.heading import with_one_heading

ORIENTATION = [f"imu.chest.orientation.{part}" for part in "wxyz"]
RATES = [f"imu.chest.angular_velocity.{axis}" for axis in "xyz"]


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(
        sway(duration=40.0, torso=(sines((0.05, 0.4, 0.0)), sines((0.06, 0.3, 2.0)), sines((0.03, 0.5, 1.0))))
    )


def turned(log: MotionLog, angles: Array, axis: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> MotionLog:
    """Seen in a world that is turned by `angles` (N,) about an axis, quaternions of any sign."""
    seen = Rotation.from_rotvec(angles[:, None] * axis) * Rotation.from_quat(
        log.stack(ORIENTATION), scalar_first=True
    )
    signs = np.where(np.arange(len(log)) % 7 < 3, -1.0, 1.0)
    quaternions = signs[:, None] * seen.as_quat(scalar_first=True)
    return log.with_columns(dict(zip(ORIENTATION, quaternions.T, strict=True)))


def jumps(log: MotionLog, *jumped: tuple[float, float]) -> Array:
    """Angles (N,) that jump by the second of each pair [rad] at the first [s]."""
    return np.asarray(sum(np.where(log.time > at, by, 0.0) for at, by in jumped))


@pytest.mark.parametrize("jumped", [((12.0, 1.5),), ((8.0, 3.0), (9.0, 2.0), (30.0, -0.1))])
def test_a_heading_is_as_if_it_had_never_been_set_anew(
    log: MotionLog, jumped: tuple[tuple[float, float], ...]
) -> None:
    found = with_one_heading(turned(log, jumps(log, *jumped)))
    alike = np.abs(np.einsum("ni,ni->n", found.stack(ORIENTATION), log.stack(ORIENTATION)))
    assert alike.min() > 1 - 1e-5  # but for what it turns within a sample
    assert [note.code for note in found.notes][len(log.notes) :] == ["heading_jumps"]
    times = [f"{at + 0.01:.4g} s" for at, _ in jumped]
    text = f"{log.name}: the heading of imu 'chest' jumps, and nothing turned, at t = {', '.join(times)}: taken out"
    assert found.notes[-1] == Note("heading_jumps", "info", text)


def test_what_is_no_jump_of_the_heading_alone_stays(log: MotionLog) -> None:
    leans = turned(log, jumps(log, (12.0, 0.1)), (1.0, 0.5, 0.0))
    quick = np.clip(log.time - 12.0, 0, 0.02) * 50.0  # 1 rad in 20 ms, and the gyroscope shows it
    rates = log.stack(RATES) + (np.gradient(quick, log.time))[:, None] * [0.0, 0.0, 1.0]
    turns = turned(log, quick).with_columns(dict(zip(RATES, rates.T, strict=True)))
    blind = turned(log, jumps(log, (12.0, 1.5))).without(RATES)
    other = log.with_columns(
        {"imu.hand.orientation.w": np.ones(len(log))}
    )  # a part of an IMU that no foot needs
    for one in (log, leans, turns, blind, other):
        assert with_one_heading(one) is one


def test_no_foot_slips_where_a_compass_sets_the_heading_anew(robot: RobotModel, log: MotionLog) -> None:
    usual, found = (
        identify_feet(robot, [one]) for one in (log, turned(log, jumps(log, (15.0, 1.5), (25.0, -0.4))))
    )
    assert codes(found) - codes(usual) == {"heading_jumps"}
    for before, after in zip(usual.parameters, found.parameters, strict=True):
        assert after.value == pytest.approx(before.value, rel=1e-3)
