"""Edges of soles that are longer than wide, by hand."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from plantar.conventions import rotation_from_rpy
from plantar.design.soles import EDGE, SMALLER_EDGE, edges, ends, margin_kept, outward


def sole(back: float, front: float, side: float) -> np.ndarray:
    return np.array([[front, side], [-back, side], [-back, -side], [front, -side]])


@pytest.mark.parametrize("turned", [False, True])
def test_a_narrow_sole_keeps_a_share_of_its_half_width(turned: bool) -> None:
    """Whether it is longer than wide or wider than long."""
    narrow, wide = sole(0.1, 0.14, 0.01), sole(0.1, 0.14, 0.06)
    if turned:
        narrow, wide = narrow[:, ::-1], wide[:, ::-1]
    assert margin_kept(narrow) == pytest.approx(SMALLER_EDGE * 0.01)
    assert margin_kept(wide) == EDGE


def test_the_room_below_a_bush_is_to_each_edge_of_a_sole_that_is_turned() -> None:
    """The ankle's bush 3 cm ahead of the sole's middle and 1 cm to its left; the whole foot turned to the left."""
    yaw = pin.SE3(rotation_from_rpy(np.array([0.0, 0.0, 0.5])), np.array([0.4, -0.3, 0.0]))
    bush = yaw * pin.SE3(np.eye(3), np.array([0.03, 0.01, 0.08]))
    foot = SimpleNamespace(sole=SimpleNamespace(polygon=sole(0.1, 0.1, 0.05)))
    legs = SimpleNamespace(
        body=SimpleNamespace(robot=SimpleNamespace(feet={"left": foot})),
        start=SimpleNamespace(soles={"left": yaw}),
        rest=(None, None, {"left": bush}),
    )
    normals, room = edges(legs, "left")  # type: ignore[arg-type]
    found = {
        tuple(np.round(yaw.rotation[:2, :2].T @ normal, 9) + 0.0): left
        for normal, left in zip(normals, room, strict=True)
    }
    assert found == pytest.approx(
        {(-1.0, 0.0): 0.07 - EDGE, (1.0, 0.0): 0.13 - EDGE, (0.0, -1.0): 0.04 - EDGE, (0.0, 1.0): 0.06 - EDGE}
    )


def test_ends_are_the_edges_across_the_foot() -> None:
    assert ends(np.array([[1.0, 0.1], [0.1, -1.0], [-0.9, 0.5]])).tolist() == [True, False, True]


def test_toes_are_pressed_by_a_torque_that_turns_them_down() -> None:
    """The centre of pressure is ahead by -pitch torque over the load, and to the left by the roll torque over it."""
    inward = np.array([[-1.0, 0.0], [0.0, 1.0], [0.6, 0.8]])  # of the front, of the right side, of one askew
    torque = np.array([[-4.0, 1.0], [3.0, 0.0]])  # pitch and roll at two times
    assert outward(inward, torque) == pytest.approx(np.array([[4.0, -1.0], [-3.0, 0.0], [-2.4 - 2.4, 0.6]]))
