"""Columns made orthonormal, and rows without them: what a fit with the columns beside it leaves."""

from __future__ import annotations

import numpy as np

from plantar.estimation.orthonormal import orthonormal, without


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


def test_more_columns_stand_beside_those_there() -> None:
    random = np.random.default_rng(2)
    first, more = orthonormal(random.standard_normal((80, 4))), random.standard_normal((80, 2))
    both = np.hstack([first, orthonormal(more, first)])
    np.testing.assert_allclose(both.T @ both, np.eye(6), atol=1e-12)
    np.testing.assert_allclose(without(both, more), 0.0, atol=1e-12)
