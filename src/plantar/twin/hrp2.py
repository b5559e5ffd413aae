"""An HRP-2-like robot, written from its published facts.

No public model of HRP-2 gives its links' masses. Here every published fact is met (joints, limits, geometry,
mass, centre of mass and inertia at half-sitting, what the force sensor carries); what lies between them -
how the mass is shared among links, the boxes' sizes, torque and velocity limits - is chosen.
"""

from __future__ import annotations

import os
import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import yaml

from plantar.conventions import Array
from plantar.files import write_text
from plantar.motions.campaign import Postures
from plantar.robot import RobotModel, load_robot
from plantar.twin.description import Body, Description, Shape, box_inertia
from plantar.twin.urdf import urdf_text

NAME: Final = "hrp2_like"
MASS: Final = 56.87  # kg
HALF_SITTING_HEIGHT: Final = 0.648702  # waist above the ground [m]
CENTRE_OF_MASS: Final = (0.0136, 0.0015, 0.8077)  # half-sitting, over the middle of the feet [m]
INERTIA: Final = (8.16, 6.94, 1.73)  # half-sitting, about the centre of mass [kg·m²]
SOLE_SIZE: Final = (0.2172, 0.138)  # m
SOLE_HEIGHT: Final = -0.105  # below the ankle [m]
BUSH_HEIGHT: Final = -0.085  # below the ankle [m]
IMU_LINK: Final = "CHEST_LINK1"
IMU_XYZ: Final = (-0.13, 0.0, 0.118)

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

# joint axis, origin in the parent, limits, effort, velocity; mass, its box's centre and size. Right side;
# the left mirrors y, and the limits of yaw and roll.
LEG: Final = (
    (Z, (0, -0.06, 0), (-0.785, 0.524), 120, 4.0, 0.9, (0, -0.02, 0.02), (0.08, 0.07, 0.09)),
    (X, (0, -0.035, 0), (-0.611, 0.349), 200, 4.0, 1.6, (-0.01, 0, 0.0), (0.10, 0.09, 0.10)),
    (Y, (0, 0, 0), (-2.182, 0.733), 260, 4.5, 3.9, (0.0, 0, -0.15), (0.10, 0.10, 0.28)),
    (Y, (0, 0, -0.3), (-0.035, 2.618), 260, 5.5, 2.5, (0.0, 0, -0.14), (0.09, 0.09, 0.26)),
    (Y, (0, 0, -0.3), (-1.309, 0.733), 200, 5.0, 0.6, (0, 0, 0.0), (0.07, 0.08, 0.07)),
    (X, (0, 0, 0), (-0.349, 0.611), 150, 5.0, 1.6, (0.0, 0, -0.085), (SOLE_SIZE[0], SOLE_SIZE[1], 0.04)),
)
ARM: Final = (
    (Y, (0.0, -0.25, 0.18), (-3.142, 1.047), 90, 5.0, 1.2, (0, 0.03, 0), (0.10, 0.12, 0.10)),
    (X, (0, 0, 0), (-1.658, 0.175), 80, 5.0, 0.7, (0, 0, -0.02), (0.08, 0.08, 0.10)),
    (Z, (0, 0, 0), (-1.606, 1.606), 60, 6.0, 1.3, (0, 0, -0.16), (0.08, 0.08, 0.18)),
    (Y, (0, 0, -0.25), (-2.391, 0.035), 60, 6.0, 0.7, (0, 0, -0.04), (0.07, 0.07, 0.12)),
    (Z, (0, 0, 0), (-1.606, 1.606), 25, 6.0, 0.8, (0, 0, -0.16), (0.06, 0.06, 0.14)),
    (Y, (0, 0, -0.25), (-1.606, 1.606), 20, 6.0, 0.4, (0, 0, -0.04), (0.06, 0.05, 0.08)),
    (X, (0, 0, -0.08), (-1.0, 1.0), 10, 6.0, 0.2, (0, 0, -0.04), (0.06, 0.03, 0.08)),
)
TRUNK: Final = (
    ("CHEST_JOINT0", Z, (0.032, 0, 0.351), (-0.785, 0.785), 150, 3.0, 1.5, (0, 0, -0.06), (0.14, 0.16, 0.08)),
    ("CHEST_JOINT1", Y, (0, 0, 0), (-0.087, 1.047), 200, 3.0, 15.5, (-0.02, 0, 0.12), (0.18, 0.30, 0.32)),
    ("HEAD_JOINT0", Z, (-0.007, 0, 0.30), (-0.785, 0.785), 15, 5.0, 0.4, (0, 0, 0), (0.08, 0.08, 0.06)),
    ("HEAD_JOINT1", Y, (0, 0, 0), (-0.524, 0.785), 15, 5.0, 1.6, (0.02, 0, 0.08), (0.17, 0.15, 0.20)),
)
WAIST: Final = (7.5, (-0.02, 0, 0.10), (0.16, 0.26, 0.20))

HALF_SITTING_LEG: Final = (0.0, 0.0, -0.453786, 0.872665, -0.418879, 0.0)
HALF_SITTING_ARM: Final = (0.261799, -0.17453, 0.0, -0.523599, 0.0, 0.0, 0.1)


def half_sitting() -> dict[str, float]:
    """Joint positions of the half-sitting posture [rad]."""
    posture = {name: 0.0 for name, *_ in TRUNK}
    for side, mirror in (("R", 1.0), ("L", -1.0)):
        for place, angle in enumerate(HALF_SITTING_LEG):
            posture[f"{side}LEG_JOINT{place}"] = angle
        for place, angle in enumerate(HALF_SITTING_ARM):
            mirrored = ARM[place][0] != Y
            posture[f"{side}ARM_JOINT{place}"] = angle * (mirror if mirrored else 1.0)
    return posture


def postures() -> Postures:
    """Half-sitting, and the arm states D (aside) and E (forward) of the manual sways."""
    aside = {"RARM_JOINT0": 0.0, "LARM_JOINT0": 0.0, "RARM_JOINT1": -0.8, "LARM_JOINT1": 0.8}
    forward = {"RARM_JOINT0": -0.7, "LARM_JOINT0": -0.7, "RARM_JOINT3": -0.6, "LARM_JOINT3": -0.6}
    return Postures(half_sitting(), aside, forward)


def look(robot: RobotModel) -> Description | None:
    """The boxes of this robot, when it is this robot; None lets the twin draw rods."""
    ours = description()
    return ours if robot.name == NAME and set(robot.joint_names) == set(ours.joint_names) else None


@cache
def description() -> Description:
    """The robot, its mass spread so that the published totals are met to rounding."""
    nominal = _nominal()
    scale = _solve_masses(nominal)
    return _scaled(nominal, scale)


def _body(name: str, joint: str, parent: int, row: tuple[object, ...], mirror: bool) -> Body:
    axis, xyz, limits, effort, velocity, mass, centre, size = row
    flip = np.array([1.0, -1.0 if mirror else 1.0, 1.0])
    lower, upper = limits  # type: ignore[misc]
    if mirror and axis != Y:
        lower, upper = -upper, -lower
    box = np.array(size, dtype=float)
    com = np.array(centre, dtype=float) * flip
    return Body(
        name, parent, joint, "revolute", np.array(axis), np.array(xyz, dtype=float) * flip,
        lower=lower, upper=upper, velocity=float(velocity), effort=float(effort),  # type: ignore[arg-type]
        mass=float(mass), com=com, inertia=box_inertia(float(mass), box),  # type: ignore[arg-type]
        shapes=(Shape(com, box),),
    )  # fmt: skip


def _nominal() -> Description:
    """Geometry as published and a plausible first guess of the masses, right leg first."""
    mass, centre, size = WAIST
    com, box = np.array(centre), np.array(size)
    bodies = [
        Body("WAIST", -1, mass=mass, com=com, inertia=box_inertia(mass, box), shapes=(Shape(com, box),)),
    ]

    def add(prefix: str, rows: tuple[tuple[object, ...], ...], parent: int, mirror: bool) -> None:
        for place, row in enumerate(rows):
            link, joint = f"{prefix}_LINK{place}", f"{prefix}_JOINT{place}"
            bodies.append(_body(link, joint, parent, row, mirror))
            parent = len(bodies) - 1

    add("RLEG", LEG, 0, mirror=False)
    add("LLEG", LEG, 0, mirror=True)
    parent = 0
    for joint, *row in TRUNK:
        bodies.append(_body(joint.replace("JOINT", "LINK"), joint, parent, tuple(row), mirror=False))
        parent = len(bodies) - 1
    chest = next(place for place, body in enumerate(bodies) if body.name == IMU_LINK)
    add("RARM", ARM, chest, mirror=False)
    add("LARM", ARM, chest, mirror=True)
    return Description(NAME, tuple(bodies))


def _scaled(nominal: Description, change: Array) -> Description:
    """The nominal robot with link masses scaled and the trunk's centres moved.

    `change`: log factors of mass, one for each link with its mirror image, then of the chest's extent
    (3,), then shifts [0.1 m] of the chest's centre (3,).
    """
    keys = _symmetric_keys(nominal)
    factors = dict(zip(keys, np.exp(change[: len(keys)]), strict=True))
    growth, shift = np.exp(change[len(keys) : len(keys) + 3]), 0.1 * change[len(keys) + 3 :]
    bodies = []
    for body in nominal.bodies:
        mass = body.mass * factors[_key(body)]
        (box,) = body.shapes
        com, size = box.xyz, box.size
        if body.name == IMU_LINK:
            com, size = com + shift, size * growth
        bodies.append(replace(body, mass=mass, com=com, inertia=box_inertia(mass, size)))
    return replace(nominal, bodies=tuple(bodies))


def _key(body: Body) -> str:
    """One name for a link and its mirror image."""
    return body.name[1:] if body.name[1:].startswith(("LEG", "ARM")) else body.name


def _symmetric_keys(nominal: Description) -> list[str]:
    return list(dict.fromkeys(_key(body) for body in nominal.bodies))


def _solve_masses(nominal: Description) -> Array:
    """The smallest change of the nominal masses that meets the published totals (Gauss-Newton)."""
    positions = np.array([half_sitting()[name] for name in nominal.joint_names])
    ankle = nominal.placements(positions)[nominal.index("RLEG_LINK5")][1]
    # the published centre is over the middle of the feet, the description's over the waist
    goal = np.array(
        [MASS, CENTRE_OF_MASS[0] + ankle[0], CENTRE_OF_MASS[1], CENTRE_OF_MASS[2] - HALF_SITTING_HEIGHT, *INERTIA]
    )
    size = np.array([MASS, 0.1, 0.1, 0.1, *INERTIA])

    def residual(change: Array) -> Array:
        mass, centre, inertia = _scaled(nominal, change).mass_properties(positions)
        return (np.array([mass, *centre, *np.diag(inertia)]) - goal) / size

    change = np.zeros(len(_symmetric_keys(nominal)) + 6)
    for _ in range(20):
        error = residual(change)
        if np.abs(error).max() < 1e-10:
            break
        step = 1e-6
        slopes = np.column_stack([(residual(change + step * e) - error) / step for e in np.eye(change.size)])
        change = np.linalg.pinv(slopes) @ (slopes @ change - error)
    return change


def write(directory: str | os.PathLike[str]) -> Path:
    """Write `hrp2.urdf` and `robot.yaml` into a directory; returns the robot file's path."""
    directory = Path(directory)
    write_text(directory / "hrp2.urdf", urdf_text(description()))
    write_text(directory / "robot.yaml", yaml.safe_dump(_robot_file(), sort_keys=False, default_flow_style=None))
    return directory / "robot.yaml"


@cache
def robot() -> RobotModel:
    """The same robot as `load_robot` reads it from its own files."""
    with tempfile.TemporaryDirectory(prefix="plantar-") as directory:
        return load_robot(write(directory))


def _robot_file() -> dict[str, object]:
    x, y = SOLE_SIZE[0] / 2, SOLE_SIZE[1] / 2
    corners = [[x, y], [-x, y], [-x, -y], [x, -y]]
    return {
        "name": NAME,
        "urdf": "hrp2.urdf",
        "imu": {"name": "chest", "link": IMU_LINK, "xyz": list(IMU_XYZ)},
        "feet": {
            side: {
                "ankle": f"{side[0].upper()}LEG_LINK5",
                "bush": {"xyz": [0.0, 0.0, BUSH_HEIGHT]},
                "wrench": {"name": f"{side}_foot", "xyz": [0.0, 0.0, SOLE_HEIGHT]},
                "sole": {"xyz": [0.0, 0.0, SOLE_HEIGHT], "polygon": [list(corner) for corner in corners]},
            }
            for side in ("right", "left")
        },
    }
