"""A signal without its slow cosines: what they make up is gone, what they do not stays, in few samples as in many."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.signals.filters import without_slow_cosines

PERIOD, SLOWEST = 0.05, 0.05
SHORT, LONG = 1200, 12001


@pytest.mark.parametrize("count", [SHORT, LONG])
def test_slow_cosines_go_and_quick_ones_stay(count: int) -> None:
    most = round(2 * SLOWEST * count * PERIOD)
    moments = np.pi * (np.arange(count) + 0.5) / count
    slow = np.column_stack([np.cos(order * moments) for order in (0, 1, most)])
    quick = np.column_stack([np.cos(order * moments) for order in (most + 1, 3 * most, count // 2)])
    assert np.allclose(without_slow_cosines(slow + quick, PERIOD, SLOWEST), quick, atol=1e-10)
