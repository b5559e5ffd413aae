"""Steps, trends and outliers: found in time, told apart, and not seen where there are none."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from scipy import stats

from plantar.conventions import MONTH
from plantar.fleet.statistics.changes import Change, _is_outlier, _slow_change, history_of
from plantar.fleet.statistics.control_chart import Limits

DAYS = np.arange(365.0)
NOISE = 0.01  # of a day
RATE = 0.25  # false alarms a year: one a robot with four series


def lasting(changes: tuple[Change, ...], since: int) -> list[Change]:
    return [change for change in changes if change.kind != "outlier" and change.seen >= since]


@pytest.mark.parametrize("every", [1, 7])
def test_fifty_robots_give_the_alarms_asked_for(every: int) -> None:
    random, time = np.random.default_rng(1), DAYS[::every]
    counts: Counter[str] = Counter()
    for _ in range(4 * 50 * 3):
        values = random.normal(0, NOISE, len(time))
        counts.update(change.kind for change in history_of(time, values, np.ones(len(time)), RATE).changes)
    assert 0.75 < counts.total() / (50 * 3) < 1.25
    assert set(counts) == {"step", "trend", "outlier"}


@pytest.mark.parametrize("share", [0.05, -0.05])
def test_a_step_of_five_percent_is_found_within_five_logs(share: float) -> None:
    random, found, held = np.random.default_rng(2), 0, 0
    for _ in range(50):
        values = random.normal(0, NOISE, 365) + share * (DAYS >= 150)
        after = lasting(history_of(DAYS, values, np.ones(365), RATE).changes, 150)
        first = after[0]
        found += first.kind == "step" and first.seen < 155 and abs(first.first - 150) <= 1
        held += first.low < share < first.high
    assert found >= 49
    assert held >= 45


@pytest.mark.parametrize("slope", [0.01, -0.01])
def test_one_percent_a_month_is_found_within_three_months_and_called_a_trend(slope: float) -> None:
    random, in_time, named = np.random.default_rng(3), 0, 0
    for _ in range(50):
        values = random.normal(0, NOISE, 365) + slope * np.maximum(DAYS - 100, 0) / MONTH
        after = lasting(history_of(DAYS, values, np.ones(365), RATE).changes, 100)
        in_time += bool(after) and after[0].seen - 100 < 3 * MONTH
        named += {change.kind for change in after} == {"trend"}
    assert in_time >= 49
    assert named >= 45


def test_a_slow_drift_that_the_chart_calls_steps_is_one_trend_of_its_size() -> None:
    values = np.random.default_rng(4).normal(0, 0.003, 365) + 0.02 * DAYS / MONTH
    (change,) = history_of(DAYS, values, np.ones(365), RATE).changes
    assert change.kind == "trend"
    assert change.size == pytest.approx(0.02, rel=0.1)


def test_steps_of_both_directions_are_no_slow_change() -> None:
    """A line that grows by 0.01 a day from day 20 on, called levels: one trend, but not with a day far below in it."""
    days, even = np.arange(200.0), np.tile([0.05, -0.05], 100)
    grows = even + 0.01 * np.maximum(days - 20.0, 0.0)
    runs = [(80, 85), (140, 144)], [(80, 85), (81, 86), (140, 144)]
    change = _slow_change(runs[0], slice(0, 200), days, grows, np.ones(200))
    assert change is not None
    assert (change.kind, change.seen) == ("trend", 85)
    assert change.first == pytest.approx(20, abs=8)
    assert change.size == pytest.approx(0.01 * MONTH, rel=0.1)
    grows[80] -= 1.0
    assert _slow_change(runs[0], slice(0, 200), days, grows, np.ones(200)) is not None
    assert _slow_change(runs[1], slice(0, 200), days, grows, np.ones(200)) is None


def test_the_trend_is_of_the_days_behind_the_step() -> None:
    values = np.random.default_rng(5).normal(0, 0.005, 365) + 0.2 * (DAYS >= 200)
    history = history_of(DAYS, values, np.ones(365), RATE)
    assert history.start == 200
    assert history.trend is not None
    assert history.trend.low < 0 < history.trend.high


def test_one_bad_day_is_an_outlier_with_its_size() -> None:
    values = np.random.default_rng(6).normal(0, NOISE, 100)
    values[60] = 0.2
    (change,) = history_of(np.arange(100.0), values, np.ones(100), RATE).changes
    assert (change.kind, change.first) == ("outlier", 60)
    assert (change.high - change.low) / 2 == pytest.approx(1.96 * NOISE, rel=0.2), "the others' scatter, 95 %"
    assert change.size == pytest.approx(0.2, abs=0.01)


def test_the_size_of_a_step_has_students_interval_from_the_two_months_beside_it() -> None:
    """Eight days before and nine behind; what lies further off may have drifted since."""
    days = 7.0 * np.arange(40)
    values = np.random.default_rng(7).normal(0, NOISE, 40) + 0.2 * (np.arange(40) >= 20)
    (step,) = [one for one in history_of(days, values, np.ones(40), 1.0).changes if one.kind == "step"]
    assert step.first == 20
    beside = stats.ttest_ind(values[20:29], values[12:20], equal_var=True)
    interval = beside.confidence_interval(0.95)
    assert step.size == pytest.approx(values[20:29].mean() - values[12:20].mean())
    assert (step.low, step.high) == pytest.approx((interval.low, interval.high))


@pytest.mark.parametrize(("deviations", "outlier"), [(2.8, False), (3.6, True), (-2.8, False), (-3.6, True)])
def test_a_day_stands_apart_by_four_fifths_of_the_limit_from_the_line_of_the_others(
    deviations: float, outlier: bool
) -> None:
    time = np.arange(301.0)
    noise = NOISE * stats.norm.ppf((np.random.default_rng(8).permutation(301) + 0.5) / 301)
    noise[150] = deviations * NOISE
    values = noise + 0.3 * time / MONTH
    assert _is_outlier(150, [0], time, values, np.ones(301), Limits(4.0, 5.0)) == outlier


def test_few_days_say_nothing() -> None:
    assert history_of(np.arange(3.0), np.zeros(3), np.ones(3), RATE).changes == ()
    assert history_of(np.zeros(0), np.zeros(0), np.zeros(0), RATE).trend is None
    same = history_of(np.arange(30.0), np.ones(30), np.ones(30), RATE)
    assert same.changes == ()


def test_a_day_that_stands_apart_from_too_few_for_a_line_is_an_outlier() -> None:
    time, values = np.arange(3.0), np.array([0.0, 1.0, 0.0])
    assert _is_outlier(1, [0], time, values, np.ones(3), Limits(4.0, 5.0))
