"""How an attempt holds a motion to less, by made-up limits: at which stiffness, by how much, and what comes next."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.design.reach import BEND, FRICTION, KINDS
from plantar.design.rehearsals.attempt import LEFT, SMALLER, SPARE, Attempt
from plantar.design.rehearsals.rehearsal import Rehearsal

FACTORS = (0.5, 1.0, 2.0)
FORETOLD = np.array([[0.5, 0.5, 0.5, 0.5, 0.5], [0.6] * 5, [0.9, 0.9, 0.7, 0.9, 0.9]])
KIND = {"friction": 2, "bend": 4}


def attempt(**more: Any) -> tuple[Attempt, list[Any]]:
    """One whose limits keep what they are held to, and whose better motion is twice as large."""
    asked: list[Any] = []

    def held(shares: Any, others: float, still: Any) -> Any:
        asked.append((np.array(shares), others, still))
        return f"held {len(asked)}"

    reach: Any = SimpleNamespace(
        used_by_kind=lambda _: FORETOLD, held=held, used_over_none=lambda _: 0.8,
        lines=SimpleNamespace(without=lambda motion, what: motion * [1.0, 0.0] if what == "arms" else motion),
    )  # fmt: skip
    made = Attempt(reach, lambda within, motion: 2 * motion, np.array([1.0, 3.0]), FACTORS, **more)
    return made, asked


def rehearsed(factor: float, **used: float) -> Rehearsal:
    return Rehearsal(
        factor, (0.05, 0.05), (0.05, 0.05), 1.0, used.get("friction", 0.0), 0.0, used.get("bend", 0.0)
    )


def test_what_used_too_much_is_held_to_less_there_and_to_shares_of_that_between() -> None:
    """At twice the stiffness friction is 40 % too large, at half of it the bend is 10 % too large."""
    made, asked = attempt()
    made.rehearsals = {2.0: rehearsed(2.0, friction=1.4 * FRICTION), 0.5: rehearsed(0.5, bend=1.1 * BEND)}
    made.adapt()
    ((shares, others, still),) = asked
    bend, friction = (1 - SPARE) / 1.1, SMALLER
    expected = np.full((3, len(KINDS)), LEFT)
    expected[2, KIND["friction"]] = friction * 0.7
    expected[0, KIND["bend"]] = bend * 0.5
    expected[1, KIND["friction"]] = LEFT * np.sqrt(friction)
    expected[1, KIND["bend"]] = LEFT * np.sqrt(bend)
    np.testing.assert_allclose(shares, expected)
    assert (others, still) == (1.0, ())
    assert made.first == [2.0, 0.5]
    assert (made.coefficients.tolist(), made.rehearsals) == ([2.0, 6.0], {})


def test_only_what_did_not_hold_comes_first() -> None:
    made, _ = attempt()
    assert made.first == [0.5, 2.0], "the ends, before any was played"
    assert made.next_factors() == [0.5, 2.0]
    made.rehearsals = {0.5: rehearsed(0.5)}
    assert made.next_factors() == [2.0, 1.0], "two at once"
    made.rehearsals[2.0] = rehearsed(2.0)
    assert made.next_factors() == [1.0]
    made.rehearsals[2.0] = rehearsed(2.0, friction=2 * FRICTION)
    made.adapt()
    assert made.first == [2.0]
    assert made.next_factors() == [2.0, 0.5]
    made.rehearsals = {factor: rehearsed(factor) for factor in FACTORS}
    assert made.next_factors() == []


def test_a_motion_that_legs_do_not_reach_is_made_smaller_over_no_bush() -> None:
    made, asked = attempt()
    made.shrink()
    made.shrink()
    assert [others for _, others, _ in asked] == pytest.approx([SMALLER * 0.8, SMALLER * SMALLER * 0.8])
    assert (asked[0][0] == LEFT).all()


def test_arms_are_left_out_once_and_only_where_they_move() -> None:
    made, asked = attempt()
    assert made.lower_arms()
    assert made.coefficients.tolist() == [2.0, 0.0]
    assert asked[0][2] == ("arms",)
    assert not made.lower_arms(), "they rest already"
    still, never = attempt()
    still.coefficients = np.array([1.0, 0.0])
    assert not still.lower_arms()
    assert (never, still.still) == ([], ())
