"""Means over recordings, days and robots: intervals hold as often as they say, parts are told apart."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import t as student

from plantar.fleet.statistics.random_effects import mean_of, nested_means, pooled

TRUTH = 6.0


def fleet(
    random: np.random.Generator, units: int, days: int, per_day: int, parts: tuple[float, float, float]
):
    """Values, days and units of a fleet whose robots, days and recordings differ by `parts`."""
    robot, day, recording = parts
    values, of_day, of_unit = [], [], []
    for unit in range(units):
        own = TRUTH + robot * random.normal()
        for number in range(days):
            today = own + day * random.normal()
            for _ in range(int(random.integers(1, per_day + 1))):
                values.append(today + recording * random.normal())
                of_day.append(number)
                of_unit.append(unit)
    return np.array(values), of_day, of_unit


@pytest.mark.parametrize(
    ("units", "days", "parts"),
    [
        (5, 6, (0.03, 0.01, 0.005)),
        (20, 10, (0.02, 0.02, 0.01)),
        (4, 20, (0.0, 0.01, 0.03)),
        (8, 3, (0.05, 0.0, 0.01)),
    ],
)
def test_the_fleets_mean_is_covered_in_92_to_98_percent_of_200_fleets(units, days, parts) -> None:
    random = np.random.default_rng(7)
    held = 0
    for _ in range(200):
        values, of_day, of_unit = fleet(random, units, days, 3, parts)
        mean = nested_means(values, np.zeros(len(values)), of_day, of_unit).fleet
        held += mean.low < TRUTH < mean.high
    assert 0.92 <= held / 200 <= 0.985


def test_a_robots_own_mean_is_covered_as_well() -> None:
    random = np.random.default_rng(3)
    held = total = 0
    for _ in range(60):
        own = TRUTH + 0.03 * random.normal(size=6)
        values = own[:, None] + 0.01 * random.normal(size=(6, 8))
        days, units = list(range(8)) * 6, [unit for unit in range(6) for _ in range(8)]
        found = nested_means(values.ravel(), np.zeros(48), days, units)
        held += sum(found.units[unit].low < own[unit] < found.units[unit].high for unit in range(6))
        total += 6
    assert 0.92 <= held / total <= 0.98


def test_the_parts_are_found() -> None:
    values, days, units = fleet(np.random.default_rng(1), 60, 30, 3, (0.05, 0.02, 0.01))
    found = nested_means(values, np.zeros(len(values)), days, units)
    assert found.recordings_std == pytest.approx(0.01, rel=0.1)
    assert found.days_std == pytest.approx(0.02, rel=0.1)
    assert found.units_std == pytest.approx(0.05, rel=0.25)


def test_balanced_values_have_the_textbooks_interval() -> None:
    """One recording a robot: Student's interval of the plain mean."""
    values = np.array([1.0, 1.3, 0.8, 1.1])
    found = nested_means(values, np.zeros(4), [0, 0, 0, 0], list("abcd")).fleet
    half = student.ppf(0.975, 3) * values.std(ddof=1) / 2
    assert (found.low, found.high) == pytest.approx((values.mean() - half, values.mean() + half))


def test_what_nothing_shows_is_said_to_be_unknown() -> None:
    one = nested_means(np.array([2.0]), np.array([0.1]), [0], ["a"])
    assert (one.recordings_std, one.days_std, one.units_std) == (None, None, None)
    assert one.fleet.value == 2.0
    assert one.fleet.high - 2.0 == pytest.approx(1.96 * 0.1, rel=1e-3)


def test_a_weight_is_one_over_the_variance() -> None:
    values, variances, one = np.array([1.0, 3.0]), np.array([1.0, 3.0]), np.zeros(2, dtype=int)
    (value,), (variance,) = pooled(values, variances, 0.0, one)
    assert (value, variance) == pytest.approx((1.5, 0.75))
    assert pooled(values, variances, 0.0, np.array([0, 1]))[0] == pytest.approx(values)
    assert mean_of(values, variances, 1e9).value == pytest.approx(2.0)
