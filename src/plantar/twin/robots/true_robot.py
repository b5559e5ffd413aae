"""A robot that is a little otherwise than its robot file says: inertias, mounts and bushes drawn about the file's."""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zlib
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import pinocchio as pin

from plantar.robot.identified_urdf import write_inertias
from plantar.robot.model import Foot, Imu, Placement, RobotModel
from plantar.twin.robots.urdf import rpy_from_rotation


@dataclass(frozen=True)
class RobotSpread:
    """Standard deviations of what a robot file may be off by: a careful lab's, as `plantar.robot.uncertainty` has them.

    `link_mass`: share of each link's mass; `link_com` [m]: of its centre of mass, each axis; `link_inertia`: share of
    its rotational inertia beyond the mass'. `mount` [rad], about each axis, of IMU and force sensors; `place` [m], each
    axis, of bushes and force sensors; `imu_place` [m].
    """

    link_mass: float = 0.05
    link_com: float = 0.005
    link_inertia: float = 0.1
    mount: float = 0.01
    place: float = 0.003
    imu_place: float = 0.005


TRUE: Final = "_true"  # behind the robot's name, which the twin's own robots are recognised by


def true_robot(robot: RobotModel, spread: RobotSpread, seed: int) -> tuple[RobotModel, dict[str, Any]]:
    """The robot that stands behind a robot file, drawn from a seed, and by how much it differs.

    The same seed and robot give the same one. Names of links, joints and sensors stay. The spread is symmetric, so that
    a robot file drawn about a true robot is just as likely.
    """
    random = np.random.default_rng([seed, zlib.crc32(b"robot")])
    drawn: dict[str, Any] = {"links": {}}
    root, bodies = ET.fromstring(robot.urdf), {}
    model = robot.floating_model
    for joint in range(1, model.njoints):
        name, frame = _link_of(model, joint)
        share, more = (
            spread.link_mass * random.standard_normal(),
            spread.link_inertia * random.standard_normal(),
        )
        moved = spread.link_com * random.standard_normal(3)
        own = frame.actInv(model.inertias[joint])
        mass, scale = max(1 + share, 0.0) * own.mass, max((1 + share) * (1 + more), 0.0)
        # Part by part: a constructor refuses a file's inertia that no body can have, and such files are in use.
        own.mass, own.lever, own.inertia = mass, own.lever + moved, scale * own.inertia
        bodies[name] = own.toDynamicParameters()
        drawn["links"][name] = {"mass": share, "com": moved.tolist(), "inertia": more}
    write_inertias(root, model, bodies)

    def moved_placement(key: str, placement: Placement, place: float, mount: float) -> Placement:
        xyz, turn = place * random.standard_normal(3), mount * random.standard_normal(3)
        drawn[key] = {"xyz": xyz.tolist(), "turn": turn.tolist()}
        rotation = placement.rotation @ pin.exp3(turn)
        return replace(placement, xyz=placement.xyz + xyz, rpy=rpy_from_rotation(rotation))

    imu = robot.imu
    if imu is not None:
        imu = Imu(imu.name, moved_placement("imu", imu.placement, spread.imu_place, spread.mount))
    feet: dict[str, Foot] = {}
    for name, foot in robot.feet.items():
        bush = moved_placement(f"{name}.bush", foot.bush, spread.place, 0.0)
        at = moved_placement(f"{name}.wrench", foot.wrench.placement, spread.place, spread.mount)
        feet[name] = replace(foot, bush=bush, wrench=replace(foot.wrench, placement=at))
    urdf = ET.tostring(root, encoding="unicode")
    return replace(robot, name=f"{robot.name}{TRUE}", urdf=urdf, imu=imu, feet=feet), drawn


def _link_of(model: pin.Model, joint: int) -> tuple[str, pin.SE3]:
    """Name of the first link that a joint carries, and its placement in the joint's frame."""
    for frame in model.frames:
        if frame.type == pin.FrameType.BODY and frame.parentJoint == joint:
            return str(frame.name), frame.placement
    raise AssertionError("every joint of a URDF carries a link")
