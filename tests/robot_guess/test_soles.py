"""Soles that a URDF does not draw, and two feet of one robot that come out unlike."""

from __future__ import annotations

import numpy as np
import pytest

from example_robots import ROMEO, TALOS, model
from plantar.conventions import Array
from plantar.exporters.urdf.tree import UrdfTree
from plantar.robot_guess.biped import find_biped
from plantar.robot_guess.evidence import unlike_soles
from plantar.robot_guess.feet import LONGEST, Sole, box, find_sole


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
