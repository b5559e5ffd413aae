"""Charts, lines and means of days beside numbers worked out by hand or by a library's formula."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from plantar.conventions import Array
from plantar.fleet.statistics import changes
from plantar.fleet.statistics.changes import Change, _step, history_of
from plantar.fleet.statistics.control_chart import Limits, limits_of, watch
from plantar.fleet.statistics.random_effects import mean_of, nested_means, pooled
from plantar.fleet.statistics.trend import trend_of

MONTH = 365.25 / 12
CALM = np.tile([1.0, -1.0], 20)  # levels of the same mean and scatter


def normal(values: Array, day: int) -> float:
    """A day beside those before it, as a standard normal number of the same probability (Hawkins)."""
    before = values[:day]
    t = (values[day] - before.mean()) / (before.std(ddof=1) * np.sqrt(1 + 1 / day))
    return float(np.sign(t) * -stats.norm.ppf(stats.t.sf(abs(t), day - 1)))


def test_limits_are_those_of_a_normal_number_and_of_siegmund() -> None:
    found = limits_of(0.01, 0.002)
    assert found.outlier == pytest.approx(stats.norm.isf(0.005))
    reach = found.step + 1.166
    assert 2 * (np.exp(reach) - reach - 1) == pytest.approx(2 / 0.002)


@pytest.mark.parametrize(("day", "size"), [(4, 9.0), (10, 4.0), (30, -3.5)])
def test_a_day_is_an_outlier_by_students_number(day: int, size: float) -> None:
    values = CALM.copy()
    values[day] = size
    limit = abs(normal(values, day))
    assert watch(values, np.ones(40), Limits(0.99 * limit, 1e9)).outliers[:1] == (day,)
    assert day not in watch(values, np.ones(40), Limits(1.01 * limit, 1e9)).outliers


def test_the_first_four_days_are_compared_with_none() -> None:
    values = CALM.copy()
    values[3] = 50.0
    assert watch(values, np.ones(40), Limits(1e-6, 1e9)).outliers[0] == 4


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_step_is_a_sum_of_numbers_less_half_a_deviation_each_three_at_most(sign: float) -> None:
    values = sign * np.concatenate([CALM[:20], 5 + 0.1 * CALM[:3]])
    numbers = [normal(sign * values, day) for day in range(4, 23)]
    assert numbers[16] > 3 > numbers[17] > 0.5
    total, sums = 0.0, []
    for number in numbers:
        total = max(0.0, total + min(max(number, -3.0), 3.0) - 0.5)
        sums.append(total)
    assert watch(values, np.ones(23), Limits(1e9, sums[17] * 0.999)).steps == ((20, 21),)
    assert watch(values, np.ones(23), Limits(1e9, sums[17] * 1.001)).steps == ((20, 22),)
    assert watch(values, np.ones(23), Limits(1e9, max(sums) * 1.001)).steps == ()


def test_a_line_is_that_of_scipy_a_month() -> None:
    time = np.array([0.0, 3.0, 10.0, 40.0, 61.0, 90.0])
    values = 5 - 0.02 * time + np.array([0.1, -0.2, 0.0, 0.15, -0.1, 0.05])
    line, found = stats.linregress(time, values), trend_of(time, values, np.ones(6))
    assert found is not None
    wide = stats.t.ppf(0.975, 4) * line.stderr * MONTH
    assert (found.slope, found.low, found.high) == pytest.approx(
        (line.slope * MONTH, line.slope * MONTH - wide, line.slope * MONTH + wide)
    )
    assert (found.probability, found.days) == (pytest.approx(line.pvalue), 6)
    up = trend_of(time, -values, np.ones(6))
    assert up is not None
    assert up.probability == pytest.approx(line.pvalue), "of either sign"
    assert trend_of(time[:3], values[:3], np.ones(3)) is None
    assert trend_of(np.zeros(5), values[:5], np.ones(5)) is None
    for slope, probability in ((0.5, 0.0), (-0.5, 0.0), (0.0, 1.0)):
        exact = trend_of(time, 5 + slope * time, np.ones(6))
        assert exact is not None
        assert (exact.probability, exact.low, exact.high) == (probability, exact.slope, exact.slope)


def test_a_mean_has_hartung_and_knapps_interval() -> None:
    values, variances, between = np.array([1.0, 2.0, 4.0]), np.array([0.1, 0.2, 0.3]), 0.5
    weights = 1 / (variances + between)
    mean = np.average(values, weights=weights)
    std = np.sqrt(np.average((values - mean) ** 2, weights=weights) / 2)
    found = mean_of(values, variances, between)
    assert (found.value, found.std, found.freedom, found.members) == (
        pytest.approx(mean),
        pytest.approx(std),
        2,
        3,
    )
    assert (found.high - found.low) / 2 == pytest.approx(stats.t.ppf(0.975, 2) * std)
    alone = mean_of(np.array([3.0]), np.array([0.04]), 0.0)
    assert (alone.std, alone.freedom) == (pytest.approx(0.2), np.inf)
    assert alone.low == pytest.approx(3 - 1.959964 * 0.2, rel=1e-6)
    sums, rest = pooled(values, variances, between, np.array([0, 1, 0]))
    assert sums == pytest.approx([np.average(values[[0, 2]], weights=weights[[0, 2]]), 2.0])
    assert rest == pytest.approx([1 / weights[[0, 2]].sum(), 1 / weights[1]])


def test_levels_of_scatter_by_hand() -> None:
    """Of equal exact values a level's variance is its scatter; robots are one level above the days."""
    values = np.array([0.0, 2.0, 10.0, 12.0, 100.0, 102.0, 110.0, 112.0])
    found = nested_means(values, np.full(8, 1e-9), [0, 0, 1, 1, 0, 0, 1, 1], [*"aaaabbbb"])
    # Of a day's two recordings 2; of a unit's days 10² / 2, less the half of 2; of units 100² / 2, less half of 50.
    assert found.recordings_std == pytest.approx(np.sqrt(2))
    assert found.days_std == pytest.approx(np.sqrt(50 - 1))
    assert found.units_std == pytest.approx(np.sqrt(5000 - 25))
    assert found.fleet.value == pytest.approx(56)
    assert (found.units["b"].value, found.units["b"].members) == (pytest.approx(106), 2)
    alike = nested_means(np.array([1.0, 1.1]), np.ones(2), [0, 0], [0, 0])
    assert (alike.recordings_std, alike.days_std, alike.units_std) == (0.0, None, None)


@pytest.mark.parametrize(("days", "told"), [(35, True), (24, False)])
def test_a_trend_takes_a_month_of_days(days: int, told: bool) -> None:
    time = np.arange(float(days))
    values = 0.02 * time + 0.01 * np.random.default_rng(0).normal(size=days)
    changes = history_of(time, values, np.ones(days), 0.1).changes
    assert ("trend" in [change.kind for change in changes]) == told


@pytest.mark.parametrize(("days", "told"), [(5, True), (4, False)])
def test_a_trend_takes_five_days(days: int, told: bool) -> None:
    time = np.linspace(0.0, 60.0, days)
    values = 0.02 * time + 1e-4 * np.array([1.0, -1.0, 1.0, -1.0, 1.0])[:days]
    found = changes._trends(time, values, np.ones(days), (), (), 0.5)
    assert [change.kind for change in found] == ["trend"] * told
    assert [(change.first, change.seen) for change in found] == [(0, days - 1)] * told


def test_a_step_is_measured_from_two_months_beside_it() -> None:
    """Farther away the level is another, by too little to be a step."""
    time = np.arange(0.0, 300.0, 2.0)
    values = 0.1 * np.tile([1.0, -1.0], 75) + np.where(time >= 200, 5.0, 0.0)
    far = (time < 136) | (time > 264)
    (step,) = [
        one for one in history_of(time, values + 0.02 * far, np.ones(150), 0.1).changes if one.kind == "step"
    ]
    assert step.first == 100
    before, behind = values[(time > 140) & (time < 200)], values[(time >= 200) & (time < 260)]
    assert step.size == pytest.approx(behind.mean() - before.mean())
    pooled_std = np.sqrt((before.var() * 29 + behind.var() * 30) / 57 * (1 / 29 + 1 / 30))
    assert (step.high - step.low) / 2 == pytest.approx(stats.t.ppf(0.975, 57) * pooled_std)


def test_an_outlier_is_beside_the_median_of_the_others() -> None:
    values = 7 + 0.1 * np.tile([1.0, -1.0], 30)
    values[45] = 9.0
    found = history_of(np.arange(60.0), values, np.ones(60), 0.1)
    (change,) = found.changes
    others = np.delete(values, 45)
    scatter = 1.96 * np.std(others)
    assert (change.kind, change.first, change.seen) == ("outlier", 45, 45)
    size = 9 - np.median(others)
    assert (change.size, change.low, change.high) == pytest.approx((size, size - scatter, size + scatter))
    assert found.trend is not None
    assert found.trend.days == 59


def test_a_step_has_students_interval_of_the_days_within_two_months_of_it() -> None:
    random = np.random.default_rng(4)
    values = np.concatenate([random.normal(0, 1, 50), random.normal(3, 1, 50)])
    time = 2.0 * np.arange(100)  # days: thirty of them within sixty on each side
    step = _step((50, 55), [0, 50], time, values, np.ones(100))
    before, behind = values[21:50], values[50:80]
    wanted = stats.ttest_ind(behind, before).confidence_interval(0.95)
    assert (step.low, step.high) == pytest.approx((wanted.low, wanted.high))
    assert step.size == pytest.approx(behind.mean() - before.mean())
    assert (step.first, step.seen) == (50, 55)
    for starts, days in (([0, 1], 1), ([0, 99], 99)):
        lonely = _step((days, 99), starts, time, values, np.ones(100))
        assert (lonely.low, lonely.high) == (-np.inf, np.inf), "one day has no scatter"
        assert lonely.size == pytest.approx(values[99] - values[days - 1])


@pytest.mark.parametrize("slow", [slice(0, 2), slice(1, 3), slice(1, 4), slice(2, 3)])
def test_steps_of_a_slow_change_are_none_and_the_others_are(
    slow: slice, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps = [(10 * place, 10 * place + 3) for place in range(1, 5)]
    one, looked = Change("trend", steps[slow][0][0], 0, 1.0, 0.5, 1.5), []

    def told(run: list[tuple[int, int]], own: slice, *_: object) -> Change | None:
        looked.append((run, own))
        return one if run == steps[slow] else None

    monkeypatch.setattr(changes, "_slow_change", told)
    real, found = changes._told_apart(steps, np.arange(50.0), np.zeros(50), np.ones(50))
    assert real == steps[: slow.start] + steps[slow.stop :]
    assert found == [one]
    before = steps[slow.start - 1][0] if slow.start else 0
    after = steps[slow.stop][0] if slow.stop < 4 else 50
    assert (steps[slow], slice(before, after)) in looked
