"""An attitude behind a slow filter is named and left out; one that follows its accelerometer is something else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter, sosfilt, sosfilt_zi

from biped import TRUTH, record, sway
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel
from plantar.sensors.attitude_lag import NO_LAG, log_attitude_lag, without_lag
from plantar.sensors.tilt_error import log_tilt_error
from plantar.twin.sensing.attitude_filter import filtered_attitude

KNOWN = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)
ORIENTATION = imu_columns("chest", "orientation")


def oriented(log: MotionLog, orientation: np.ndarray) -> MotionLog:
    unit = orientation / np.linalg.norm(orientation, axis=1, keepdims=True)
    return log.with_columns(dict(zip(ORIENTATION, unit.T, strict=True)))


def lagging(log: MotionLog, lag: float) -> MotionLog:
    """The log with its orientation behind a low-pass of first order with that time constant [s]."""
    orientation = log.orientation("chest")
    assert orientation is not None
    kept = float(np.exp(-log.period / lag))
    return oriented(log, lfilter([1 - kept], [1, -kept], orientation, axis=0, zi=kept * orientation[:1])[0])


def following(log: MotionLog, rate: float, monkeypatch: pytest.MonkeyPatch) -> MotionLog:
    """The log with its orientation filtered towards the accelerometer at that rate [1/s]."""
    monkeypatch.setattr("plantar.twin.sensing.attitude_filter.CORRECTION_RATE", rate)
    orientation = log.orientation("chest")
    assert orientation is not None
    rates, acceleration = log.angular_velocity("chest"), log.linear_acceleration("chest")
    return oriented(log, filtered_attitude(orientation[0], rates, acceleration, log.period))


@pytest.mark.parametrize("lag", [0.1, 0.2, 0.5])
def test_a_lag_is_measured_and_told_from_a_tilt(robot: RobotModel, lag: float) -> None:
    imu = robot.required_imu
    log = lagging(record(sway(duration=30.0)), lag)
    found = log_attitude_lag(log, imu)
    assert found.lag == pytest.approx(lag, rel=0.05)
    assert found.believed(log_tilt_error(log, imu))
    (read,) = without_lag([log], imu, found)
    assert [note.code for note in read.notes] == ["attitude_late"]
    assert f"{1e3 * found.lag:.0f} ms" in read.notes[0].text
    assert not log_attitude_lag(read, imu).believed(log_tilt_error(read, imu))


def test_filters_of_second_order_and_dead_time_are_lags_too(robot: RobotModel) -> None:
    """They leave two fifths of the disagreement to a lag of first order, and next to nothing of it to a tilt."""
    imu, log = robot.required_imu, record(sway(duration=30.0))
    orientation = log.orientation("chest")
    assert orientation is not None
    filtered = butter(2, np.sqrt(0.5) / np.pi / 0.8, fs=1 / log.period, output="sos")
    begun = sosfilt_zi(filtered)[:, :, None] * orientation[0]
    slow = oriented(log, sosfilt(filtered, orientation, axis=0, zi=begun)[0])
    late = oriented(log, np.stack([np.interp(log.time - 0.3, log.time, each) for each in orientation.T], 1))
    for made, delay in ((slow, 0.8), (late, 0.3)):
        found = log_attitude_lag(made, imu)
        assert found.lag == pytest.approx(delay, rel=0.5)
        assert found.explained < 0.5
        assert found.believed(log_tilt_error(made, imu))


@pytest.mark.parametrize("rate", [0.2, 1.0, 3.0])
def test_an_attitude_that_follows_its_accelerometer_does_not_lag(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch, rate: float
) -> None:
    imu, log = robot.required_imu, record(sway(duration=30.0))
    assert not log_attitude_lag(log, imu).believed(log_tilt_error(log, imu))
    made = following(log, rate, monkeypatch)
    assert not log_attitude_lag(made, imu).believed(log_tilt_error(made, imu))


def test_a_log_without_gyroscope_says_nothing_and_stays(robot: RobotModel) -> None:
    imu, log = robot.required_imu, lagging(record(sway(duration=30.0)), 0.2)
    blind = replace(log, columns={name: own for name, own in log.columns.items() if "angular" not in name})
    assert log_attitude_lag(blind, imu) == NO_LAG
    assert without_lag([blind], imu, log_attitude_lag(log, imu)) == [blind]


def test_feet_come_out_as_from_a_true_attitude(robot: RobotModel) -> None:
    logs = [record(sway(f"sway{seed}", seed, 40.0)) for seed in (1, 2)]
    late = identify_feet(robot, [lagging(log, 0.5) for log in logs], settings=KNOWN)
    assert "attitude_late" in {note.code for note in late.notes}
    for one in late.parameters:
        if one.axis != "z" and one.name == "stiffness":
            assert one.value == pytest.approx(TRUTH[one.foot, one.axis].stiffness, rel=0.01)
