"""Small parts of signals, each by a case that is solved by hand."""

from __future__ import annotations

import numpy as np

from plantar.signals.resampling import interpolate


def test_what_lies_on_a_sample_is_known_beside_any_gap() -> None:
    """On the one before a gap, on the one behind it, and on the last; nothing in between, nor outside."""
    time, values = np.array([0.0, 1.0, 5.0, 6.0]), np.array([3.0, 5.0, 9.0, 7.0])
    at = np.array([-0.1, 0.0, 0.5, 1.0, 1.5, 4.9, 5.0, 5.5, 6.0, 6.1])
    found = interpolate(at, time, values, 2.0)
    nan = np.nan
    np.testing.assert_array_equal(found, [nan, 3.0, 4.0, 5.0, nan, nan, 9.0, 8.0, 7.0, nan])
    np.testing.assert_array_equal(
        interpolate(at[:4], time[[0, 2, 3]], values[[0, 2, 3]], 2.0), [nan, 3.0, nan, nan]
    )
    holed = np.where(time == 1.0, nan, values)
    np.testing.assert_array_equal(interpolate(time, time, holed, 6.0), [3.0, 4.2, 9.0, 7.0])
    assert np.isnan(interpolate(at, time, np.array([1.0, nan, nan, nan]), 2.0)).all()
