"""Fewer samples of a quick log: slow signals as they were, quick ones gone, slow logs untouched."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.logs.motion_log import MotionLog
from plantar.signals.resampling import evenly_sampled
from plantar.signals.thinning import (
    picked,
    thinned,
)

LOWEST_RATE = 200.0


def log_of(rate: float, **signals: object) -> MotionLog:
    time = np.arange(0.0, 20.0, 1 / rate)
    columns = {f"joint.{name}.position": signal(time) for name, signal in signals.items()}  # type: ignore[operator]
    return MotionLog("log", time, columns)


def tone(frequency: float):  # type: ignore[no-untyped-def]
    return lambda time: np.sin(2 * np.pi * frequency * time)


@pytest.mark.parametrize("rate", [100.0, 200.0, 250.0, 333.0, 399.0])
def test_a_log_of_less_than_twice_the_rate_is_the_same_object(rate: float) -> None:
    log = log_of(rate, knee=tone(1.0))
    assert thinned(log) is log
    assert picked(log) is log


@pytest.mark.parametrize("rate", [400.0, 500.0, 1000.0, 2000.0])
def test_slow_motions_keep_size_and_time(rate: float) -> None:
    thin = thinned(log_of(rate, knee=tone(5.0)))
    assert LOWEST_RATE <= 1 / thin.period < 2 * LOWEST_RATE
    inner = slice(50, -50)
    there = thin.column("joint.knee.position")[inner]
    np.testing.assert_allclose(there, np.sin(10 * np.pi * thin.time[inner]), atol=1e-3)
    (note,) = thin.notes
    assert note.code == "thinned"
    every = round(thin.period * rate)
    assert f"{rate:.4g} Hz; one in {every} samples" in note.text
    assert f"({rate / every:.4g} Hz)" in note.text


def test_what_is_too_quick_does_not_pass_for_slow() -> None:
    thin = thinned(log_of(1000.0, knee=tone(199.0)))  # every fifth sample alone: a tone of 1 Hz
    assert np.abs(thin.column("joint.knee.position")[50:-50]).max() < 1e-3


def test_a_quaternion_that_changes_sign_is_one_turn() -> None:
    time = np.arange(0.0, 10.0, 0.001)
    sign = np.where(np.arange(len(time)) % 2, -1.0, 1.0)
    columns = {
        f"imu.base.orientation.{axis}": sign * value
        for axis, value in zip("wxyz", (1.0, 0, 0, 0), strict=True)
    }
    thin = thinned(MotionLog("log", time, columns))
    np.testing.assert_allclose(np.abs(thin.column("imu.base.orientation.w")), 1.0, atol=1e-9)


def test_a_slower_sensor_is_read_wherever_it_stands() -> None:
    log = log_of(1000.0, knee=tone(1.0))
    sparse = np.where(np.arange(len(log)) % 10 == 3, log.column("joint.knee.position"), np.nan)
    few = picked(log.with_columns({"joint.knee.position": sparse}))
    assert np.isfinite(few.column("joint.knee.position")).sum() == np.isfinite(sparse).sum()


def test_columns_are_filtered_as_if_each_were_alone() -> None:
    holes = lambda time: np.where((time > 3) & (time < 3.5), np.nan, time)  # noqa: E731
    signals = {f"joint_{k}": tone(0.3 + k) for k in range(11)} | {"holed": holes}
    thin = thinned(log_of(1000.0, **signals))
    for name, signal in signals.items():
        alone = thinned(log_of(1000.0, **{name: signal}))
        np.testing.assert_array_equal(
            thin.column(f"joint.{name}.position"), alone.column(f"joint.{name}.position")
        )
    assert np.isnan(thin.column("joint.holed.position")).sum() == 99
    assert list(thin.columns) == [f"joint.{name}.position" for name in signals]


@pytest.mark.parametrize("start", range(10))
def test_nothing_is_filtered_across_a_long_gap(start: int) -> None:
    time = np.arange(0.0, 60.0, 0.0005)
    knee = (time > 20.0).astype(float)
    rows = (time < 10.0 + 0.0005 * start) | (time > 40.0)
    log = MotionLog("log", time[rows], {"joint.knee.position": knee[rows]})
    there = thinned(evenly_sampled(log)).column("joint.knee.position")
    assert np.isnan(there).any()
    np.testing.assert_allclose(there[np.isfinite(there)] % 1, 0.0, atol=1e-9)


def test_columns_with_the_same_holes_are_filtered_as_each_alone() -> None:
    log = log_of(1000.0, knee=tone(1.0), hip=tone(2.0), ankle=tone(3.0), waist=tone(4.0))
    columns = {name: values.copy() for name, values in log.columns.items()}
    for name, hole in zip(columns, (slice(0), slice(100, 900), slice(100, 900), slice(4, 90)), strict=True):
        columns[name][hole] = np.nan
    together = thinned(MotionLog("log", log.time, columns))
    for name, values in columns.items():
        alone = thinned(MotionLog("log", log.time, {name: values})).column(name)
        np.testing.assert_array_equal(together.column(name), alone)


def test_columns_stay_in_their_order_whatever_holes_they_have() -> None:
    log = log_of(1000.0, hip=tone(1.0), knee=tone(2.0), ankle=tone(3.0), toe=tone(4.0))
    holes = {name: log.column(f"joint.{name}.position").copy() for name in ("knee", "toe")}
    for values in holes.values():
        values[1000:3000] = np.nan
    holed = log.with_columns({f"joint.{name}.position": values for name, values in holes.items()})
    thin = thinned(holed)
    assert list(thin.columns) == list(holed.columns)
    for name in thin.columns:
        assert np.isnan(thin.column(name)).any() == any(part in name for part in holes)
