"""Where the bush cuts a foot in two: what stays with the ankle, what moves with the sole."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.robot.model import Foot, Placement, RobotModel
from plantar.twin.robots.description import Body, Description, box_inertia

SOLE_SHARE: Final = 0.65  # of the last link's mass hangs below the force sensor, less where that cannot be
SOLE_THICKNESS: Final = 0.02  # m, for its inertia


@dataclass(frozen=True)
class CutFoot:
    """One foot cut at the bush.

    `ankle`: the body above the bush with the sole's mass taken off, at `place` in the description; `bush`,
    `sensor`: poses (4, 4) in that body's frame; `corners`: the sole's outline in the bush's frame, (n, 3) [m];
    `mass` [kg] and `inertia` (3,) [kg·m²] of the sole about the bush centre, where its centre of mass is.
    The robot file's bush centre is where it stands when nothing presses on it; a load moves it up.
    """

    name: str
    place: int
    ankle: Body
    bush: Array
    sensor: Array
    sole: Array
    corners: Array
    mass: float
    inertia: Array


def cut_feet(description: Description, robot: RobotModel) -> dict[str, CutFoot]:
    """Every foot of the robot, cut at its bush."""
    return {name: _cut(description, robot, foot) for name, foot in robot.feet.items()}


def place_of(description: Description, robot: RobotModel, placement: Placement) -> tuple[int, Array]:
    """The body that carries a placement, and the placement's pose (4, 4) in that body's frame."""
    joint, pose = robot.frame(placement)
    place = 0 if joint == 0 else 1 + description.joint_names.index(robot.model.names[joint])
    return place, np.array(pose.homogeneous)


def _cut(description: Description, robot: RobotModel, foot: Foot) -> CutFoot:
    place, bush = place_of(description, robot, foot.bush)
    sensor = place_of(description, robot, foot.wrench.placement)[1]
    sole = place_of(description, robot, foot.sole.placement)[1]
    flat = np.column_stack(
        [foot.sole.polygon, np.zeros(len(foot.sole.polygon)), np.ones(len(foot.sole.polygon))]
    )
    corners = (np.linalg.inv(bush) @ sole @ flat.T).T[:, :3]
    size = np.array([*np.ptp(foot.sole.polygon, axis=0), SOLE_THICKNESS])
    ankle, mass, inertia = _split(description.bodies[place], bush, size)
    return CutFoot(foot.name, place, ankle, bush, sensor, sole, corners, mass, inertia)


def _split(whole: Body, bush: Array, size: Array) -> tuple[Body, float, Array]:
    """The ankle without the sole, the sole's mass and its inertia: together they are the whole link.

    The sole's centre of mass is put into the bush centre, so that its weight never turns it. The share is halved
    until what remains of the ankle is a body that can exist.
    """
    share = SOLE_SHARE
    for _ in range(12):
        mass = share * whole.mass
        inertia = box_inertia(mass, size)
        total = pin.Inertia(whole.mass, whole.com, whole.inertia)
        rotated = bush[:3, :3] @ inertia @ bush[:3, :3].T
        sole = pin.Inertia(mass, bush[:3, 3], rotated)
        rest = pin.Inertia.FromDynamicParameters(total.toDynamicParameters() - sole.toDynamicParameters())
        principal = np.linalg.eigvalsh(rest.inertia)
        if principal[0] > 0 and principal[0] + principal[1] > principal[2]:
            com, remaining = np.array(rest.lever), np.array(rest.inertia)
            return replace(whole, mass=float(rest.mass), com=com, inertia=remaining), mass, np.diag(inertia)
        share /= 2
    return whole, 1e-3 * whole.mass, np.diag(box_inertia(1e-3 * whole.mass, size))
