"""R factors add like the rows that they stand for."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar.estimation.least_squares import Block
from plantar.estimation.triangular import TriangularFactor


def block(label: str, seed: int, offset: float = 0.0, rows: int = 300, noise: float = 0.5) -> Block:
    random = np.random.default_rng(seed)
    regressor = random.normal(size=(rows, 2)) * [0.02, 0.1] + [0.03, 0.0]
    response = regressor @ [400.0, 20.0] + offset + noise * random.normal(size=rows)
    return Block(label, regressor, response, 0.01)


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**20),
    rows=st.lists(st.integers(1, 40), min_size=2, max_size=5),
    columns=st.integers(1, 6),
    exponent=st.floats(-6, 6),
)
def test_factors_add_like_the_rows_they_stand_for(
    seed: int, rows: list[int], columns: int, exponent: float
) -> None:
    """R of a sum is R of the stacked rows, in any order: RᵀR agrees, and so does the solution."""
    random = np.random.default_rng(seed)
    parts = [(random.normal(size=(n, columns)) * 10.0**exponent, random.normal(size=n)) for n in rows]
    factors = [TriangularFactor.of(np.column_stack([x, y])) for x, y in parts]
    total, reverse = factors[0], factors[-1]
    for factor in factors[1:]:
        total = total + factor
    for factor in factors[-2::-1]:
        reverse = reverse + factor
    stacked = np.column_stack([np.vstack([x for x, _ in parts]), np.concatenate([y for _, y in parts])])
    for factor in (total, reverse):
        gram = factor.factor.T @ factor.factor
        scale = np.outer(*(2 * [np.linalg.norm(stacked, axis=0)]))
        np.testing.assert_allclose(gram / scale, stacked.T @ stacked / scale, atol=1e-12)
        assert factor.rows == sum(rows)
    if sum(rows) >= columns + 5:
        expected = np.linalg.lstsq(stacked[:, :-1], stacked[:, -1], rcond=None)[0]
        np.testing.assert_allclose(total.solve(), expected, rtol=1e-6, atol=1e-8 * 10.0**-exponent)
        residual = stacked[:, -1] - stacked[:, :-1] @ expected
        assert total.residual_norm == pytest.approx(np.linalg.norm(residual), rel=1e-8)


def test_a_factor_among_others_fills_its_own_places() -> None:
    one = block("a", 4)
    factor = TriangularFactor.of(np.column_stack([one.regressor, one.response])).among(np.array([2, 0]), 4)
    gram = factor.factor.T @ factor.factor
    wide = np.zeros((300, 5))
    wide[:, [2, 0, 4]] = np.column_stack([one.regressor, one.response])
    np.testing.assert_allclose(gram, wide.T @ wide, atol=1e-8)
