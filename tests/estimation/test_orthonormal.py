"""Columns made orthonormal, and rows without them: what a fit with the columns beside it leaves."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.estimation.orthonormal import SlowSpan, orthonormal, without
from plantar.estimation.slow_drift import drift_basis

PERIOD = 0.025  # s


def test_rows_are_left_as_a_fit_of_the_columns_leaves_them() -> None:
    random = np.random.default_rng(0)
    columns, rows = random.standard_normal((200, 5)) * [1, 1e3, 1e-4, 1, 1], random.standard_normal((200, 3))
    fitted = columns @ np.linalg.lstsq(columns, rows, rcond=None)[0]
    np.testing.assert_allclose(without(orthonormal(columns), rows), rows - fitted, atol=1e-12)


def test_a_column_that_others_hold_adds_none() -> None:
    random = np.random.default_rng(1)
    columns = random.standard_normal((50, 3))
    basis = orthonormal(columns[:, [0, 1, 0, 2]])
    assert basis.shape == (50, 3)
    np.testing.assert_allclose(basis.T @ basis, np.eye(3), atol=1e-12)
    assert orthonormal(columns[:, :2], orthonormal(columns)).shape == (50, 0)


@pytest.mark.parametrize("which", [[0, 0, 1], [2, 0, 1], [0, 2, 1, 0, 1], [0, 1, 3, 4]])
def test_a_column_that_others_hold_takes_nothing_of_those_behind_it(which: list[int]) -> None:
    """Column 2 is zero, 3 is made of the first two; lengths differ by far."""
    x, y, z = np.random.default_rng(4).standard_normal((3, 50)) * np.array([[1e3], [1.0], [1e-3]])
    columns = np.column_stack([x, y, 0 * x, 2 * x - y, z])[:, which]
    beside = orthonormal(np.ones((50, 1)))
    for own in (orthonormal(columns), orthonormal(columns, beside)):
        assert own.shape == (50, len({0, 1, 4} & set(which)))
        np.testing.assert_allclose(own.T @ own, np.eye(own.shape[1]), atol=1e-12)
    left = without(np.hstack([beside, own]), columns)
    np.testing.assert_allclose(np.linalg.norm(left, axis=0), 0.0, atol=1e-12 * 1e3)


def test_more_columns_stand_beside_those_there() -> None:
    random = np.random.default_rng(2)
    first, more = orthonormal(random.standard_normal((80, 4))), random.standard_normal((80, 2))
    both = np.hstack([first, orthonormal(more, first)])
    np.testing.assert_allclose(both.T @ both, np.eye(6), atol=1e-12)
    np.testing.assert_allclose(without(both, more), 0.0, atol=1e-12)


def _time(seconds: float, holes: int) -> np.ndarray:
    """Times [s] of samples, without some that a fit does not use."""
    rng, used = np.random.default_rng(holes), np.ones(round(seconds / PERIOD), dtype=bool)
    for start, length in zip(rng.integers(0, len(used), holes), rng.integers(1, 900, holes), strict=True):
        used[start : start + length] = False
    return np.asarray(np.flatnonzero(used) * PERIOD)


@pytest.mark.parametrize("seconds", [10.0, 44.0, 355.0, 600.0, 1500.0])
@pytest.mark.parametrize("holes", [0, 1, 12])
def test_slow_columns_are_taken_off_as_any_are(seconds: float, holes: int) -> None:
    time = _time(seconds, holes)
    basis = drift_basis(time)
    rows = np.random.default_rng(1).normal(3.0, 1.0, (len(time), 5)) + time[:, None]
    expected = rows - basis @ np.linalg.lstsq(basis, rows, rcond=None)[0]
    np.testing.assert_allclose(
        SlowSpan(basis, time, 20.0).off(rows), expected, atol=1e-10 * np.abs(rows).max()
    )


def test_columns_of_ten_minutes_are_kept_by_stretches() -> None:
    """Sixty columns of 24,000 samples are not multiplied: the rows that are left after the stretches are a tenth."""
    time = _time(600.0, 0)
    span = SlowSpan(drift_basis(time), time, 20.0)
    assert span.rows < 0.12 * len(time)
    assert SlowSpan(drift_basis(time[:1760]), time[:1760], 20.0).rows == 1760


def test_no_slow_column_is_taken_off_no_rows() -> None:
    assert SlowSpan(drift_basis(np.zeros(0)), np.zeros(0), 20.0).off(np.zeros((0, 3))).shape == (0, 3)
