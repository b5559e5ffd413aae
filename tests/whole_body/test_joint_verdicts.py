"""What is said of a joint's terms, by their intervals and beside the torque."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.whole_body.joints import _held_out, _judge, _judge_all
from plantar.whole_body.regularised_fit import HeldOutError

OFFSET_SHARE = 0.05


def test_a_wide_interval_is_told_by_its_half() -> None:
    assert _judge("viscous", 1.0, (0.6, 1.4), 10.0, False) == (
        "weak", "the interval is 40 % of the value to each side",
    )  # fmt: skip
    assert _judge("viscous", -1.0, (-1.4, -0.6), 10.0, False)[1] == "negative, which is impossible"
    assert _judge("offset", 0.1, (-0.3, 0.5), 10.0, True)[0] == "usable", "near zero beside the torque"


def test_beside_an_impossible_term_none_is_usable() -> None:
    """A knee that walks about one radian: a spring of -38 N.m/rad and an offset of 37 N.m are one line."""
    terms, values = ("viscous", "offset", "stiffness"), np.array([0.1, 37.0, -38.0])
    told = [(-0.5, 0.7), (33.0, 41.0), (-42.0, -34.0)]
    found = _judge_all(terms, values, told, 60.0, False)
    assert [verdict for verdict, _ in found] == ["unidentifiable", "weak", "unidentifiable"]
    assert "stiffness is negative" in found[1][1]
    unsure = [*told[:2], (-42.0, 3.0)]
    assert [verdict for verdict, _ in _judge_all(terms, values, unsure, 60.0, False)][1] == "usable"


@pytest.mark.parametrize("value", [2.0, -2.0])
def test_a_joints_term_is_judged_by_half_of_its_interval_over_its_value(value: float) -> None:
    """A fifth of it; an offset may also be small beside the torque."""

    def verdict(share: float, torque: float = 0.0) -> str:
        low, high = sorted((value * (1 - share), value * (1 + share)))
        return _judge("offset", value, (low, high), torque, False)[0]

    assert [verdict(share) for share in (0.19, 0.21, 0.99, 1.01)] == [
        "usable",
        "weak",
        "weak",
        "unidentifiable",
    ]
    assert verdict(0.5, 1.0 / OFFSET_SHARE * 1.01) == "usable"
    assert verdict(0.5, 1.0 / OFFSET_SHARE * 0.99) == "weak"


def test_a_fit_is_judged_in_the_weights_of_another() -> None:
    """Squared errors over squared weights: with half of the reference's weight the same error counts four times."""
    tried = (HeldOutError(1.0, np.array([2.0, 4.0])), HeldOutError(2.0, np.array([5.0, 5.0])))
    one = SimpleNamespace(held_out=tried, weights={0: 1.0, 1: 2.0})
    reference = SimpleNamespace(held_out=tried, weights={0: 2.0, 1: 4.0})
    alike, lighter = _held_out(one, one), _held_out(one, reference)  # type: ignore[arg-type]
    assert lighter == pytest.approx(4 * alike)
    assert alike == pytest.approx(tried[0].errors), "those whose mean is the smallest"
