"""A signal without its slow cosines: what they make up is gone, what they do not stays, in few samples as in many."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.signals.slow_cosines import FEW, without_slow_cosines

PERIOD, SLOWEST = 0.05, 0.05
SHORT, LONG = 1200, 12001


@pytest.mark.parametrize("count", [SHORT, LONG])
def test_slow_cosines_go_and_quick_ones_stay(count: int) -> None:
    most = round(2 * SLOWEST * count * PERIOD)
    assert (most >= FEW) == (count == LONG)
    moments = np.pi * (np.arange(count) + 0.5) / count
    slow = np.column_stack([np.cos(order * moments) for order in (0, 1, most)])
    quick = np.column_stack([np.cos(order * moments) for order in (most + 1, 3 * most, count // 2)])
    assert np.allclose(without_slow_cosines(slow + quick, PERIOD, SLOWEST), quick, atol=1e-10)


def test_one_cosine_more_than_a_product_takes_changes_nothing() -> None:
    """Both ways project on the same columns."""
    rows = np.random.default_rng(0).standard_normal((7000, 3)).cumsum(axis=0)
    most = [FEW - 1, FEW]
    left = [without_slow_cosines(rows, PERIOD, order / (2 * len(rows) * PERIOD)) for order in most]
    cosine = np.cos(np.pi * FEW * (np.arange(len(rows)) + 0.5) / len(rows))[:, None]
    cosine /= np.linalg.norm(cosine)
    assert np.allclose(left[1], left[0] - cosine @ (cosine.T @ left[0]), atol=1e-9 * np.abs(rows).max())
