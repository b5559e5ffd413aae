"""Edges that a zero of the torque moves inwards: told by an opposite edge passed, and by a torque that stops."""

from __future__ import annotations

import numpy as np
import pytest

from made_recording import FOOT, LOAD, PERIOD, made_recording
from plantar.contact.phases import AIR, SUPPORTS
from plantar.contact.polygon import edge_distances
from plantar.contact.stances import Stances
from plantar.feet.exclusion.moved_edges import _stopped_near, moved_inwards

COUNT = 3000
TIME = PERIOD * np.arange(COUNT)
SOLE = np.array([[0.03, 0.08], [-0.03, 0.08], [-0.03, -0.08], [0.03, -0.08]])
FRONT, BACK = (int(np.argmin(edge_distances(np.array([[x, 0.0]]), SOLE))) for x in (0.03, -0.03))
STIFFNESS = 400.0
SWAY = np.sin(2 * np.pi * 0.25 * TIME)


def moved(
    cop_x: np.ndarray,
    angle: np.ndarray | None = None,
    torque: np.ndarray | None = None,
    stances: Stances | None = None,
) -> np.ndarray:
    """Of each edge [m], by a centre of pressure (N,) [m]; a torque that is not given grows with the angle."""
    angle = 0.02 * SWAY if angle is None else angle
    recording = made_recording(
        "sway", angle, STIFFNESS * angle if torque is None else torque, stances=stances
    )
    depth = edge_distances(np.column_stack([cop_x, np.zeros(COUNT)]), SOLE)
    return moved_inwards(recording, FOOT, depth, SOLE)


def test_an_edge_is_moved_as_far_as_the_centre_of_pressure_passes_the_opposite_one() -> None:
    found = moved(0.01 + 0.027 * SWAY)
    assert found[:, BACK] == pytest.approx(0.007, rel=0.02)
    assert not np.delete(found, BACK, axis=1).any()


@pytest.mark.parametrize("cop_x", [0.029 * SWAY, 0.037 * SWAY, 0.02 * SWAY + 0.02 * (TIME == 5.0)])
def test_without_a_zero_that_shows_no_edge_is_moved(cop_x: np.ndarray) -> None:
    """A sole that is never passed; one that is larger than its outline, passed on both sides; and a shock."""
    assert not moved(cop_x).any()


@pytest.mark.parametrize(("samples", "is_moved"), [(3, False), (4, True)])
def test_forty_milliseconds_beyond_an_edge_move_the_opposite_one(samples: int, is_moved: bool) -> None:
    found = moved(np.where(np.arange(COUNT) < samples, 0.037, 0.02 * SWAY))
    assert found[:, BACK].any() == is_moved
    assert not np.delete(found, BACK, axis=1).any()


@pytest.mark.parametrize(("side", "edge"), [(1.0, FRONT), (-1.0, BACK)])
def test_where_the_torque_stops_while_the_foot_turns_on_is_an_edge(side: float, edge: int) -> None:
    angle = side * (0.015 + 0.03 * SWAY)
    torque = side * np.minimum(side * STIFFNESS * angle, 6.0)
    found = moved(torque / LOAD, angle, torque)
    assert found[:, edge] == pytest.approx(0.01, rel=1e-6)
    assert not np.delete(found, edge, axis=1).any()


def test_an_edge_that_stops_the_torque_on_both_sides_lies_where_it_stops_first() -> None:
    """The centre of pressure rests near one edge whichever way the foot turns on: 10 mm inside, and 4 mm."""
    angle = 0.04 * SWAY
    torque = np.clip(STIFFNESS * angle, -6.0, 6.0)
    inside = np.where(angle > 0, 0.020, 0.026)
    found = moved(np.where(np.abs(STIFFNESS * angle) < 6.0, torque / LOAD, inside), angle, torque)
    assert found[:, FRONT] == pytest.approx(0.01, rel=1e-6)


def test_a_torque_that_stops_only_on_the_way_out_is_friction() -> None:
    angle = 0.03 * SWAY
    torque = np.clip(STIFFNESS * angle, -6.0, 6.0) + 3.0 * np.sign(np.cos(2 * np.pi * 0.25 * TIME))
    assert not moved(torque / LOAD, angle, torque).any()


@pytest.mark.parametrize(("share", "is_edge"), [(0.0, True), (0.15, True), (0.35, False)])
def test_over_an_edge_the_torque_hardly_grows(share: float, is_edge: bool) -> None:
    """A quarter of the usual slope, which is the spread of the torque over that of the angle."""
    angle = 0.03 * SWAY
    bend = 0.012
    usual = (bend + 0.03) * STIFFNESS / 0.06
    slope = share * usual
    torque = np.where(angle > bend, STIFFNESS * bend + slope * (angle - bend), STIFFNESS * angle)
    assert moved(0.5 * torque / LOAD, angle, torque)[:, FRONT].any() == is_edge


STEPS = Stances(np.arange(COUNT) // 300, np.ones(COUNT))


@pytest.mark.parametrize(
    ("inside", "is_moved"), [(0.002, True), (0.0085, True), (0.0095, False), (0.02, False)]
)
def test_the_edge_of_a_foot_that_steps_is_where_its_centre_of_pressure_stops(
    inside: float, is_moved: bool
) -> None:
    """Three tenths of half of 6 cm at most: nearer to the middle the centre of pressure only turns back."""
    cop_x = np.minimum(0.01 + 0.029 * SWAY, 0.03 - inside)
    found = moved(cop_x, stances=STEPS)
    assert found[:, FRONT] == pytest.approx(inside if is_moved else 0.0)
    assert not np.delete(found, FRONT, axis=1).any()
    assert not moved(cop_x).any(), "a foot that stands may lean there and be flat"
    recording = made_recording("sway", 0.02 * SWAY, STIFFNESS * 0.02 * SWAY, stances=STEPS)
    recording.contacts[FOOT].support[cop_x > 0.0] = SUPPORTS.index(AIR)
    depth = edge_distances(np.column_stack([cop_x, np.zeros(COUNT)]), SOLE)
    assert not moved_inwards(recording, FOOT, depth, SOLE).any(), "a foot in the air stops nowhere"


def test_the_edge_of_a_wide_sole_is_a_centimetre_from_its_place_at_most() -> None:
    depth = np.tile([0.05, 0.0099, 0.0101, 0.05], (100, 1))
    depth[:50] += 0.01
    wide = 3 * SOLE
    assert _stopped_near(depth, wide, 50) == pytest.approx([0.0, 0.0099, 0.0, 0.0])
    assert not _stopped_near(depth, wide, 51).any(), "a few samples less are a shock"
    depth[40] = np.nan
    assert _stopped_near(depth, wide, 50)[1] == pytest.approx(0.0099), "unknown samples tell nothing"
    assert not _stopped_near(depth[:9], wide, 10).any()


@pytest.mark.parametrize(("middle", "swing", "expected"), [(0.005, 0.029, 0.006), (0.01, 0.027, 0.007)])
def test_an_edge_of_steps_is_moved_by_what_moves_it_more(
    middle: float, swing: float, expected: float
) -> None:
    """4 mm beyond the edge opposite and a stop at 6 mm; 7 mm beyond, and nothing that comes near."""
    found = moved(middle + swing * SWAY, stances=STEPS)
    assert found[:, BACK] == pytest.approx(expected, rel=0.02)
    assert not found[:, FRONT].any()
