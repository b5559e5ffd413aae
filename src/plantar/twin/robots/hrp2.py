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

import numpy as np
import yaml

from plantar.conventions import Array
from plantar.files import write_text
from plantar.robot.model import RobotModel, load_robot
from plantar.twin.robots import hrp2_facts as facts
from plantar.twin.robots.description import Body, Description, Shape, box_inertia
from plantar.twin.robots.hrp2_facts import NAME, Row, Y, half_sitting, postures
from plantar.twin.robots.urdf import urdf_text

__all__ = ["NAME", "description", "half_sitting", "look", "postures", "robot", "write"]


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


def _body(name: str, joint: str, parent: int, row: Row, mirror: bool) -> Body:
    flip = np.array([1.0, -1.0 if mirror else 1.0, 1.0])
    lower, upper = row.limits
    if mirror and row.axis != Y:
        lower, upper = -upper, -lower
    box, com = np.array(row.size), np.array(row.centre) * flip
    return Body(
        name, parent, joint, "revolute", np.array(row.axis), np.array(row.xyz) * flip,
        lower=lower, upper=upper, velocity=row.velocity, effort=row.effort,
        mass=row.mass, com=com, inertia=box_inertia(row.mass, box), shapes=(Shape(com, box),),
    )  # fmt: skip


def _nominal() -> Description:
    """Geometry as published and a plausible first guess of the masses, right leg first."""
    mass, centre, size = facts.WAIST
    com, box = np.array(centre), np.array(size)
    bodies = [
        Body("WAIST", -1, mass=mass, com=com, inertia=box_inertia(mass, box), shapes=(Shape(com, box),)),
    ]

    def add(prefix: str, rows: tuple[Row, ...], parent: int, mirror: bool) -> None:
        for place, row in enumerate(rows):
            link, joint = f"{prefix}_LINK{place}", f"{prefix}_JOINT{place}"
            bodies.append(_body(link, joint, parent, row, mirror))
            parent = len(bodies) - 1

    add("RLEG", facts.LEG, 0, mirror=False)
    add("LLEG", facts.LEG, 0, mirror=True)
    parent = 0
    for joint, row in facts.TRUNK:
        bodies.append(_body(joint.replace("JOINT", "LINK"), joint, parent, row, mirror=False))
        parent = len(bodies) - 1
    chest = next(place for place, body in enumerate(bodies) if body.name == facts.IMU_LINK)
    add("RARM", facts.ARM, chest, mirror=False)
    add("LARM", facts.ARM, chest, mirror=True)
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
        if body.name == facts.IMU_LINK:
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
    placements = zip(nominal.bodies, nominal.placements(positions), strict=True)
    ankle = next(origin for body, (_, origin) in placements if body.name == "RLEG_LINK5")
    # the published centre is over the middle of the feet, the description's over the waist
    goal = np.array(
        [
            facts.MASS,
            facts.CENTRE_OF_MASS[0] + ankle[0],
            facts.CENTRE_OF_MASS[1],
            facts.CENTRE_OF_MASS[2] - facts.HALF_SITTING_HEIGHT,
            *facts.INERTIA,
        ]
    )
    size = np.array([facts.MASS, 0.1, 0.1, 0.1, *facts.INERTIA])

    def residual(change: Array) -> Array:
        mass, centre, inertia = _scaled(nominal, change).mass_properties(positions)
        return np.asarray((np.array([mass, *centre, *np.diag(inertia)]) - goal) / size)

    change: Array = np.zeros(len(_symmetric_keys(nominal)) + 6)
    for _ in range(20):
        error = residual(change)
        if np.abs(error).max() < 1e-10:
            break
        step = 1e-6
        slopes = np.column_stack([(residual(change + step * e) - error) / step for e in np.eye(change.size)])
        change = np.asarray(np.linalg.pinv(slopes) @ (slopes @ change - error))
    return change


def write(directory: str | os.PathLike[str]) -> Path:
    """Write `hrp2.urdf` and `robot.yaml` into a directory; returns the robot file's path."""
    directory = Path(directory)
    write_text(directory / "hrp2.urdf", urdf_text(description()))
    write_text(
        directory / "robot.yaml", yaml.safe_dump(_robot_file(), sort_keys=False, default_flow_style=None)
    )
    return directory / "robot.yaml"


@cache
def robot() -> RobotModel:
    """The same robot as `load_robot` reads it from its own files."""
    with tempfile.TemporaryDirectory(prefix="plantar-") as directory:
        return load_robot(write(directory))


def _robot_file() -> dict[str, object]:
    x, y = facts.SOLE_SIZE[0] / 2, facts.SOLE_SIZE[1] / 2
    corners = [[x, y], [-x, y], [-x, -y], [x, -y]]
    return {
        "name": NAME,
        "urdf": "hrp2.urdf",
        "imu": {"name": "chest", "link": facts.IMU_LINK, "xyz": list(facts.IMU_XYZ)},
        "feet": {
            side: {
                "ankle": f"{side[0].upper()}LEG_LINK5",
                "bush": {"xyz": [0.0, 0.0, facts.BUSH_HEIGHT]},
                "wrench": {"name": f"{side}_foot", "xyz": [0.0, 0.0, facts.SOLE_HEIGHT]},
                "sole": {
                    "xyz": [0.0, 0.0, facts.SOLE_HEIGHT],
                    "polygon": [list(corner) for corner in corners],
                },
            }
            for side in ("right", "left")
        },
    }
