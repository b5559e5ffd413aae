"""Edges that a zero of the torque moves inwards: told by an opposite edge passed, and by a torque that stops."""

from __future__ import annotations

import numpy as np
import pytest

from made_recording import FOOT, LOAD, PERIOD, made_recording
from plantar.contact.polygon import edge_distances
from plantar.feet.exclusion.moved_edges import moved_inwards

COUNT = 3000
TIME = PERIOD * np.arange(COUNT)
SOLE = np.array([[0.03, 0.08], [-0.03, 0.08], [-0.03, -0.08], [0.03, -0.08]])
FRONT, BACK = (int(np.argmin(edge_distances(np.array([[x, 0.0]]), SOLE))) for x in (0.03, -0.03))
STIFFNESS = 400.0
SWAY = np.sin(2 * np.pi * 0.25 * TIME)


def moved(cop_x: np.ndarray, angle: np.ndarray | None = None, torque: np.ndarray | None = None) -> np.ndarray:
    """Of each edge [m], by a centre of pressure (N,) [m]; a torque that is not given grows with the angle."""
    angle = 0.02 * SWAY if angle is None else angle
    recording = made_recording("sway", angle, STIFFNESS * angle if torque is None else torque)
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
