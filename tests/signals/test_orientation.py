"""Attitude and rates of the IMU: as recorded, or each derived from what else the IMU measures."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from plantar.conventions import rotation_from_quaternion
from plantar.errors import DataError, LogError
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.signals.orientation import attitude

EDGE = 10  # samples at either end, where one-sided differences are coarser


def without(log: MotionLog, kind: str) -> MotionLog:
    columns = {name: values for name, values in log.columns.items() if f".{kind}." not in name}
    return MotionLog(log.name, log.time, columns)


def asked(robot: RobotModel, log: MotionLog) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Orientation, rates, and codes of the notes."""
    notes: list[Note] = []
    assert robot.imu is not None
    texts = {
        "gyroscope_missing": "no angular velocity; rates come from differentiated orientation, damping is less sure",
        "attitude_derived": "no IMU orientation; gravity's direction blended from gyroscope and accelerometer",
    }
    found = attitude(log, robot.imu, notes)
    assert notes == [Note(note.code, "warning", f"{log.name}: {texts[note.code]}") for note in notes]
    return *found, [note.code for note in notes]


def test_what_is_recorded_is_taken_as_it_is(robot: RobotModel) -> None:
    log = record(sway())
    orientation, rates, codes = asked(robot, log)
    assert codes == []
    np.testing.assert_array_equal(orientation, log.orientation("chest"))
    np.testing.assert_array_equal(rates, log.angular_velocity("chest"))


def test_rates_come_from_the_orientation_whichever_sign_its_quaternions_have(robot: RobotModel) -> None:
    log = record(sway())
    sign = np.where(np.random.default_rng(0).random(len(log)) < 0.5, -1.0, 1.0)
    names = [f"imu.chest.orientation.{axis}" for axis in "wxyz"]
    flipped = log.with_columns({name: 1.5 * sign * log.column(name) for name in names})
    _, rates, codes = asked(robot, without(flipped, "angular_velocity"))
    assert codes == ["gyroscope_missing"]
    missed = rates - log.angular_velocity("chest")
    assert np.abs(missed[EDGE:-EDGE]).max() < 1e-3 * np.abs(rates).max()


def test_an_orientation_is_derived_and_missing_where_the_sensors_are(robot: RobotModel) -> None:
    log = record(sway(duration=60.0))
    holes = log.column("imu.chest.linear_acceleration.x").copy()
    holes[2000:2030] = np.nan
    cut = without(log.with_columns({"imu.chest.linear_acceleration.x": holes}), "orientation")
    orientation, _, codes = asked(robot, cut)
    assert codes == ["attitude_derived"]
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(orientation).any(axis=1)), np.arange(2000, 2030))
    whole = np.isfinite(orientation).all(axis=1)
    true = log.orientation("chest")
    assert true is not None
    up, wanted = (rotation_from_quaternion(each[whole])[:, 2, :] for each in (orientation, true))
    assert np.degrees(np.arccos(np.clip(np.sum(up * wanted, axis=1), -1, 1))).max() < 0.2


def test_an_imu_without_one_whole_sample_is_refused(robot: RobotModel) -> None:
    log = record(sway())
    nothing = {"imu.chest.angular_velocity.x": np.full(len(log), np.nan)}
    with pytest.raises(DataError, match=r"^sway: imu 'chest' has no sample with all values$"):
        asked(robot, without(log.with_columns(nothing), "orientation"))


def test_an_imu_of_another_name_is_told_by_the_names_that_the_log_has(robot: RobotModel) -> None:
    log = record(sway())
    columns = {name.replace("imu.chest", "imu.my.base"): values for name, values in log.columns.items()}
    with pytest.raises(
        LogError,
        match=r"^other: columns 'imu\.chest\.\*' are missing \(valid: imu\.chest\.orientation\.w, \.x, "
        r"\.y, \.z, or angular_velocity and linear_acceleration; in the robot file imu\.name as "
        r"the log has it: my\.base\)$",
    ):
        asked(robot, MotionLog("other", log.time, columns))


def test_across_a_gap_nobody_knows_how_it_has_turned(robot: RobotModel) -> None:
    """Two minutes upright, then two minutes leaning by 0.1 rad, hours later: neither knows of the other."""
    time, lean = np.arange(0.0, 120.0, 0.02), 0.1
    imu = robot.imu
    assert imu is not None
    leaning = np.where(np.arange(2 * len(time)) < len(time), 0.0, lean)
    columns = {f"imu.{imu.name}.angular_velocity.{axis}": np.zeros(2 * len(time)) for axis in "xyz"}
    up = (np.sin(leaning), np.zeros(2 * len(time)), np.cos(leaning))
    columns |= {
        f"imu.{imu.name}.linear_acceleration.{axis}": 9.81 * one for axis, one in zip("xyz", up, strict=True)
    }
    orientation, _ = attitude(MotionLog("two", np.concatenate([time, time + 7200.0]), columns), imu, [])
    tilt = np.arccos(rotation_from_quaternion(orientation)[:, 2, 2])
    np.testing.assert_allclose(tilt, leaning, atol=1e-6)
