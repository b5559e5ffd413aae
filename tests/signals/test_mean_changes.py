"""Jumps of a mean, each once, the largest first; none between stretches, none in noise."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.signals.mean_changes import mean_changes

COUNT = 2000
NOISE = 0.1 * np.random.default_rng(0).standard_normal(COUNT)
ONE = np.zeros(COUNT, dtype=np.intp)


def stepped(*steps: tuple[int, float]) -> np.ndarray:
    return NOISE + sum(size * (np.arange(COUNT) >= row) for row, size in steps)


def test_jumps_are_found_at_their_rows_the_largest_first() -> None:
    found = mean_changes(stepped((500, 1.0), (1200, -3.0), (1600, 2.0)), ONE, 40, 8.0)
    assert [round(row, -1) for row in found] == [1200, 1600, 500]


def test_noise_has_none_nor_has_a_signal_shorter_than_six_widths() -> None:
    assert mean_changes(NOISE, ONE, 40, 8.0) == []
    assert mean_changes(stepped((1000, 3.0)), ONE, 334, 1.0) == []


@pytest.mark.parametrize(("apart", "some"), [(False, 1), (True, 0)])
def test_between_two_stretches_nothing_is_compared(apart: bool, some: int) -> None:
    stretch = ONE + apart * (np.arange(COUNT) >= 1000)
    assert len(mean_changes(stepped((1000, 3.0)), stretch, 40, 8.0)) == some


def test_stretches_too_short_to_compare_in_have_none() -> None:
    assert mean_changes(stepped((1000, 3.0)), np.arange(COUNT), 40, 8.0) == []
