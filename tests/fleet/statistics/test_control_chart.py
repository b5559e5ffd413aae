"""The chart's false alarms are those asked for, whatever the baseline; one bad day is no step."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.fleet.statistics.control_chart import limits_of, watch

YEAR = 365


@pytest.mark.parametrize("share", [1 / 4380, 1 / 1000])
def test_false_alarms_are_as_asked(share: float) -> None:
    random, limits = np.random.default_rng(2), limits_of(share, share)
    years = round(80 / share / YEAR)
    outliers = steps = 0
    for _ in range(years):
        found = watch(random.normal(7.0, 0.03, YEAR), np.ones(YEAR), limits)
        outliers += len(found.outliers)
        steps += len(found.steps)
    asked = share * years * YEAR
    assert 0.7 < outliers / asked < 1.3
    assert 0.7 < steps / asked < 1.3


def test_days_with_more_recordings_raise_no_more_alarms() -> None:
    random, share = np.random.default_rng(4), 1 / 500
    limits, alarms = limits_of(share, share), 0
    for _ in range(100):
        weights = random.choice([1.0, 4.0], YEAR)
        found = watch(random.normal(0, 1, YEAR) / np.sqrt(weights), weights, limits)
        alarms += len(found.outliers) + len(found.steps)
    assert 0.7 < alarms / (2 * share * 100 * YEAR) < 1.3


def test_a_step_is_seen_within_days_and_where_it_is() -> None:
    random, limits = np.random.default_rng(6), limits_of(1 / 4380, 1 / 4380)
    for _ in range(50):
        values = random.normal(0, 1, 60) + 5.0 * (np.arange(60) >= 40)
        ((first, seen),) = watch(values, np.ones(60), limits).steps
        assert 39 <= first <= 41
        assert seen <= 44


def test_one_bad_day_is_an_outlier_and_no_step() -> None:
    values = np.random.default_rng(8).normal(0, 1, 60)
    values[30] = 40.0
    found = watch(values, np.ones(60), limits_of(1 / 4380, 1 / 4380))
    assert found.outliers == (30,)
    assert found.steps == ()


def test_units_of_the_values_do_not_matter() -> None:
    values = np.random.default_rng(9).normal(0, 1, 100) + 4.0 * (np.arange(100) >= 70)
    limits = limits_of(1 / 100, 1 / 100)
    assert watch(values, np.ones(100), limits) == watch(3e4 - 1e3 * values, np.full(100, 5.0), limits)


def test_limits_grow_with_the_time_between_false_alarms() -> None:
    few, many = limits_of(1e-4, 1e-4), limits_of(1e-2, 1e-2)
    assert few.outlier == pytest.approx(3.89, abs=0.01)
    assert few.outlier > many.outlier
    assert few.step > many.step


def test_one_bad_day_does_not_hide_a_step_behind_it() -> None:
    values = np.random.default_rng(10).normal(0, 1, 60) + 5.0 * (np.arange(60) >= 45)
    values[30] = 40.0
    ((first, seen),) = watch(values, np.ones(60), limits_of(1 / 4380, 1 / 4380)).steps
    assert abs(first - 45) <= 1
    assert seen < 50


def test_the_days_of_a_step_are_the_next_baseline() -> None:
    """A step of day 40 is seen on day 41 or 42; with the days from 40 on, day 44 is compared with four others."""
    values = np.random.default_rng(12).normal(0, 1, 60) + 12.0 * (np.arange(60) >= 40)
    values[44] += 60.0
    found = watch(values, np.ones(60), limits_of(1e-3, 1e-3))
    assert found.outliers == (44,)
    assert [first for first, _ in found.steps] == [40]
