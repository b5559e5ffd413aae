"""Medians against NumPy's."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.signals.medians import median, running_median

DRAWN = np.random.default_rng(0).normal(size=(7, 60))


@pytest.mark.parametrize("size", [1, 2, 3, 17, 60])
@pytest.mark.parametrize("order", ["C", "F"])
def test_medians_are_numpys(size: int, order: str) -> None:
    rows = np.array(DRAWN[:, :size], order=order)  # type: ignore[call-overload]
    before = rows.copy()
    assert np.array_equal(median(rows), np.median(rows, axis=1))
    assert median(rows[0]) == np.median(rows[0])
    assert np.array_equal(rows, before)  # what it is given stays in order


def test_running_medians_are_those_of_each_window() -> None:
    values = DRAWN[0]
    expected = [np.median(values[first : first + 9]) for first in range(values.size - 8)]
    assert np.array_equal(running_median(values, 9), expected)
