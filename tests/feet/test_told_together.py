"""One value of what several axes tell."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.feet.assumptions import _together


def test_axes_weigh_by_their_variances_and_are_as_sure_as_the_surest() -> None:
    (found,) = _together("left", [(1.0, 0.1), (1.3, 0.2), (7.0, None)])
    assert (found.what, found.value) == ("left", pytest.approx((4 * 1.0 + 1.3) / 5))
    missed = np.sqrt((0.06 / 0.1) ** 2 + (0.24 / 0.2) ** 2)
    assert missed > 1, "they are further apart than they say"
    assert found.std == pytest.approx(0.1 * missed)
    (agreed,) = _together("left", [(1.0, 0.1), (1.01, 0.2)])
    assert agreed.std == pytest.approx(0.1), "four of them are no surer than one"


def test_what_has_no_deviation_is_a_plain_mean_and_of_none_nothing_is_known() -> None:
    assert _together("", [(1.0, None), (2.0, None)]) == [("", 1.5, None)]
    assert _together("", []) == []
