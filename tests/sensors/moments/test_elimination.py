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
    np.testing.assert_allclose(coefficients(products, deviations), [0.01, 2.0 / 4.01])
