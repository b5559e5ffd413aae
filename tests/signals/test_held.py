"""Held samples: stretches at one value, and a full scale, of channels that change nearly always."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.logs.motion_log import MotionLog
from plantar.signals.held import (
    held_in,
    held_samples,
    without_held,
)
from plantar.signals.segments import runs

SHORTEST = 0.2

PERIOD = 0.01
TIME = np.arange(0.0, 20.0, PERIOD)
WAVE = 30 * np.sin(1.3 * TIME) + np.random.default_rng(0).normal(0, 0.1, TIME.size)


def test_a_channel_that_changes_is_not_held() -> None:
    assert not held_samples(WAVE, PERIOD).any()
    assert not held_samples(np.full_like(WAVE, 3.0), PERIOD).any()  # that is a dead channel


@pytest.mark.parametrize(("start", "stop"), [(0, 40), (700, 900), (1500, 2000)])
def test_a_stretch_at_one_value_is_held(start: int, stop: int) -> None:
    values = WAVE.copy()
    values[start:stop] = values[start]
    np.testing.assert_array_equal(np.flatnonzero(held_samples(values, PERIOD)), np.arange(start, stop))


@pytest.mark.parametrize("share", [0.6, 0.8])
def test_every_sample_at_the_full_scale_is_held_however_short_the_stretch(share: float) -> None:
    beat = WAVE * (1 + 0.3 * np.sin(0.17 * TIME)) + 3 * np.sin(25 * TIME)
    limit = share * beat.max()
    over = beat >= limit
    alone = over & ~np.roll(over, 1) & ~np.roll(over, -1)
    clipped = np.minimum(beat, limit)
    np.testing.assert_array_equal(held_samples(clipped, PERIOD), over & ~alone)
    short = [run for run in runs(over & ~alone) if (run.stop - run.start) * PERIOD < SHORTEST]
    assert short
    without_scale = held_samples(clipped, PERIOD, full_scale=False)
    assert not any(without_scale[run].any() for run in short)


def test_a_foot_in_the_air_a_coarse_and_a_slow_channel_are_not_held() -> None:
    air = np.where(np.sin(0.5 * TIME) > 0, WAVE, 0.0)
    coarse = np.round(WAVE / 5) * 5
    slow = np.repeat(WAVE[::4], 4)
    for values in (air, coarse, slow):
        assert not held_samples(values, PERIOD).any()


@pytest.mark.parametrize(("steps", "held"), [(1, False), (4, True)])
def test_a_channel_that_stands_within_a_step_of_its_scale_is_not_held(steps: int, held: bool) -> None:
    """It stands for a second and then flickers, by a step of its scale or by several."""
    random, number = np.random.default_rng(1), np.arange(TIME.size)
    flickers = 1.0 + np.where(number % 2, 1 + random.integers(0, steps, TIME.size), 0)
    assert held_samples(np.where(number % 120 < 100, 1.0, flickers), PERIOD).any() == held


def test_a_log_loses_held_samples_of_sensors_but_none_of_joints() -> None:
    values = WAVE.copy()
    values[700:900] = values[700]
    names = ("wrench.left.torque.y", "imu.chest.angular_velocity.x", "joint.knee.position")
    log = without_held(MotionLog("held", TIME, dict.fromkeys(names, values)))
    for name in names:
        assert np.isnan(log.column(name)).sum() == (0 if name.startswith("joint.") else 200)
    whole = MotionLog("whole", TIME, dict.fromkeys(names, WAVE))
    assert without_held(whole) is whole


def test_a_level_quaternions_first_number_is_not_held() -> None:
    """Rounded to single precision it is 1 for seconds."""
    tilt = np.where(TIME < 5, 1e-4, 0.1) * np.sin(TIME)
    level = np.cos(tilt / 2).astype(np.float32).astype(float)
    assert (level[:400] == 1).all()
    log = MotionLog("level", TIME, {"imu.chest.orientation.w": level})
    assert without_held(log) is log


@pytest.mark.parametrize("mount", [(0.0, 0.0, 0.0), (np.pi, 0.0, 0.3)])
def test_an_orientation_is_held_as_a_whole(mount: tuple[float, float, float]) -> None:
    """In whatever way the IMU is mounted: small leans leave the numbers that are large where they are."""
    lean = np.where(TIME < 3, 2e-4, 0.1) * np.sin(3 * TIME)
    leans = Rotation.from_euler("zy", np.column_stack([np.full_like(lean, 0.4), lean]))
    names = [f"imu.chest.orientation.{axis}" for axis in "xyzw"]
    numbers = (leans * Rotation.from_euler("xyz", mount)).as_quat().round(7)
    log = MotionLog("leans", TIME, dict(zip(names, numbers.T, strict=True)))
    assert any(held_samples(part, PERIOD, full_scale=False).any() for part in numbers.T)
    assert without_held(log) is log
    still = (TIME > 5) & (TIME < 6)
    numbers[still] = numbers[still][0]
    emptied = without_held(MotionLog("frozen", TIME, dict(zip(names, numbers.T, strict=True))))
    assert np.isnan(emptied.stack(names)).any(axis=1)[still].all()


@pytest.mark.parametrize(("share", "held"), [(0.95, True), (0.85, False)])
def test_a_channel_that_often_repeats_itself_says_nothing(share: float, held: bool) -> None:
    """Nine of ten other steps must change the value."""
    values = WAVE.copy()
    for place in np.flatnonzero(np.arange(TIME.size) % 20 < round(20 * (1 - share))):
        values[place] = values[place - 1]
    values[700:900] = values[700]
    assert held_samples(values, PERIOD, full_scale=False).any() == held


@pytest.mark.parametrize("start", [0.0, 6.0])
def test_a_sensor_without_noise_whose_robot_rests_is_not_held(start: float) -> None:
    """With seven digits, as logs are written; one that freezes and goes on is, and so is one that freezes for good."""
    moved = 9.80665 + 0.3 * (1 - np.cos(1.3 * np.maximum(TIME - start - 1.5, 0.0)))
    moved += 0.3 * (1 - np.cos(1.3 * np.minimum(TIME - start, 0.0)))
    resting = np.array([float(f"{value:.7g}") for value in moved])
    still = runs(np.diff(resting) == 0)
    assert max(run.stop - run.start for run in still) > 100
    assert not held_samples(resting, PERIOD).any()
    for frozen in (slice(900, 950), slice(1800, 2000)):
        stuck = resting.copy()
        stuck[frozen] = stuck[frozen.start]
        np.testing.assert_array_equal(np.flatnonzero(held_samples(stuck, PERIOD)), np.arange(2000)[frozen])


def test_a_foot_in_the_air_comes_back_to_its_zeros() -> None:
    """A twin's sensor reads the same values in each swing; one that freezes reads them once."""
    swings = (np.mod(TIME, 4.0) > 3.0) & (TIME < 15.0)
    names = [f"wrench.left.{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"]
    random = np.random.default_rng(2)
    columns = {name: WAVE + random.normal(0, 1.0, TIME.size) for name in names}
    for place, name in enumerate(names):
        columns[name][swings] = 0.7 - place
    log = MotionLog("swings", TIME, columns)
    assert without_held(log) is log
    stuck = (TIME > 17.0) & (TIME < 18.0)
    for name in names:
        columns[name][stuck] = columns[name][stuck][0]
    emptied = without_held(MotionLog("stuck", TIME, columns))
    for name in names:
        np.testing.assert_array_equal(np.isnan(emptied.column(name)), stuck)


def test_one_number_of_an_orientation_that_stops_spoils_its_length() -> None:
    leans = 0.3 * np.sin(np.outer(TIME, [1.0, 1.4, 0.7]) + [0.0, 1.0, 2.0])
    numbers = Rotation.from_euler("xyz", leans).as_quat()
    names = [f"imu.chest.orientation.{axis}" for axis in "xyzw"]
    still = (TIME > 5) & (TIME < 7)
    numbers[still, 1] = numbers[still, 1][0]
    emptied = without_held(MotionLog("one", TIME, dict(zip(names, numbers.T, strict=True))))
    np.testing.assert_array_equal(np.isnan(emptied.column(names[1])), still)
    assert not np.isnan(emptied.stack([names[0], names[2], names[3]])).any()


def test_sensors_of_forces_have_a_full_scale_and_orientations_none() -> None:
    """A torque is clipped for moments; a number of a quaternion may well be largest for as long."""
    beat = WAVE * (1 + 0.3 * np.sin(0.17 * TIME)) + 3 * np.sin(25 * TIME)
    clipped = np.minimum(beat, 0.6 * beat.max())
    torque, number = "wrench.left.torque.x", "imu.chest.orientation.x"
    log = MotionLog("clipped", TIME, {torque: clipped, "wrench.left.force.z": 300 + WAVE, number: clipped} | {
        f"imu.chest.orientation.{axis}": WAVE for axis in "wyz"})  # fmt: skip
    with_scale, without_scale = (held_samples(clipped, PERIOD, full_scale=scale) for scale in (True, False))
    assert with_scale.sum() > without_scale.sum()
    np.testing.assert_array_equal(held_in(log, torque), with_scale)
    assert held_in(log, number).sum() <= without_scale.sum()
