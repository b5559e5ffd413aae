"""One even time base: gaps that stay gaps, quaternions, delays undone."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from biped import record, sway, times
from plantar.logs.motion_log import MotionLog
from plantar.signals.resampling import evenly_sampled, interpolate, is_even, sampling, shifted, without_holes
from plantar.signals.segments import runs

PERIOD = 0.005

TIME = np.arange(4000) * PERIOD


def tone(hertz: float, phase: float = 0.0, time: np.ndarray = TIME) -> np.ndarray:
    return np.sin(2 * np.pi * hertz * time + phase)


def test_sampling_describes_rate_jitter_and_gaps() -> None:
    random = np.random.default_rng(1)
    time = np.arange(2000) * 0.01 + random.normal(0, 0.0005, 2000)
    time[1000:] += 2.0
    described = sampling(MotionLog("a", np.sort(time), {}))
    assert described.rate == pytest.approx(100, rel=0.01)
    assert described.jitter == pytest.approx(0.0005 * np.sqrt(2), rel=0.1)
    ((start, end),) = described.gaps
    assert start == pytest.approx(time[999])
    assert end == pytest.approx(time[1000])


def test_what_was_left_out_on_purpose_is_no_gap() -> None:
    time = np.concatenate([TIME[:100], TIME[200:300], TIME[400:]])
    log = MotionLog("a", time, {}, left_out=((TIME[99], TIME[200]),))
    assert sampling(log).gaps == ((TIME[299], TIME[400]),)


def test_an_even_log_is_left_alone() -> None:
    log = record(sway(duration=2.0))
    assert evenly_sampled(log) is log


def test_jitter_is_resampled_to_interpolation_accuracy() -> None:
    """Linear interpolation of a sine is wrong by at most (step²/8)·max|second derivative|."""
    motion = sway(duration=10.0)
    log = record(motion, at=times(motion, jitter=0.2, seed=4))
    even = evenly_sampled(log)
    assert [note.code for note in even.notes] == ["resampled"]
    assert np.ptp(np.diff(even.time)) < 1e-9
    exact = record(motion, at=even.time)
    inside = slice(2, -2)
    for name in ("joint.left_ankle_pitch.position", "imu.chest.angular_velocity.y", "wrench.left.torque.y"):
        error = np.abs(even.column(name) - exact.column(name))[inside]
        scale = np.ptp(exact.column(name))
        assert 0 < error.max() < 5e-3 * scale, name


def test_gaps_stay_gaps() -> None:
    motion = sway(duration=10.0)
    time = times(motion)
    log = record(motion, at=time[(time < 4.0) | (time > 5.0)])
    even = evenly_sampled(log)
    assert len(even) == len(time)
    hole = np.isnan(even.column("joint.left_ankle_pitch.position"))
    assert (even.time[hole].min(), even.time[hole].max()) == (
        pytest.approx(4.0, abs=0.011),
        pytest.approx(5.0, abs=0.011),
    )
    assert hole.sum() == pytest.approx(100, abs=2)


def test_a_clock_that_jumps_by_days_costs_no_memory() -> None:
    motion = sway(duration=10.0)
    log = record(motion)
    jumped = MotionLog("a", np.where(log.time < 5, log.time, log.time + 1e6), log.columns)
    even = evenly_sampled(jumped)
    assert len(even) < len(log) + 10
    known = np.isfinite(even.column("joint.left_ankle_pitch.position"))
    assert [stretch.stop - stretch.start for stretch in runs(known)] == pytest.approx([500, 501], abs=1)
    exact = record(motion, at=even.time[known] - np.where(even.time[known] > 1e5, 1e6, 0.0))
    for name in ("joint.left_ankle_pitch.position", "wrench.right.torque.x"):
        np.testing.assert_allclose(even.column(name)[known], exact.column(name), atol=1e-5)


def test_quaternions_that_change_sign_are_interpolated_the_short_way() -> None:
    angle = np.linspace(0, 8 * np.pi, 4000)
    quaternion = Rotation.from_euler("z", angle[:, None]).as_quat(scalar_first=True)
    quaternion[::3] *= -1
    names = [f"imu.a.orientation.{axis}" for axis in "wxyz"]
    time = TIME + np.random.default_rng(0).uniform(-0.0024, 0.0024, TIME.size)
    even = evenly_sampled(MotionLog("a", time, dict(zip(names, quaternion.T, strict=True))))
    norm = np.linalg.norm(even.stack(names)[2:-2], axis=1)
    np.testing.assert_allclose(norm, 1.0, atol=1e-4)


def test_interpolation_does_not_bridge_what_is_too_far_apart() -> None:
    time, values = np.array([0.0, 1.0, 5.0, 6.0]), np.array([0.0, 1.0, 5.0, np.nan])
    at = np.array([-1.0, 0.5, 1.0, 3.0, 5.0, 5.5])
    np.testing.assert_array_equal(interpolate(at, time, values, 2.0), [np.nan, 0.5, 1.0, np.nan, 5.0, np.nan])
    np.testing.assert_array_equal(interpolate(at, time, np.full(4, np.nan), 2.0), np.full(6, np.nan))


@pytest.mark.parametrize("delay", [0.0, 0.005, 0.0123, -0.004])
def test_a_delay_is_undone(delay: float) -> None:
    """A sensor late by `delay` reports at t what happened at t - delay."""
    late = np.column_stack([tone(0.8, time=TIME - delay), tone(0.3, time=TIME - delay)])
    undone = shifted(late, PERIOD, delay)
    inside = slice(5, -5)
    expected = np.column_stack([tone(0.8), tone(0.3)])
    bound = PERIOD**2 / 8 * (2 * np.pi * 0.8) ** 2
    assert np.abs(undone - expected)[inside].max() <= 1.01 * bound
    if delay > 0:
        assert np.isnan(undone[-1]).all(), "nothing is known of what was not yet reported"


def test_a_shift_keeps_nan_where_values_are_missing() -> None:
    values = tone(0.5)
    values[1000:1100] = np.nan
    moved = shifted(values, PERIOD, 0.0)
    assert moved.shape == values.shape
    np.testing.assert_array_equal(np.isnan(moved), np.isnan(values))


def test_short_holes_are_filled_and_a_tenth_of_a_second_stays_a_hole() -> None:
    """At 200 Hz: 30 ms are bridged by a line; in 100 ms a robot moves, and nobody saw it."""
    values = tone(0.5)
    values[1000:1006] = np.nan
    values[2000:2020] = np.nan
    filled = without_holes(MotionLog("a", TIME, {"joint.a.position": values}))
    column = filled.columns["joint.a.position"]
    np.testing.assert_allclose(column[1000:1006], tone(0.5)[1000:1006], atol=1e-3)
    assert np.isnan(column[2000:2020]).all()
    assert np.isnan(column).sum() == 20
    assert {note.code for note in filled.notes} == {"holes_filled"}


def test_a_hole_at_which_a_quaternion_changes_its_sign_is_filled_the_short_way() -> None:
    turns = Rotation.from_rotvec(np.outer(0.3 + 0.2 * tone(0.5), [0, 0, 1])).as_quat(scalar_first=True)
    turns[TIME[1002] < TIME] *= -1
    columns = dict(zip((f"imu.chest.orientation.{axis}" for axis in "wxyz"), turns.T.copy(), strict=True))
    for values in columns.values():
        values[1000:1006] = np.nan
    filled = without_holes(MotionLog("a", TIME, columns))
    found = np.column_stack([*filled.columns.values()])[1000:1006]
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0, atol=1e-3)


def test_samples_too_near_to_each_other_are_not_even() -> None:
    """As those that come late, and are followed by one at its time."""
    time = TIME.copy()
    time[1000] += 0.3 * PERIOD
    assert not is_even(MotionLog("late", time, {}))
    time = TIME.copy()
    time[1000:] -= 0.6 * PERIOD
    assert not is_even(MotionLog("near", time, {}))
    assert is_even(MotionLog("even", TIME, {}))
