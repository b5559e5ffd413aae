"""Gravity's direction from gyroscope and accelerometer, against an attitude that is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sway
from biped_robot import Mounting
from plantar.signals.attitude import attitude_from_inertial

IMU = [f"imu.chest.{kind}.{axis}" for kind in ("angular_velocity", "linear_acceleration") for axis in "xyz"]


def tilt_error(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Angle between the directions of up that two attitudes give, (N,) [rad]."""
    up = [Rotation.from_quat(q, scalar_first=True).inv().apply([0.0, 0.0, 1.0]) for q in (found, truth)]
    return np.linalg.norm(np.cross(*up), axis=1)


def inertial(
    seed: int = 0, duration: float = 120.0, bias: float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Rates, proper acceleration, true orientation and period of the biped's IMU."""
    log = record(sway(seed=seed, duration=duration), Mounting())
    values = log.stack(IMU)
    orientation = log.orientation("chest")
    assert orientation is not None
    return values[:, :3] + bias, values[:, 3:], orientation, log.period


@pytest.mark.parametrize("duration", [10.0, 120.0])
def test_up_is_found(duration: float) -> None:
    rates, acceleration, truth, period = inertial(duration=duration)
    found = attitude_from_inertial(rates, acceleration, period)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)
    assert np.degrees(tilt_error(found, truth)).max() < 0.02, "at the recording's ends too"


def test_a_gyroscopes_bias_is_followed() -> None:
    rates, acceleration, truth, period = inertial(bias=np.radians(0.05))
    found = attitude_from_inertial(rates, acceleration, period)
    assert np.degrees(tilt_error(found, truth)).max() < 0.03


def test_the_attitude_does_not_lag() -> None:
    """Half a period of lag would go straight into damping."""
    rates, acceleration, truth, period = inertial(duration=60.0)
    up = [
        Rotation.from_quat(q, scalar_first=True).inv().apply([0.0, 0.0, 1.0])
        for q in (attitude_from_inertial(rates, acceleration, period), truth)
    ]
    for axis in (0, 1):
        found, expected = up[0][:, axis], up[1][:, axis]
        speed = np.gradient(expected, period)
        lag = -np.linalg.lstsq(np.column_stack([speed, np.ones_like(speed)]), found - expected, rcond=None)[
            0
        ][0]
        assert abs(lag) < 0.02 * period


def test_the_gyroscope_sees_what_is_too_fast_for_the_accelerometer() -> None:
    """With an accelerometer that says nothing of the tilt beyond its mean, the tilt is still followed."""
    rates, acceleration, truth, period = inertial(duration=20.0)
    blind = np.broadcast_to(acceleration.mean(axis=0), acceleration.shape)
    with_gyroscope = tilt_error(attitude_from_inertial(rates, blind, period), truth).std()
    without = tilt_error(attitude_from_inertial(np.zeros_like(rates), blind, period), truth).std()
    assert with_gyroscope < 0.1 * without


def test_lying_on_its_side_and_upside_down() -> None:
    for body in (Rotation.from_euler("x", 90, degrees=True), Rotation.from_euler("y", 180, degrees=True)):
        acceleration = np.tile(body.inv().apply([0.0, 0.0, 9.80665]), (500, 1))
        found = attitude_from_inertial(np.zeros((500, 3)), acceleration, 0.01)
        truth = np.tile(body.as_quat(scalar_first=True), (500, 1))
        assert tilt_error(found, truth).max() < 1e-9


def test_one_sample() -> None:
    found = attitude_from_inertial(np.zeros((1, 3)), np.array([[0.0, 0.0, 9.8]]), 0.01)
    np.testing.assert_allclose(np.abs(found), [[1, 0, 0, 0]], atol=1e-12)


def test_gyroscope_and_accelerometer_share_at_0_03_hz() -> None:
    """A body at rest whose accelerometer wanders by a degree: at 0.03 Hz half of that is believed, at 0.06 Hz none."""
    period, count = 0.1, 6_000
    time = period * np.arange(count)
    inside = slice(count // 4, 3 * count // 4)
    shares = []
    for frequency in (0.015, 0.03, 0.06):
        lean = np.radians(1.0) * np.sin(2 * np.pi * frequency * time)
        acceleration = 9.81 * np.column_stack([np.sin(lean), np.zeros(count), np.cos(lean)])
        found = attitude_from_inertial(np.zeros((count, 3)), acceleration, period)
        up = Rotation.from_quat(found, scalar_first=True).inv().apply([0.0, 0.0, 1.0])
        shares.append((up[inside, 0] @ lean[inside]) / (lean[inside] @ lean[inside]))
    assert shares == pytest.approx([1.0, 0.5, 0.0], abs=0.03)


def test_one_sample_is_what_its_accelerometer_says() -> None:
    lean = Rotation.from_euler("yx", [0.2, -0.1])
    proper = lean.inv().apply([[0.0, 0.0, 9.81]])
    found = attitude_from_inertial(np.zeros((1, 3)), proper, 0.005)
    up = Rotation.from_quat(found[0], scalar_first=True).inv().apply([0.0, 0.0, 1.0])
    np.testing.assert_allclose(up, proper[0] / 9.81, atol=1e-12)


def test_time_runs_either_way() -> None:
    """Nothing in it is told earlier from later: a log played backwards has the same tilts backwards, at both ends."""
    rates, acceleration, _, period = inertial(seed=3, duration=100.0)
    acceleration = acceleration + np.random.default_rng(0).normal(0, 0.5, acceleration.shape)
    found = attitude_from_inertial(rates, acceleration, period)
    back = attitude_from_inertial(-rates[::-1], acceleration[::-1], period)[::-1]
    assert tilt_error(found, back).max() < 1e-6
