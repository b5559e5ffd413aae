"""Sensors that are late by different delays: each is found beside the others, and none is invented."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot
from plantar.conventions import Array
from plantar.dynamics.inertial_motion import InertialSignals
from plantar.estimation.delays.delay import Pair
from plantar.estimation.delays.sensor_delays import Balance, estimate_delays
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.delays import refined_delays
from plantar.sensors.delays.sensor_delay import SensorDelay, estimate_wrench_delay, in_time
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import interpolate

PERIOD, SAMPLES = 0.005, 8000
INNER = slice(100, -100)


def late(values: Array, delay: float | Array) -> Array:
    """Values (n, 6) as a sensor reports them that is late by `delay` [s], of each sample if it is (n,)."""
    time: Array = PERIOD * np.arange(len(values), dtype=np.float64)
    return np.nan_to_num(
        np.column_stack([interpolate(time - delay, time, column, 1.0) for column in values.T])
    )


def residual(delays: Sequence[float | Array], seed: int) -> NewtonEulerResidual:
    """Two feet that also push against each other, below 1.5 Hz; half of the motion shows in the encoders alone."""
    *each, encoders = delays
    random = np.random.default_rng(seed)
    trunk, arms, share, between = (
        300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5) for _ in range(4)
    )
    feet = [(trunk + arms) / 2 + share + between, (trunk + arms) / 2 - share - between]
    readings = [
        low_pass(late(foot, delay) + random.standard_normal(foot.shape), PERIOD, 8.0)
        for foot, delay in zip(feet, each, strict=True)
    ]

    def predicted(shift: float) -> Array:
        return low_pass(trunk + late(arms, encoders + shift), PERIOD, 8.0)

    by_encoders = (predicted(-PERIOD) - predicted(PERIOD)) / (2 * PERIOD)
    rates = [differentiate(reading, PERIOD) for reading in readings]
    measured, rates = np.array(readings)[:, INNER], np.array(rates)[:, INNER]
    pair = Pair("sweep", measured.sum(axis=0), rates.sum(axis=0), predicted(0.0)[INNER], PERIOD)
    signals, none = InertialSignals(*np.zeros((3, 0, 3)), PERIOD), np.zeros(0)
    each = np.hstack([*measured])
    return NewtonEulerResidual(
        pair, measured, rates, by_encoders[INNER], each, signals, slice(0), none, 0 * each, True
    )


@pytest.mark.parametrize(
    "delays", [(0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.004, 0.004, -0.006), (0.008, -0.004, 0.005)]
)
def test_each_delay_is_found_beside_the_others(delays: tuple[float, float, float]) -> None:
    for seed in range(4):
        found = estimate_delays([residual(delays, seed).balance])
        assert found is not None
        assert np.abs(found.values - delays).max() < 7e-4
        assert np.sqrt(np.diag(found.covariance)).max() < 5e-4


def test_bands_that_hold_fewer_values_than_delays_tell_none() -> None:
    """Of a few seconds ends take half: gains and delays would explain all of the slow bands, whatever they are."""

    def part(seconds: float) -> Balance:
        whole, rows = residual((0.0, 0.0, 0.0), 1).balance, slice(round(seconds / PERIOD))
        measured, by_delay = whole.measured[:, rows], whole.by_delay[:, rows]
        return Balance(whole.predicted[rows], measured, by_delay, PERIOD)

    assert estimate_delays([part(2.5)]) is None
    assert estimate_delays([part(30.0)]) is not None


def at_times(seed: int) -> Array:
    """1 half of the time, for some seconds, else 0, (n,)."""
    random = np.random.default_rng(seed + 50)
    return np.asarray(low_pass(random.standard_normal(SAMPLES), PERIOD, 0.3) > 0, dtype=np.float64)


@pytest.mark.parametrize(("amount", "least", "most"), [(0.008, 6e-4, 2e-3), (0.0, 0.0, 1e-4)])
def test_a_delay_that_comes_and_goes_is_as_unsure_as_its_mean(
    amount: float, least: float, most: float
) -> None:
    """It moves all axes and bands together, which do not disagree then: only how it changes in time tells."""
    off, wide = list[float](), list[float]()
    for seed in range(6):
        busy = at_times(seed)
        balance = residual([amount * busy, 0.002, 0.0], seed).balance
        found = estimate_delays([balance], np.eye(3)[2:])
        assert found is not None
        off.append(found.values[0] - amount * busy[INNER].mean())
        wide.append(np.sqrt(found.through_time([balance])[0, 0]))
    assert least <= np.sqrt(np.mean(np.square(wide))) <= most
    assert np.sqrt(np.mean(np.square(off))) < max(1.5 * np.sqrt(np.mean(np.square(wide))), 5e-4)


def test_what_is_held_is_not_estimated() -> None:
    found = estimate_delays(
        [residual((0.006, 0.006, 0.0), 1).balance], np.array([[1.0, -1.0, 0.0], [0.0, 0.0, 1.0]])
    )
    assert found is not None
    assert found.values[0] == pytest.approx(found.values[1], abs=1e-12)
    assert found.values[2] == pytest.approx(0.0, abs=1e-12)
    assert found.values[0] == pytest.approx(0.006, abs=5e-4)


def sensor_delay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *delays: float | Array) -> SensorDelay:
    """Of two recordings whose residuals are those of `residual`, less what has been corrected when they are asked."""
    robot, time = make_robot(tmp_path), PERIOD * np.arange(SAMPLES)
    ramps = dict.fromkeys(
        ("wrench.left.force.x", "wrench.right.force.x", "joint.left_hip_roll.position"), time
    )
    logs = [MotionLog(str(seed), time, dict(ramps)) for seed in (1, 2)]

    def left(_: RobotModel, log: MotionLog) -> list[NewtonEulerResidual]:
        corrected = [log.column(name)[SAMPLES // 2] - time[SAMPLES // 2] for name in ramps]
        return [residual([late - done for late, done in zip(delays, corrected, strict=True)], int(log.name))]

    monkeypatch.setattr(refined_delays, "newton_euler_residuals", left)
    return estimate_wrench_delay(robot, logs)


def test_one_delay_is_kept_where_sensors_do_not_differ(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = sensor_delay(tmp_path, monkeypatch, 0.005, 0.005, 0.0)
    assert found.note.code == "delay"
    assert found.feet == pytest.approx({"left": 0.005, "right": 0.005}, abs=5e-4)
    assert found.encoders == pytest.approx(0.0, abs=5e-4)
    assert found.delay == pytest.approx(0.005, abs=5e-4)


def test_encoders_that_are_apart_by_little_leave_the_feet_where_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half of the motion shows in the encoders alone: late by 1.4 ms and left so, they move the feet by half of it."""
    found = sensor_delay(tmp_path, monkeypatch, 0.005, 0.005, 0.0014)
    assert found.note.code == "delay"
    assert found.encoders == pytest.approx(0.0014 / (1 + 0.3**2), abs=2e-4)
    assert found.delay == pytest.approx(0.005, abs=3e-4)
    assert found.std < 0.0005
    assert found.follows == pytest.approx(0.5, abs=0.1), "wherever fits then find the encoders"


def test_feet_that_differ_and_encoders_that_lag_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = sensor_delay(tmp_path, monkeypatch, 0.012, 0.002, 0.0)
    assert found.note.code == "delays_apart"
    assert found.feet == pytest.approx({"left": 0.012, "right": 0.002}, abs=7e-4)
    assert found.encoders == pytest.approx(0.0, abs=5e-4)
    assert found.std > refined_delays.LEAST_STD, "no robot's model shows a delay better"
    lagging = sensor_delay(tmp_path, monkeypatch, 0.0, 0.0, 0.006)
    assert list(lagging.feet.values()) == pytest.approx([0.0, 0.0], abs=5e-4)
    assert lagging.encoders == pytest.approx(0.006, abs=7e-4)
    assert lagging.follows == pytest.approx(0.5, abs=0.1)
    assert "encoders +6" in lagging.note.text or "encoders +5.9" in lagging.note.text


def test_a_foot_that_is_late_at_times_is_told_with_how_unsure_its_delay_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    steady, at_random = (
        sensor_delay(tmp_path, monkeypatch, 0.012 + amount * (at_times(3) - 0.5), 0.0, 0.0)
        for amount in (0.0, 0.012)
    )
    assert steady.note.code == at_random.note.code == "delays_apart"
    assert 2 * steady.std < at_random.std


def test_a_log_is_put_in_time(tmp_path: Path) -> None:
    robot, log = make_robot(tmp_path), record(sway())
    note = Note("delays_apart", "warning", "")
    found = SensorDelay(0.015, 0.0, np.inf, True, note, {"left": 0.02, "right": 0.01}, -0.01)
    moved = in_time(robot, log, found)
    steps = {"wrench.left.force.z": 2, "wrench.right.torque.y": 1, "joint.left_ankle_pitch.position": -1}
    for name, step in steps.items():
        expected = log.columns[name][10 + step : 100 + step]
        np.testing.assert_allclose(moved.columns[name][10:100], expected, atol=1e-9)
    np.testing.assert_array_equal(
        moved.columns["imu.chest.orientation.w"], log.columns["imu.chest.orientation.w"]
    )
