"""A foot cut at its bush: both parts together are the link that was cut, in mass, centre and inertia."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from biped_robot import Frame, Mounting, make_robot
from plantar.conventions import Array
from plantar.twin.robots.description import Description
from plantar.twin.robots.foot import cut_feet, place_of
from plantar.twin.robots.from_robot import describe

BUSH = Mounting(bush=Frame((0.01, -0.02, -0.06), (0.0, 0.1, 0.3)))
SIZE = np.array([0.26, 0.16])  # m: of the sole


def box(mass: float, size: Array) -> Array:
    """Moments of inertia of a box about its middle."""
    squares = np.square(size)
    return np.asarray(mass / 12 * (squares.sum() - squares))


def test_sole_and_ankle_are_the_whole_link(tmp_path: Path) -> None:
    robot = make_robot(tmp_path, BUSH)
    description = describe(robot)
    for name, cut in cut_feet(description, robot).items():
        whole = description.bodies[cut.place]
        assert whole.name.startswith(name)
        turn, centre = cut.bush[:3, :3], cut.bush[:3, 3]
        np.testing.assert_allclose(centre, BUSH.bush.xyz)
        np.testing.assert_allclose(turn, BUSH.bush.rotation, atol=1e-12)
        assert cut.mass + cut.ankle.mass == pytest.approx(whole.mass)
        assert cut.mass == pytest.approx(0.65 * whole.mass)
        parts = pin.Inertia(cut.mass, centre, turn @ np.diag(cut.inertia) @ turn.T)
        parts += pin.Inertia(cut.ankle.mass, cut.ankle.com, cut.ankle.inertia)
        np.testing.assert_allclose(parts.lever, whole.com, atol=1e-12)
        np.testing.assert_allclose(parts.inertia, whole.inertia, atol=1e-12)
        np.testing.assert_allclose(cut.inertia, box(cut.mass, np.array([*SIZE, 0.02])), rtol=1e-9)
        corners = np.column_stack([cut.corners, np.ones(4)]) @ cut.bush.T
        np.testing.assert_allclose(corners[:, :2], robot.feet[name].sole.polygon, atol=1e-12)
        np.testing.assert_allclose(corners[:, 2], -0.09, atol=1e-12)
        np.testing.assert_allclose(cut.sensor[:3, 3], BUSH.wrench.xyz)


def test_a_link_that_leaves_no_ankle_keeps_its_mass_and_gets_a_sole_of_a_thousandth(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    description = describe(robot)
    place, _ = place_of(description, robot, robot.feet["left"].bush)
    needle = replace(description.bodies[place], inertia=np.diag([1.0, 1.0, 1e-12]))
    bodies = tuple(needle if i == place else body for i, body in enumerate(description.bodies))
    cut = cut_feet(replace_bodies(description, bodies), robot)["left"]
    assert cut.ankle is needle
    assert cut.mass == pytest.approx(1e-3 * needle.mass)
    whole = cut_feet(description, robot)["left"]
    np.testing.assert_allclose(cut.inertia / cut.mass, whole.inertia / whole.mass)


def replace_bodies(description: Description, bodies: tuple[object, ...]) -> Description:
    return replace(description, bodies=bodies)  # type: ignore[arg-type]
