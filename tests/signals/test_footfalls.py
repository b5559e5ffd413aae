"""Landings and lift-offs from a force sensor; a lone sample is none."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.logs.motion_log import MotionLog
from plantar.signals.footfalls import footfalls

COUNT = 1000
CHANGES = [299, 399, 699]  # the last sample before each


def log(**changes: np.ndarray) -> MotionLog:
    """A foot that lands, leaves and lands again, on a sensor that is mounted on its side and has a zero."""
    loaded = np.isin(np.arange(COUNT) // 100, (3, 7, 8, 9))
    force = {"x": 20.0 + 500.0 * loaded, "y": np.zeros(COUNT), "z": np.sin(np.arange(COUNT))} | changes
    columns = {f"wrench.sole.force.{axis}": values for axis, values in force.items()}
    columns |= {f"wrench.sole.torque.{axis}": np.zeros(COUNT) for axis in "xyz"}
    return MotionLog("walk", 0.01 * np.arange(COUNT), columns)


def test_landings_and_lift_offs_are_found() -> None:
    assert footfalls(log(), "sole").tolist() == CHANGES


@pytest.mark.parametrize("value", [0.0, 5000.0, np.nan])
def test_one_or_two_samples_land_no_foot(value: float) -> None:
    x = log().column("wrench.sole.force.x").copy()
    x[[120, 350, 351, 850]] = value
    assert footfalls(log(x=x), "sole").tolist() == CHANGES


def test_a_log_without_the_sensor_shows_nothing() -> None:
    assert footfalls(log(), "hand").size == 0
    assert footfalls(MotionLog("short", np.arange(3.0), {}), "sole").size == 0


def test_changes_are_those_of_the_median_of_five_samples() -> None:
    x = 10 * np.random.default_rng(0).exponential(size=COUNT) ** 3
    force = np.hypot(x, np.sin(np.arange(COUNT)))
    steady = np.median(np.lib.stride_tricks.sliding_window_view(force, 5), axis=1)
    changes = 2 + np.flatnonzero(np.diff(steady > 0.1 * steady.max()))
    assert changes.size > 20
    assert footfalls(log(x=x), "sole").tolist() == changes.tolist()
