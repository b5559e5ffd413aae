"""Soles that a URDF does not draw, and two feet of one robot that come out unlike."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from example_robots import ROMEO, TALOS, model
from plantar.conventions import Array
from plantar.exporters.urdf.tree import UrdfTree
from plantar.robot_guess.biped import Limb, find_biped
from plantar.robot_guess.evidence import unlike_soles
from plantar.robot_guess.feet import LONGEST, Sole, _by_inertia, box, find_sole


@pytest.fixture
def soles() -> list[Sole]:
    """Left and right of TALOS, as its shapes draw them."""
    tree, robot = UrdfTree.load(TALOS), model(TALOS)
    biped = find_biped(tree, robot)
    return [find_sole(tree, robot, biped, leg) for leg in biped.legs]


def with_outline(sole: Sole, corners: Array) -> Sole:
    return Sole(**{**vars(sole), "corners": corners})


def test_feet_that_are_unlike_are_a_doubt(soles: list[Sole]) -> None:
    left, right = (
        with_outline(sole, box(-0.1, 0.1, *side))
        for sole, side in zip(soles, ((-0.05, 0.07), (-0.07, 0.05)), strict=True)
    )
    assert unlike_soles([left, right]) == [], "mirrored they are alike"
    (doubt,) = unlike_soles([left, with_outline(right, box(-0.1, 0.116, -0.07, 0.05))])
    assert doubt.doubt
    assert "differ by 16 mm" in doubt.text
    assert len(unlike_soles([left, with_outline(right, left.corners)])) == 1, "the same, not mirrored"


def test_an_inertia_that_no_foot_has_draws_no_outline() -> None:
    """The moments of inertia of this URDF are those of a box of half a metre."""
    tree, robot = UrdfTree.load(ROMEO), model(ROMEO)
    for link in tree.links.values():
        for shape in [*link.findall("collision"), *link.findall("visual")]:
            link.remove(shape)
    biped = find_biped(tree, robot)
    for leg in biped.legs:
        found = find_sole(tree, robot, biped, leg)
        assert np.ptp(found.corners[:, 0]) < LONGEST * biped.reach
        assert "size of a usual foot" in found.reason
        assert not found.drawn
        reach = biped.reach
        outline = [[0.15, 0.065], [-0.1, 0.065], [-0.1, -0.065], [0.15, -0.065]]
        np.testing.assert_allclose(found.corners, reach * np.array(outline))
        assert found.outline_spread == pytest.approx(0.2 * 0.25 * reach), "a fifth of its length"


def by_inertia(
    length: float, centre: float, mass: float = 1.5
) -> tuple[float, float, np.ndarray, str] | None:
    """What is found of a box 0.1 m wide and 0.06 m high, its centre 30 mm ahead, under a leg of 0.8 m."""
    body = pin.Inertia.FromBox(1.5, length, 0.1, 0.06)
    inertia = pin.Inertia(mass, np.array([0.03, 0.0, centre]), np.array(body.inertia))
    robot = pin.Model()
    ankle = robot.addJoint(0, pin.JointModelRX(), pin.SE3.Identity(), "ankle")
    robot.appendBodyToJoint(ankle, inertia, pin.SE3.Identity())
    limb = Limb("foot", ("ankle",), np.zeros(3), np.eye(3), "left")
    return _by_inertia(robot, limb, np.eye(3), 0.8)


def test_a_foot_that_is_a_solid_box_is_as_much_larger_as_those_of_known_robots() -> None:
    """1.2 times as long, 1.35 times as wide, and its sole twice as deep as its centre of mass."""
    found = by_inertia(0.2, -0.05)
    assert found is not None
    depth, spread, corners, _ = found
    assert depth == pytest.approx(-0.1)
    assert spread == pytest.approx(0.025)
    assert np.ptp(corners, axis=0) == pytest.approx([1.2 * 0.2, 1.35 * 0.1])
    assert corners.mean(axis=0) == pytest.approx([0.03, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    ("length", "centre", "foot"),
    [
        (0.29, -0.05, True), (0.31, -0.05, False),  # with 1.2 of it, up to 0.45 of the leg
        (0.2, -0.009, True), (0.2, -0.007, False), (0.2, -0.099, True), (0.2, -0.101, False),  # 2 to 25 % deep
    ],
)  # fmt: skip
def test_a_box_that_is_no_foot_is_none(length: float, centre: float, foot: bool) -> None:
    assert (by_inertia(length, centre) is not None) == foot
