"""Devices that filter and hold, and what one robot's sensors get wrong in all recordings."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.twin.robots import hrp2
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import exact_columns
from plantar.twin.sensing.logger import _device
from plantar.twin.sensing.sensor_errors import SensorSpread, with_sensor_errors
from plantar.twin.sensing.sensors import device_reading
from twin_samples import tilted

TIME = np.arange(4000) / 200.0


def read(values: np.ndarray, white: float, cutoff: float, hold: float) -> np.ndarray:
    return device_reading(values, TIME, white, cutoff, hold, np.random.default_rng(0))


def test_a_filter_makes_a_signal_late() -> None:
    """A second-order Butterworth filter delays slow signals by √2 / (2π cutoff), held values by half a hold."""
    slow = np.sin(TIME)
    for cutoff, hold, late in ((60.0, 0.0, 0.00375), (0.0, 0.003, 0.001), (60.0, 0.003, 0.00475)):
        missed = slow - read(slow, 0.0, cutoff, hold)
        assert missed @ np.cos(TIME) / (np.cos(TIME) @ np.cos(TIME)) == pytest.approx(late, rel=0.05)


def test_a_filter_leaves_less_noise_and_colours_it() -> None:
    plain, filtered = (read(np.zeros(TIME.size), 1.0, cutoff, 0.0) for cutoff in (0.0, 60.0))
    assert np.std(plain) == pytest.approx(1.0, rel=0.05)
    assert 0.25 < np.std(filtered) < 0.45  # the root of 1.11 · 60 / 500
    assert abs(np.corrcoef(plain[1:], plain[:-1])[0, 1]) < 0.05


def test_errors_of_sensors_are_the_robots_not_the_recordings() -> None:
    robot, rollout = hrp2.robot(), tilted()
    exact = exact_columns(rollout, robot, cut_feet(describe(robot), robot))
    first, drawn = with_sensor_errors(exact, rollout.time, robot, SensorSpread(), 1)
    again, _ = with_sensor_errors(exact, rollout.time, robot, SensorSpread(), 1)
    other, _ = with_sensor_errors(exact, rollout.time, robot, SensorSpread(), 2)
    force = "wrench.left_foot.force.z"
    np.testing.assert_array_equal(first[force], again[force])
    assert np.abs(first[force] - other[force]).max() > 1.0
    gain = drawn["wrench.left_foot.gains"][2][2]
    assert np.mean(first[force]) == pytest.approx(gain * np.mean(exact[force]), rel=0.002)
    joint = "RLEG_JOINT3"
    zero = np.median(first[f"joint.{joint}.position"] - exact[f"joint.{joint}.position"])
    assert zero == pytest.approx(drawn["joint.zeros"][joint], abs=2e-4)
    none, _ = with_sensor_errors(exact, rollout.time, robot, SensorSpread(*[0.0] * 7), 1)
    for name, values in none.items():
        np.testing.assert_allclose(values, exact[name], atol=1e-12)


def test_all_joints_are_sampled_together_whatever_their_names() -> None:
    columns = (
        "joint.knee.position",
        "joint.leg.knee.velocity",
        "wrench.left.foot.force.z",
        "imu.base.orientation.w",
    )
    assert [_device(column) for column in columns] == ["joint", "joint", "wrench.left.foot", "imu.base"]
