"""Which foot stands, when, and why samples are left out."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from plantar.contact.phases import (
    AIR,
    DOUBLE,
    SINGLE,
    SUPPORTS,
    TRANSITION,
    FootContact,
    carried_weight,
    detect_contact,
    hoisted,
    joined,
    shaken,
    widened,
)
from plantar.contact.polygon import convex_hull, inside_distance
from plantar.contact.reasons import LeftOut, Reason

PERIOD = 0.01
WEIGHT = 600.0
AUTO = {"left": False, "right": False}


def stepping() -> dict[str, np.ndarray]:
    """10 s: both, then left alone (2 s to 4 s), both, then none (7 s to 8 s), both."""
    time = np.arange(1000) * PERIOD
    right = np.where((time >= 2) & (time < 4), 0.0, 300.0)
    left = np.where((time >= 2) & (time < 4), 600.0, 300.0)
    air = (time >= 7) & (time < 8)
    return {"left": np.where(air, 0.0, left), "right": np.where(air, 0.0, right)}


def support(contact: FootContact, second: float) -> str:
    return SUPPORTS[contact.support[round(second / PERIOD)]]


def reason(contact: FootContact, second: float) -> str | None:
    code = contact.code[round(second / PERIOD)]
    return contact.reasons[code - 1].text if code else None


def test_double_single_air() -> None:
    contacts = detect_contact(stepping(), AUTO, WEIGHT, PERIOD)
    left, right = contacts["left"], contacts["right"]
    for second, expected in (
        (1.0, (DOUBLE, DOUBLE)),
        (3.0, (SINGLE, AIR)),
        (5.5, (DOUBLE, DOUBLE)),
        (7.5, (AIR, AIR)),
    ):
        assert (support(left, second), support(right, second)) == expected
    assert left.used[300]
    assert not right.used[300]
    assert "air" in str(reason(right, 3.0))
    assert reason(left, 3.0) is None
    assert not left.standing[750]


def test_landing_and_lifting_are_left_out() -> None:
    right = detect_contact(stepping(), AUTO, WEIGHT, PERIOD)["right"]
    for second in (1.85, 1.95, 4.02, 4.20):
        assert support(right, second) == TRANSITION
        assert "landing or lifting" in str(reason(right, second))
    assert reason(right, 1.7) is None
    assert reason(right, 4.3) is None
    assert "air" in str(reason(right, 2.1)), "the first reason stays"


def test_the_other_foots_steps_do_not_interrupt_a_stance() -> None:
    left = detect_contact(stepping(), AUTO, WEIGHT, PERIOD)["left"]
    assert left.used[100:600].all()


def test_between_the_thresholds_a_foot_keeps_its_state() -> None:
    time = np.arange(1000) * PERIOD
    # 7.5 % of the weight from 3 s to 5 s.
    load = np.interp(time, [0, 2, 3, 5, 6, 10], [300, 300, 45, 45, 300, 300])
    stays = detect_contact({"left": load}, {"left": False}, WEIGHT, PERIOD)["left"]
    assert stays.standing.all()
    airborne = np.where(time < 3, 0.0, load)
    waits = detect_contact({"left": airborne}, {"left": False}, WEIGHT, PERIOD)["left"]
    assert not waits.standing[:500].any()
    assert waits.standing[-1]


def test_a_touch_too_short_to_be_a_stance_is_air() -> None:
    load = np.zeros(1000)
    load[500:540] = 400.0
    touch = detect_contact({"left": load}, {"left": False}, WEIGHT, PERIOD)["left"]
    assert (touch.support == SUPPORTS.index(AIR)).all()


def test_always_means_always() -> None:
    force = {"left": np.zeros(500), "right": np.zeros(500)}
    contacts = detect_contact(force, {"left": True, "right": False}, WEIGHT, PERIOD)
    assert contacts["left"].used.all()
    assert (contacts["left"].support == SUPPORTS.index(SINGLE)).all()
    assert not contacts["right"].used.any()


@pytest.mark.parametrize(("first", "stands"), [(WEIGHT, True), (0.0, False)])
def test_a_log_that_begins_unread_begins_as_its_first_value_has_it(first: float, stands: bool) -> None:
    """As one does whose sensors were read too early, and are put right."""
    load = np.full(1000, first)
    load[:3] = np.nan
    contact = detect_contact({"left": load}, {"left": False}, WEIGHT, PERIOD)["left"]
    assert contact.loaded.all() == stands
    assert list(contact.used) == [False] * 3 + [stands] * 997


def test_a_force_that_is_not_recorded_is_no_lifted_foot() -> None:
    load = np.full(1000, 300.0)
    load[400:600] = np.nan
    contact = detect_contact({"left": load}, {"left": False}, WEIGHT, PERIOD)["left"]
    np.testing.assert_array_equal(contact.used, np.isfinite(load))
    assert contact.standing.all()
    assert "not recorded" in str(reason(contact, 5.0))
    nothing = detect_contact({"left": np.full(1000, np.nan)}, {"left": False}, WEIGHT, PERIOD)["left"]
    assert not nothing.used.any()
    assert not nothing.standing.any()


def test_phases_tell_the_log_from_end_to_end() -> None:
    time = np.arange(1000) * PERIOD
    contact = detect_contact(stepping(), AUTO, WEIGHT, PERIOD)["right"]
    phases = contact.phases("walk", "right", time)
    assert phases[0].start == 0.0
    assert phases[-1].end == pytest.approx(9.99)
    for one, following in pairwise(phases):
        assert one.end == pytest.approx(following.start)
        assert (one.support, one.reason) != (following.support, following.reason)
    assert all(phase.used == (phase.reason is None) for phase in phases)
    assert phases[0].to_dict() == {
        "motion": "walk", "foot": "right", "start": 0.0, "end": 1.8, "support": DOUBLE, "used": True, "reason": None,
    }  # fmt: skip


@pytest.mark.parametrize("axis", [0, 2])
def test_an_impact_is_left_out_until_it_has_settled(axis: int) -> None:
    """2 s of a ringing force in one direction; a noisy sensor alone is no impact, nor is a slow sway."""
    time = np.arange(4000) * 0.005
    random = np.random.default_rng(0)
    force = random.normal(0, 1.0, (time.size, 3)) + [0, 0, 300]
    force[:, axis] += 100 * np.sin(2 * np.pi * 0.5 * time)
    assert not shaken(force, WEIGHT, 0.005).any()
    assert not shaken(20 * force, WEIGHT, 0.005).any(), "a noise that is always there is the sensor's"
    rings = (time > 8) & (time < 10)
    force[rings, axis] += random.normal(0, 60, rings.sum())
    struck = shaken(force, WEIGHT, 0.005)
    assert struck[rings].all()
    assert struck[(time > 10) & (time < 10.2)].all(), "settling"
    assert not struck[(time < 7.8) | (time > 10.4)].any()


def test_what_shakes_for_most_of_a_log_is_still_shaken() -> None:
    """The sensor's noise is what the calmest tenth of the log shows."""
    random, time = np.random.default_rng(3), np.arange(4000) * 0.005
    force = np.zeros((len(time), 3))
    force[:, 2] = WEIGHT
    rings = time > 7.0
    force[:, 0] += random.normal(0, np.where(rings, 60.0, 0.5))
    struck = shaken(force, WEIGHT, 0.005)
    assert struck[time > 7.2].all()
    assert not struck[time < 6.8].any()


@pytest.mark.parametrize(("share", "held"), [(-0.25, True), (0.25, True), (-0.08, False)])
def test_a_rope_that_carries_a_part_for_a_while_is_told(share: float, held: bool) -> None:
    """5 s of 30; the squats beside move the load by as much, and quickly."""
    time = np.arange(6000) * 0.005
    load = WEIGHT * (1 + 0.15 * np.sin(2 * np.pi * 0.7 * time) + share * ((time > 12) & (time < 17)))
    load[:100] = np.nan
    found = hoisted(load, WEIGHT, 0.005)
    assert found[(time > 12.5) & (time < 16.5)].all() == held
    assert not found[(time < 10) | (time > 19)].any()
    assert not hoisted(load * np.nan, WEIGHT, 0.005).any()


def test_a_step_at_a_logs_end_is_no_rope() -> None:
    """There a mean is one of half as long a time, and half of that again."""
    time = np.arange(6000) * 0.005
    load = WEIGHT * (1 - 0.3 * (time < 0.8))
    assert not hoisted(load, WEIGHT, 0.005).any()
    assert hoisted(WEIGHT * (1 - 0.3 * (time < 5)), WEIGHT, 0.005).any()


def test_stretches_are_widened_and_joined() -> None:
    mask = np.zeros(20, dtype=bool)
    mask[[5, 9]] = True
    assert np.flatnonzero(widened(mask, 1)).tolist() == [4, 5, 6, 8, 9, 10]
    assert np.flatnonzero(widened(mask, 0, 2)).tolist() == [5, 6, 7, 9, 10, 11]
    assert np.flatnonzero(joined(mask, 3)).tolist() == [5, 6, 7, 8, 9]
    assert np.flatnonzero(joined(mask, 2)).tolist() == [5, 9]
    ends = np.isin(np.arange(20), [1, 19])
    assert np.flatnonzero(widened(ends, 2)).tolist() == [0, 1, 2, 3, 17, 18, 19]


def test_a_phase_ends_where_support_or_reason_changes() -> None:
    support = np.array([0, 0, 1, 1, 1, 1], dtype=np.int8)
    code = np.array([0, 0, 0, 0, 1, 1], dtype=np.int8)
    contact = FootContact(support, code, (LeftOut(Reason.SETTLING, detail=""),))
    found = contact.phases("m", "left", np.arange(6) * 0.5)
    assert [(one.start, one.end, one.support, one.used) for one in found] == [
        (0.0, 1.0, SUPPORTS[0], True),
        (1.0, 2.0, SUPPORTS[1], True),
        (2.0, 2.5, SUPPORTS[1], False),
    ]


def test_the_weight_that_the_feet_carry() -> None:
    assert carried_weight(stepping()) == 600.0
    assert carried_weight({"left": np.full(5, np.nan)}) == 0.0


SQUARE = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])


@pytest.mark.parametrize("corners", [SQUARE, SQUARE[::-1], SQUARE[[1, 3, 0, 2]]])
def test_distance_to_the_edge_of_a_sole(corners: np.ndarray) -> None:
    points = np.array(
        [[0.0, 0.0], [0.09, 0.0], [0.0, -0.048], [0.1, 0.0], [0.12, 0.0], [0.0, 0.06], [0.2, 0.2]]
    )
    expected = [0.05, 0.01, 0.002, 0.0, -0.02, -0.01, -0.15]
    np.testing.assert_allclose(inside_distance(points, corners), expected, atol=1e-12)


def test_distance_agrees_with_sampling_the_border() -> None:
    random = np.random.default_rng(5)
    corners = convex_hull(random.normal(size=(9, 2)))
    points = random.uniform(-1, 1, size=(200, 2))
    border = np.concatenate(
        [
            a + np.linspace(0, 1, 4000)[:, None] * (b - a)
            for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)
        ]
    )
    nearest = np.min(np.linalg.norm(points[:, None] - border, axis=2), axis=1)
    found = inside_distance(points, corners)
    inside = found > 0
    assert inside.any()
    assert (~inside).any()
    np.testing.assert_allclose(found[inside], nearest[inside], atol=1e-3)
    assert (-found[~inside] <= nearest[~inside] + 1e-3).all()


def test_nan_points_have_no_distance() -> None:
    assert np.isnan(inside_distance(np.array([[np.nan, 0.0]]), SQUARE)).all()


def test_the_hull_leaves_out_what_is_inside() -> None:
    assert len(convex_hull(np.vstack([SQUARE, [[0.0, 0.0]]]))) == 4
    line = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])
    np.testing.assert_array_equal(convex_hull(line), line)
