"""What rehearsals make of a motion: smaller, or as it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any
from unittest.mock import Mock, patch

import numpy as np
import pytest

import design_samples
from plantar.design import story
from plantar.design.rehearsals import attempt, rehearsal
from plantar.design.rehearsals.rehearsal import DRAWS, Rehearsal
from plantar.design.story import (
    DesignSettings,
    design_motion,
)
from plantar.errors import DataError
from plantar.motions.plan import Plan
from plantar.twin.robots import hrp2
from plantar.twin.simulation.physics import Physics

FRICTION = 0.3
KEPT = 0.0055
SPARE = 0.005
LEFT = 0.87
LIFT = 0.35
BEND = 0.1
FACTORS = (0.5, 1.0, 2.0)
KINDS = ("ends", "sides", "friction", "load", "bend")
FREE = Rehearsal(
    1.0, (0.04, 0.04), (0.05, 0.05), least_load=1.0
)  # takes up less than a quarter of each limit


def standing(foretold: float | np.ndarray = LEFT) -> attempt.Attempt:
    """A motion that takes up as much of its limits, by the linear robot, and what is found for it stays as it is."""
    reach = Mock(used_by_kind=lambda _: foretold * np.ones((len(FACTORS), len(KINDS))))
    return attempt.Attempt(reach, lambda _, start: start, np.ones(3), FACTORS)


def rehearsed(motion: attempt.Attempt, *found: Rehearsal) -> None:
    motion.rehearsals = {one.factor: one for one in found}


def test_a_limit_that_is_passed_is_held_to_less_where_it_is_passed_alone() -> None:
    """Of 50 mm to the sides 48 are used where 44.5 may be."""
    motion = standing()
    near = replace(FREE, factor=2.0, sole_margins=(0.04, 0.002))
    rehearsed(motion, replace(FREE, factor=0.5), near)
    motion.adapt()
    less = (1 - SPARE) * (0.05 - KEPT) / (0.05 - 0.002)
    sides = KINDS.index("sides")
    assert np.delete(motion.shares, sides, axis=1) == pytest.approx(LEFT)
    # Half way between, in the logarithm of the stiffness, half of it.
    assert motion.shares[:, sides] == pytest.approx(LEFT * np.array([1.0, less**0.5, less]))
    assert motion.first == [2.0]
    assert not motion.rehearsals, "another motion"
    motion.reach.held.assert_called_once_with(motion.shares, 1.0, ())  # type: ignore[attr-defined]


def test_what_failed_far_from_a_limit_is_held_to_less_than_it_used() -> None:
    motion = standing(0.4)
    rehearsed(motion, *(replace(FREE, factor=each, friction=1.1 * FRICTION) for each in FACTORS))
    motion.adapt()
    kept = (1 - SPARE) / 1.1
    assert motion.shares[:, KINDS.index("friction")] == pytest.approx(0.4 * kept)
    rehearsed(motion, *(replace(FREE, factor=each, fell="it falls") for each in FACTORS))
    motion.adapt()
    assert motion.shares[:, KINDS.index("bend")] == pytest.approx(0.85 * 0.4), "by as much as a step may"


def test_the_ends_come_first_then_what_did_not_hold_and_all_hold_in_the_end() -> None:
    played: list[tuple[list[float], np.ndarray]] = []

    def rehearse(
        _: object, plan: Plan, told: object, factors: Sequence[float], *__: object
    ) -> list[Rehearsal]:
        first = not played
        played.append((list(factors), plan.positions - plan.positions[0]))
        near = (0.05, 0.004 if first else 0.006)
        return [
            Rehearsal(each, near if each > 1.9 else (0.05, 0.05), (0.05, 0.05), least_load=1.0)
            for each in factors
        ]

    with (
        patch.object(story, "best_motion", design_samples.gentle_motion),
        patch.object(story, "better_motion", lambda limits, _, start, __: 0.9 * start),
        patch.object(attempt, "rehearse", rehearse),
    ):
        found = design_motion(hrp2.robot(), DesignSettings(500.0, duration=20.0, seed=1))
    assert [factors for factors, _ in played] == [
        [0.5, 2.0],
        [2.0, 0.5],
        pytest.approx([0.5**0.5, 1.0, 2**0.5, 2**0.75]),
    ]
    whole, less = played[0][1], played[1][1]
    np.testing.assert_allclose(less, 0.9 * whole, rtol=0.0, atol=0.01 * np.abs(whole).max())
    assert np.array_equal(played[2][1], less)
    assert [one.factor for one in found.rehearsals] == pytest.approx(
        [0.5, 0.5**0.5, 1.0, 2**0.5, 2**0.75, 2.0]
    )


def test_joints_move_less_where_legs_do_not_reach_and_soles_hold_what_they_held() -> None:
    motion, reach = standing(0.4), design_samples.reach()
    motion.reach, motion.coefficients = reach, 0.5 * design_samples.coefficients()
    shares = motion.shares.copy()
    largest = reach.held(np.full(shares.shape, 1e9)).used(motion.coefficients)
    with patch.object(motion, "better", lambda within, start: start / within.used(start)):
        motion.shrink()
    assert motion.others == pytest.approx(0.85 * largest)
    assert reach.used_over_none(motion.coefficients) <= 0.85 * largest * (1 + 1e-9)
    assert np.array_equal(motion.shares, shares)


def test_arms_that_touch_something_are_left_out_and_limits_hold_without_them() -> None:
    motion = standing()
    motion.reach = Mock(lines=design_samples.reach().lines)
    motion.coefficients = design_samples.coefficients()
    assert motion.lower_arms()
    still = design_samples.reach().lines.without(design_samples.coefficients(), "arms")
    assert np.array_equal(motion.coefficients, still)
    motion.reach.held.assert_called_once_with(motion.shares, 1.0, ("arms",))
    assert not motion.lower_arms(), "they are at rest"


@pytest.mark.parametrize(
    ("one", "kind", "used"),
    [
        ({"sole_margins": (0.01, 0.04)}, "ends", 0.04 / (0.05 - KEPT)),
        ({"sole_margins": (0.04, 0.01)}, "sides", 0.04 / (0.05 - KEPT)),
        ({"friction": 0.2}, "friction", 0.2 / FRICTION),
        ({"least_load": 0.5}, "load", 0.5 / (1 - LIFT)),
        ({"bend": 0.07}, "bend", 0.07 / BEND),
    ],
)
def test_a_rehearsal_takes_up_shares_of_each_limit(one: dict[str, Any], kind: str, used: float) -> None:
    found, _ = attempt.used_by(replace(FREE, **one))
    assert found[KINDS.index(kind)] == pytest.approx(used)
    assert np.delete(found, KINDS.index(kind)).max() < 0.25
    too_much, reason = attempt.used_by(replace(FREE, effort=1.8))
    assert too_much == pytest.approx(2.0)
    assert "180 % of its torque limit" in reason


def test_each_draw_of_a_rehearsal_has_its_own_sensors_and_a_floor_for_its_steps() -> None:
    """A floor is told by stiffness k and damping c: a contact that steps of h hold still has c·h of 1, and c² = 4k of
    one that swings no more."""
    seeds, played = list[int](), list[Physics]()

    def record(_: object, robot: object, world: Physics, preset: object, seed: int) -> Mock:
        seeds.append(seed)
        return Mock(log=seed)

    def roll_each(own: list[Any], _: object) -> list[Mock]:
        played.extend(world for _, world in own)
        return [Mock() for _ in own]

    def identify(_: object, logs: list[int]) -> int:
        if logs == [708]:
            raise DataError("stands still")
        return logs[0]

    with (
        patch.object(rehearsal, "roll_each", roll_each),
        patch.object(rehearsal, "record", record),
        patch.object(rehearsal, "identify_feet", identify),
        patch.object(
            rehearsal,
            "_measured",
            lambda factor, _, rollout, world: Rehearsal(factor, rollout=rollout, world=world),
        ),
    ):
        soft, told = rehearsal.rehearse(
            hrp2.robot(), Mock(), design_samples.told(), [0.5, 0.707], progress=lambda _: None
        )
        assert soft.feet_found(hrp2.robot(), draws=DRAWS) == (500, 501, 502, 503)
        assert told.feet_found(hrp2.robot(), draws=DRAWS) == (707, None, 709, 710)
        assert told.feet_found(hrp2.robot(), 2) == (707, None)
    assert seeds == [500, 501, 502, 503, 707, 708, 709, 710, 707, 708]
    told_once = design_samples.told()
    for factor, world in zip((0.5, 0.707), played, strict=True):
        assert {(bush.pitch_stiffness, bush.roll_stiffness) for bush in (world.bushes or {}).values()} == {
            2 * (factor * told_once.stiffness,)
        }
    stiffness, damping, _ = played[0].floor
    assert damping * played[0].timestep == pytest.approx(1.0)
    assert damping**2 == pytest.approx(4 * stiffness)
    assert played[0].timestep == 2 * Physics().timestep


@pytest.mark.parametrize("margin", [4e-4, 0.0, -2e-4, -1.0])
def test_a_centre_of_pressure_at_the_border_does_not_say_how_much_too_large(margin: float) -> None:
    """It never leaves a sole: how far beyond the limits a sole tips is not seen, so the step is the largest."""
    used, reason = attempt.used_by(replace(FREE, sole_margins=(margin, 0.04)))
    assert used[0] == np.inf
    assert used[1] < 1.0
    assert "of a sole's border" in reason
    seen = attempt.used_by(replace(FREE, sole_margins=(6e-4, 0.04)))[0][0]
    assert seen == pytest.approx((0.05 - 6e-4) / (0.05 - KEPT))


def test_the_ends_and_what_is_told_are_identified_in_more_draws_than_what_lies_between() -> None:
    found = [Rehearsal(factor) for factor in (0.6, 0.8, 1.0, 1.5, 2.0)]
    with patch.object(Rehearsal, "feet_found", lambda *given: given):
        rows = attempt._with_results(hrp2.robot(), found)
    assert [row.results[-1] for row in rows] == [4, 2, 4, 2, 4]
    assert [row.factor for row in rows] == [0.6, 0.8, 1.0, 1.5, 2.0]


def test_the_tightest_limit_is_told_with_its_number() -> None:
    """Margins of 30 mm ahead and 40 mm aside at rest; each limit is the tightest of one rehearsal in turn."""
    usual = Rehearsal(0.5, (0.03, 0.04), (0.03, 0.04), 1.0, 0.0, 0.0, 0.0)
    for changes, used, text in (
        ({"sole_margins": (0.01, 0.04)}, (0.02 / (0.03 - KEPT), 0, 0, 0, 0),
         "a centre of pressure comes within 10.0 mm of a sole's border"),
        ({"sole_margins": (0.03, 0.01)}, (0, 0.03 / (0.04 - KEPT), 0, 0, 0),
         "a centre of pressure comes within 10.0 mm of a sole's border"),
        ({"friction": 0.21}, (0, 0, 0.21 / FRICTION, 0, 0), "a foot needs a friction of 0.21"),
        ({"least_load": 0.48}, (0, 0, 0, 0.52 / (1 - LIFT), 0), "a foot keeps 48 % of its load"),
        ({"bend": 0.04}, (0, 0, 0, 0, 0.04 / attempt.BEND), "a foot is bent by 0.04 rad"),
        ({"effort": 0.45}, (0, 0, 0, 0, 0), "a joint needs 45 % of its torque limit"),
        ({"effort": 1.8}, (2, 2, 2, 2, 2), "a joint needs 180 % of its torque limit"),
        ({"sole_margins": (0.0004, 0.04)}, (np.inf, 0, 0, 0, 0),
         "a centre of pressure comes within 0.4 mm of a sole's border"),
        ({"standing_margins": (0.004, 0.04)}, (np.inf, 0, 0, 0, 0),
         "a centre of pressure comes within 30.0 mm of a sole's border"),
    ):  # fmt: skip
        found, tightest = attempt.used_by(replace(usual, **changes))  # type: ignore[arg-type]
        np.testing.assert_allclose(found, used)
        assert tightest == f"at 0.5 times the stiffness {text}"
    found, tightest = attempt.used_by(replace(usual, fell="it falls"))
    assert (np.isinf(found).all(), tightest) == (True, "at 0.5 times the stiffness: it falls")
