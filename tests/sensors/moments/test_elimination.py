"""Columns solved for beside others say what a fit of all of them says."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.sensors.moments.elimination import beside, coefficients, information

KEPT = 5


@pytest.fixture
def columns() -> Array:
    """What is missing and eight columns, in three parts (parts, n, 9)."""
    return np.random.default_rng(0).normal(size=(3, 20, 9)) @ np.random.default_rng(1).normal(size=(9, 9))


def test_columns_beside_others_have_the_coefficients_and_deviations_of_a_fit_of_all(columns: Array) -> None:
    products, deviations = columns.mT @ columns, np.array([0.5, 2.0, 1.0, 0.3, 0.1, 0.2, 3.0, 1.0])
    weights = np.array([1.0, 3.0, 0.5])
    everything = np.tensordot(weights, products, 1)
    alone = beside(products, weights, deviations[KEPT:])
    both = alone.products.sum(axis=0)
    found, expected = coefficients(both, deviations[:KEPT]), coefficients(everything, deviations)
    np.testing.assert_allclose(found, expected[:KEPT], rtol=1e-10)
    remains = np.append(1.0, -found)
    np.testing.assert_allclose(alone.shares @ remains, -expected[KEPT:], rtol=1e-10)
    covariance = np.linalg.inv(information(everything, deviations))[:KEPT, :KEPT]
    np.testing.assert_allclose(np.linalg.inv(information(both, deviations[:KEPT])), covariance, rtol=1e-9)


def test_products_that_noise_taken_off_makes_negative_say_nothing_there() -> None:
    """The first column's square is less than nothing: its coefficient is the prior's."""
    products = np.array([[9.0, 1.0, 2.0], [1.0, -0.5, 0.0], [2.0, 0.0, 4.0]])
    deviations = np.array([0.1, 10.0])
    np.testing.assert_allclose(information(products, deviations), np.diag([100.0, 4.01]), atol=1e-12)
    np.testing.assert_allclose(coefficients(products, deviations), [0.0, 2.0 / 4.01], atol=1e-15)


def test_what_noise_leaves_of_columns_of_other_units_is_not_magnified() -> None:
    """Two columns whose difference is less than nothing: without it, their mean has what the sum of both says."""
    units = np.array([1.0, 1e3, 1e-3])
    products = np.array([[9.0, 2.5, 1.5], [2.5, 1.0, 1.02], [1.5, 1.02, 1.0]]) * np.outer(units, units)
    found = coefficients(products, 1e3 / units[1:]) * units[1:]
    np.testing.assert_allclose(found, 2 * [4.0 / (2 * 2.02)], rtol=1e-5)


def test_columns_of_nothing_leave_the_others_as_they_are(columns: Array) -> None:
    products, deviations = (columns.mT @ columns).sum(axis=0), np.ones(8)
    products[3] = products[:, 3] = 0.0
    others = [0, 1, 2, *range(4, 9)]
    found = coefficients(products, deviations)
    assert found[2] == pytest.approx(0.0, abs=1e-9)
    rest = coefficients(products[np.ix_(others, others)], deviations[1:])
    np.testing.assert_allclose(np.delete(found, 2), rest, rtol=1e-9)
