"""Segments: runs of true samples."""

from __future__ import annotations

import numpy as np

from plantar.signals.segments import (
    complete,
    longest_run,
    run_ends,
    run_numbers,
    runs,
    spread_out,
    steps_in,
)


def test_runs_are_the_stretches_of_true() -> None:
    assert runs(np.array([1, 1, 0, 1, 0, 0, 1], dtype=bool)) == [slice(0, 2), slice(3, 4), slice(6, 7)]
    assert runs(np.zeros(4, dtype=bool)) == []
    assert runs(np.ones(4, dtype=bool)) == [slice(0, 4)]


def test_a_time_takes_at_least_one_sample() -> None:
    assert [steps_in(0.05, period) for period in (0.001, 0.02, 0.1, 0.5)] == [50, 2, 1, 1]


def test_samples_are_complete_without_nan_and_infinity() -> None:
    values = np.ones((5, 3))
    values[[1, 2, 3], [0, 1, 2]] = [np.nan, np.inf, -np.inf]
    values[3, 0] = np.inf
    assert complete(values).tolist() == [True, False, False, False, True]


def test_samples_are_complete_where_no_column_of_any_table_is_empty() -> None:
    one, other = np.ones((5, 2)), np.ones((5, 1))
    one[1, 0] = one[3, 1] = other[3, 0] = np.nan
    assert complete(one, other).tolist() == [True, False, True, False, True]


def test_rows_are_spread_over_all_of_them() -> None:
    rows = np.arange(100, 150)
    assert spread_out(rows, 5).tolist() == [100, 110, 120, 130, 140]
    np.testing.assert_array_equal(spread_out(rows, 26), rows)
    assert len(spread_out(rows, 25)) == 25
    assert spread_out(rows[:0], 5).size == 0
    assert spread_out(rows[:3], 5).tolist() == [100, 101, 102]


def test_runs_have_numbers_and_ends() -> None:
    valid = np.array([1, 1, 1, 1, 1, 1, 0, 1, 1, 0, 1], dtype=bool)
    assert run_numbers(valid).tolist() == [0, 0, 0, 0, 0, 0, -1, 1, 1, -1, 2]
    assert np.flatnonzero(run_ends(valid, 2)).tolist() == [0, 1, 4, 5, 7, 8, 10]
    assert longest_run(valid) == slice(0, 6)
