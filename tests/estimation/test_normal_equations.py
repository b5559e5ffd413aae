"""Least squares from products against NumPy's."""

from __future__ import annotations

import numpy as np

from plantar.estimation.normal_equations import solved

RANDOM = np.random.default_rng(0)
UNITS = np.array([1.0, 1e-6, 1e4, 0.1])
DRAWN, EXPLAINED = RANDOM.normal(size=(200, 4)), RANDOM.normal(size=(200, 2))
COLUMNS = DRAWN * UNITS
# NumPy's own loses digits where columns differ in size.
EXPECTED = np.linalg.lstsq(DRAWN, EXPLAINED, rcond=None)[0] / UNITS[:, None]


def test_sizes_are_those_of_least_squares() -> None:
    products = COLUMNS.T @ COLUMNS
    np.testing.assert_allclose(solved(products, COLUMNS.T @ EXPLAINED), EXPECTED, rtol=1e-10)
    np.testing.assert_allclose(solved(products, COLUMNS.T @ EXPLAINED[:, 0]), EXPECTED[:, 0], rtol=1e-10)


def test_columns_that_say_the_same_or_nothing_share_what_they_explain() -> None:
    twice = np.column_stack([COLUMNS, COLUMNS[:, :1], np.zeros(200)])
    sizes = solved(twice.T @ twice, twice.T @ EXPLAINED)
    np.testing.assert_allclose(sizes[[0, 4]], np.array([0.5, 0.5])[:, None] * EXPECTED[0], rtol=1e-8)
    np.testing.assert_allclose(sizes[1:4], EXPECTED[1:], rtol=1e-8)
    assert not sizes[5].any()
