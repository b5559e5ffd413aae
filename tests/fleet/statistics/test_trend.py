"""A line through days against SciPy's, and its coverage."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import linregress

from plantar.conventions import MONTH
from plantar.fleet.statistics.trend import trend_of


def test_the_line_is_the_textbooks() -> None:
    random = np.random.default_rng(0)
    time = np.sort(random.uniform(0, 200, 40))
    values = 0.01 * time / MONTH + random.normal(0, 0.02, 40)
    found, book = trend_of(time, values, np.full(40, 3.0)), linregress(time / MONTH, values)
    assert found is not None
    assert (found.slope, found.probability) == pytest.approx((book.slope, book.pvalue))
    assert found.high - found.slope == pytest.approx(2.0244 * book.stderr, rel=1e-4)


def test_weights_are_repeated_days() -> None:
    time, values = np.array([0.0, 10, 20, 30, 40]), np.array([0.0, 1, 1, 3, 4])
    twice = trend_of(np.append(time, 40.0), np.append(values, 4.0), np.ones(6))
    weighted = trend_of(time, values, np.array([1.0, 1, 1, 1, 2]))
    assert twice is not None
    assert weighted is not None
    assert weighted.slope == pytest.approx(twice.slope)


def test_the_interval_holds_as_often_as_it_says() -> None:
    random, held = np.random.default_rng(5), 0
    time = np.arange(0.0, 90, 3)
    for _ in range(400):
        found = trend_of(time, 0.01 * time / MONTH + random.normal(0, 0.01, 30), np.ones(30))
        assert found is not None
        held += found.low < 0.01 < found.high
    assert 0.92 <= held / 400 <= 0.98


def test_too_few_days_give_no_line() -> None:
    assert trend_of(np.arange(3.0), np.arange(3.0), np.ones(3)) is None
    assert trend_of(np.zeros(5), np.arange(5.0), np.ones(5)) is None
