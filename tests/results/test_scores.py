"""Errors of a prediction, and the samples that give an unseen motion's offset."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest

from plantar.results.scores import error_measures, first_second, score


def test_a_row_by_hand() -> None:
    row = score("cross", "squat", "left", "roll", np.array([1.0, -4.0, 2.0]), np.array([0.0, -4.0, 4.0]), 1.0)
    assert asdict(row) == {
        "kind": "cross",
        "motion": "squat",
        "foot": "left",
        "axis": "roll",
        "mean_abs_error": pytest.approx((1 + 0 + 2) / 3),
        "rms_error": pytest.approx(np.sqrt((1 + 0 + 4) / 3)),
        "max_abs": 4.0,
        "percent_of_max": pytest.approx(25.0),
        "zero_mean_abs": pytest.approx((0 + 5 + 1) / 3),
        "samples": 3,
    }


def test_no_percentage_of_nothing() -> None:
    row = score("direct", "a", "left", "pitch", np.zeros(3), np.ones(3), 0.0)
    assert row.percent_of_max is None
    assert row.mean_abs_error == 1.0


def test_the_opening_is_one_second_of_samples_that_serve() -> None:
    time = np.arange(400) * 0.01
    used = time >= 1.0
    first = first_second(time, used)
    assert time[first].min() == pytest.approx(1.0)
    assert time[first].max() == pytest.approx(1.99)
    assert not first_second(time, np.zeros(400, dtype=bool)).any()


def test_a_percentage_is_the_mean_error_over_the_largest_value() -> None:
    found = error_measures(np.array([8.0, -10.0]), np.array([5.0, -8.0]), 1.0)
    assert (found["mean_abs_error"], found["max_abs"]) == (2.5, 10.0)
    assert found["percent_of_max"] == pytest.approx(25.0)
    assert found["zero_mean_abs"] == pytest.approx(9.0)
