"""Small parts of the bush's models, each by a case that is solved by hand."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.models import BushMotion, Hardening, reach
from plantar.models.hardening import ZERO_ERROR


def test_a_cube_stands_about_its_own_zero_in_each_run() -> None:
    """Two runs, beside a gap, and two candidates of their zeros."""
    angle = np.array([0.01, -0.02, np.nan, 0.03])
    motion = BushMotion(angle, np.zeros(4), 0.01)
    states = np.array([[0.5, -1.0], [0.0, 2.0]])  # of each candidate, in each run
    found = Hardening().basis_columns(motion, np.zeros((2, 0)), states)
    for candidate in range(2):
        zero = ZERO_ERROR * states[candidate, [0, 0, 0, 1]]
        expected = (angle - zero) ** 3 + zero**3
        expected[2] = np.nan
        np.testing.assert_allclose(found[:, 0, candidate], expected, rtol=1e-9, atol=1e-18)


def test_the_reach_is_that_of_the_widest_run() -> None:
    assert reach([]) == 0.0
    narrow, wide = (BushMotion(np.array([-size, size, 0.0]), np.zeros(3), 0.01) for size in (0.01, 0.03))
    assert reach([wide, narrow]) == pytest.approx(0.03, rel=0.05)
