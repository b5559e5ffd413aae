"""What rehearsals make of a motion: smaller, larger, or as it is; and what they promise."""

from __future__ import annotations

from collections.abc import Sequence
from unittest.mock import Mock, patch

import numpy as np
import pytest

import design_samples
from plantar.design import rehearsal, story
from plantar.design.rehearsal import Rehearsal
from plantar.design.story import (
    DesignSettings,
    design_motion,
)
from plantar.motions.plan import Plan
from plantar.twin.robots import hrp2
from plantar.twin.simulation.physics import Physics

FRICTION = 0.3
KEPT = 0.0055
SPARE = 0.005


def test_a_motion_that_is_too_large_is_made_smaller_by_as_much() -> None:
    """Of 50 mm to the border 48 are used where 44.5 may be: by half of that, as soles that roll exaggerate.

    The ends of the range come first, then what did not hold; all hold in the end with the motion as it is.
    """
    played: list[tuple[list[float], np.ndarray]] = []

    def rehearse(
        _: object, plan: Plan, told: object, factors: Sequence[float], *__: object
    ) -> list[Rehearsal]:
        moved = plan.positions - plan.positions[0]
        first = not played or moved is played[0][1] or np.array_equal(moved, played[0][1])
        played.append((list(factors), moved))
        return [
            Rehearsal(factor, sole_margin=0.002 if first and factor > 1.9 else 0.006, standing_margin=0.05)
            for factor in factors
        ]

    with (
        patch.object(story, "best_motion", design_samples.gentle_motion),
        patch.object(story, "rehearse", rehearse),
    ):
        found = design_motion(hrp2.robot(), DesignSettings(500.0, duration=20.0, seed=1))
    assert [factors for factors, _ in played] == [
        [0.5, 2.0],
        [2.0, 0.5],
        pytest.approx([0.5**0.5, 1.0, 2**0.5, 2**0.75]),
    ]
    whole, less = played[0][1], played[1][1]
    allowed = (1 - SPARE) * np.sqrt((0.05 - KEPT) / (0.05 - 0.002))
    assert less == pytest.approx(allowed * whole, abs=0.01 * np.abs(whole).max())
    assert np.array_equal(played[2][1], less)
    assert [one.factor for one in found.rehearsals] == pytest.approx(
        [0.5, 0.5**0.5, 1.0, 2**0.5, 2**0.75, 2.0]
    )


@pytest.mark.parametrize("holds", [True, False])
def test_a_motion_that_leaves_room_is_made_larger_once_and_not_if_that_does_not_hold(holds: bool) -> None:
    """Half of the room is used at both ends: the most that it may be larger by. As before, it held there before.

    The first is what rehearsals leave of the best motion, as a rule.
    """
    played: list[tuple[list[float], float]] = []
    best: list[np.ndarray] = []

    def best_motion(*told: object) -> np.ndarray:
        best.append(design_samples.gentle_motion(*told))
        return best[-1]

    def rehearse(
        _: object, plan: Plan, told: object, factors: Sequence[float], *__: object
    ) -> list[Rehearsal]:
        played.append((list(factors), float(np.abs(plan.positions - plan.positions[0]).max())))
        fell = None if len(played) != 2 or holds else "it falls"
        margin = 0.05 - (0.05 - KEPT) / 2
        return [Rehearsal(each, sole_margin=margin, standing_margin=0.05, fell=fell) for each in factors]

    with (
        patch.object(story, "best_motion", best_motion),
        patch.object(story, "rehearse", rehearse),
    ):
        found = design_motion(hrp2.robot(), DesignSettings(500.0, duration=20.0, seed=1))
    assert not any(one.fell for one in found.rehearsals)
    sizes = [size / played[0][1] for _, size in played]
    ends, between = [0.5, 2.0], [0.5**0.5, 1.0, 2**0.5, 2**0.75]
    assert [factors for factors, _ in played] == [
        ends,
        ends,
        pytest.approx(between),
    ]
    assert sizes == pytest.approx([1.0, 1.2, 1.2 if holds else 1.0], abs=0.01)
    assert found.coefficients == pytest.approx(0.87 * sizes[-1] * best[0], rel=0.01)


def test_a_motion_made_smaller_by_too_much_is_made_larger_by_half_of_that() -> None:
    sizes: list[float] = []

    def rehearse(
        _: object, plan: Plan, told: object, factors: Sequence[float], *__: object
    ) -> list[Rehearsal]:
        sizes.append(float(np.abs(plan.positions - plan.positions[0]).max()))
        used = 1.6 if len(sizes) == 1 else 0.7 if len(sizes) == 2 else 0.99
        return [
            Rehearsal(each, sole_margin=0.04, standing_margin=0.05, friction=used * FRICTION)
            for each in factors
        ]

    with (
        patch.object(story, "best_motion", design_samples.gentle_motion),
        patch.object(story, "rehearse", rehearse),
    ):
        design_motion(hrp2.robot(), DesignSettings(500.0, duration=20.0, seed=1))
    larger = 0.85**0.5
    assert np.array(sizes) / sizes[0] == pytest.approx([1.0, 0.85, larger, larger], abs=0.01)


def test_a_motion_that_leaves_hardly_any_room_is_rehearsed_between_the_ends_as_it_is() -> None:
    played: list[list[float]] = []

    def rehearse(
        _: object, plan: Plan, told: object, factors: Sequence[float], *__: object
    ) -> list[Rehearsal]:
        played.append(list(factors))
        return [
            Rehearsal(each, sole_margin=0.05 - 0.97 * (0.05 - KEPT), standing_margin=0.05) for each in factors
        ]

    with (
        patch.object(story, "best_motion", design_samples.gentle_motion),
        patch.object(story, "rehearse", rehearse),
    ):
        design_motion(hrp2.robot(), DesignSettings(500.0, duration=20.0, seed=1))
    assert played == [[0.5, 2.0], pytest.approx([0.5**0.5, 1.0, 2**0.5, 2**0.75])]


def test_a_promise_is_the_widest_of_a_rehearsal_and_its_neighbours() -> None:
    found = design_samples.designed()
    factors = [one.factor for one in found.rehearsals]
    own = dict(zip(factors, [1.0, 2.0, 3.0, None, 1.5, 0.5], strict=True))
    with patch.object(Rehearsal, "percent", lambda one, *_: own[one.factor]):
        promised = found.half_widths("left", "roll", "stiffness")
    assert promised == dict(zip(factors, [2.0, 3.0, 3.0, None, 1.5, 1.5], strict=True))


def test_each_rehearsal_has_its_own_draw_of_the_sensors_and_a_floor_for_its_steps() -> None:
    """A floor is told by stiffness k and damping c: a contact that steps of h hold still has c·h of 1, and c² = 4k of
    one that swings no more."""
    seeds, worlds = list[int](), list[Physics]()

    def record(_: object, robot: object, world: Physics, preset: object, seed: int) -> Mock:
        worlds.append(world)
        seeds.append(seed)
        return Mock()

    with (
        patch.object(rehearsal, "roll_each", lambda played, _: [Mock() for _ in played]),
        patch.object(rehearsal, "record", record),
        patch.object(rehearsal, "_measured", lambda factor, *_: Rehearsal(factor)),
    ):
        rehearsal.rehearse(hrp2.robot(), Mock(), design_samples.told(), [0.5, 0.707])
        rehearsal.rehearse(hrp2.robot(), Mock(), design_samples.told(), [0.5])
    assert seeds == [500, 707, 500]
    stiffness, damping, _ = worlds[0].floor
    assert damping * worlds[0].timestep == pytest.approx(1.0)
    assert damping**2 == pytest.approx(4 * stiffness)
    assert worlds[0].timestep == 2 * Physics().timestep


@pytest.mark.parametrize("margin", [4e-4, 0.0, -2e-4, -1.0])
def test_a_centre_of_pressure_at_the_border_does_not_say_how_much_too_large(margin: float) -> None:
    """It never leaves a sole: how far beyond the limits a sole tips is not seen, so the step is the largest."""
    used, reason = story._used(Rehearsal(2.0, sole_margin=margin, standing_margin=0.05))
    assert used == np.inf
    assert "of a sole's border" in reason
    seen = story._used(Rehearsal(2.0, sole_margin=6e-4, standing_margin=0.05))[0]
    assert seen == pytest.approx((0.05 - 6e-4) / (0.05 - KEPT))
