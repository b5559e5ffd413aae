"""The robot file: which URDF, where the IMU and the force sensors sit, where the bushes and soles are."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pinocchio as pin

from plantar.choices import nearest
from plantar.conventions import Array, rotation_from_rpy
from plantar.errors import RobotError
from plantar.notes import Note
from plantar.robot.guesses import Guess
from plantar.robot.joint_names import JointNames
from plantar.robot.kinematics import KinematicTree
from plantar.robot.schema import Entry, read_robot_file
from plantar.robot.uncertainty import Uncertainty
from plantar.robot.urdf import following_joints, parse_urdf, read_urdf, unknown_link
from plantar.robot.weighed import check_weight, of_mass, weight_notes, weight_of

MOST_FEET = 2  # the weight and the closed chain tell two force sensors apart, no more


@dataclass(frozen=True)
class Placement:
    """A frame on a URDF link: `xyz` [m], (3,), and fixed-axis `rpy` [rad], (3,), in the link's frame."""

    link: str
    xyz: Array
    rpy: Array

    @property
    def rotation(self) -> Array:
        """Frame to link, (3, 3)."""
        return rotation_from_rpy(self.rpy)


@dataclass(frozen=True)
class Imu:
    name: str
    placement: Placement


@dataclass(frozen=True)
class WrenchSensor:
    """A six-axis sensor; `sign` is -1 where it reads the robot's action on the environment."""

    name: str
    placement: Placement
    sign: float


@dataclass(frozen=True)
class Sole:
    """The sole's plane (z up through `placement`) and its outline in that plane, (n, 2) [m]."""

    placement: Placement
    polygon: Array


@dataclass(frozen=True)
class Foot:
    """One foot: `ankle` is the last link above the bush, `bush` the centre and axes of the bush."""

    name: str
    ankle: str
    bush: Placement
    wrench: WrenchSensor
    sole: Sole
    contact: Literal["auto", "always"]


@dataclass(frozen=True)
class JointTerms:
    """What eq. 3 models in one joint: names of the terms, and whether the joint has no actuator."""

    terms: tuple[str, ...]
    passive: bool


@dataclass(frozen=True, repr=False)
class RobotModel:
    """A URDF with the sensors and feet that the robot file gives it. Made by `load_robot`.

    Attributes:
        name, path, urdf_path, urdf: the robot's name, its files and the URDF's text.
        base: "floating", or "fixed" for a robot that is bolted down.
        imu: the IMU, or None. feet: by name; placements in the link's frame [m, rad].
        joints: what eq. 3 models in the joints that the robot file describes.
        topics, columns: where readers find each quantity in a log.
        joint_names_in_logs: what logs call the joints, where not as the URDF does.
        weighed: what it weighs on a balance [kg], or None; `model` is scaled to that.
        guesses: keys of the file that are marked as not measured. uncertainty: what its numbers may be off by.

    Example:
        >>> import plantar
        >>> robot = plantar.load_robot("robot.yaml")
        >>> robot
        <RobotModel biped: floating base, feet left, right, IMU chest>
        >>> robot.feet["left"].ankle, round(robot.mass)
        ('left_foot', 60)
    """

    name: str
    path: Path
    urdf_path: Path
    urdf: str
    base: Literal["floating", "fixed"]
    imu: Imu | None
    feet: Mapping[str, Foot]
    joints: Mapping[str, JointTerms]
    topics: Mapping[str, str]
    columns: Mapping[str, Any]
    joint_names_in_logs: JointNames = field(default_factory=JointNames)
    uncertainty: Uncertainty = field(default_factory=Uncertainty)
    guesses: tuple[Guess, ...] = ()
    weighed: float | None = None

    def __repr__(self) -> str:
        sensed = "no IMU" if self.imu is None else f"IMU {self.imu.name}"
        return f"<{type(self).__name__} {self.name}: {self.base} base, feet {', '.join(self.feet) or 'none'}, {sensed}>"

    @cached_property
    def model(self) -> pin.Model:
        """Pinocchio's model with the root link fixed: the joints that a log can hold."""
        return of_mass(parse_urdf(self.urdf, self.urdf_path, floating=False), self.weighed)

    @cached_property
    def floating_model(self) -> pin.Model:
        """Pinocchio's model with a free-flyer above the root link."""
        return of_mass(parse_urdf(self.urdf, self.urdf_path, floating=True), self.weighed)

    @cached_property
    def tree(self) -> KinematicTree:
        """The joints of `model` as plain arrays. Raises RobotError where one has several coordinates."""
        try:
            return KinematicTree.from_model(self.model)
        except RobotError as error:
            raise RobotError(str(error), path=self.urdf_path) from None

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """The movable joints in the order of `model`."""
        return tuple(self.model.names)[1:]

    @cached_property
    def following_joints(self) -> dict[str, tuple[str, float, float]]:
        """Of each joint that mimics another: the one it follows in the end, the factor and the offset [rad]."""
        return following_joints(self.urdf)

    @cached_property
    def mass(self) -> float:
        """What the robot weighs [kg]: on a balance, where the robot file says it, else by the URDF."""
        return weight_of(self.model)

    @cached_property
    def urdf_mass(self) -> float:
        """Total mass of the URDF's links [kg]."""
        if self.weighed is None:
            return self.mass
        return weight_of(parse_urdf(self.urdf, self.urdf_path, floating=False))

    @property
    def weight_notes(self) -> list[Note]:
        """What is to be said of a URDF that weighs something else than the robot."""
        return weight_notes(self.path.name, self.weighed, self.urdf_mass, self.uncertainty.total_mass)

    def frame(self, placement: Placement) -> tuple[int, pin.SE3]:
        """The joint of `model` that carries a placement, and the placement in that joint's frame.

        Raises RobotError when the link is not in the URDF.
        """
        model = self.model
        if not model.existFrame(placement.link):
            raise unknown_link(placement.link, model, self.path)
        frame = model.frames[model.getFrameId(placement.link)]
        return int(frame.parentJoint), frame.placement * pin.SE3(placement.rotation, placement.xyz)

    def configuration(self, positions: Array) -> Array:
        """Pinocchio's configuration (nq,) of `model` at joint positions (n,) in the order of `joint_names`."""
        q = pin.neutral(self.model)
        for name, value in zip(self.joint_names, positions, strict=True):
            joint = self.model.joints[self.model.getJointId(name)]
            # A continuous joint is its cosine and sine.
            q[joint.idx_q : joint.idx_q + joint.nq] = (
                value if joint.nq == 1 else (np.cos(value), np.sin(value))
            )
        return np.asarray(q)

    def joints_between(self, first: Placement, second: Placement) -> frozenset[str]:
        """Names of the joints on the chain from one placement's link to another's."""
        model = self.model
        supports = [set(model.supports[self.frame(placement)[0]]) - {0} for placement in (first, second)]
        return frozenset(model.names[joint] for joint in supports[0] ^ supports[1])

    @property
    def required_imu(self) -> Imu:
        """The IMU. Raises RobotError where the robot file names none."""
        if self.imu is None:
            raise RobotError("names no imu", path=self.path, valid="imu: {name: ..., link: ...}")
        return self.imu

    @cached_property
    def path_joints(self) -> frozenset[str]:
        """Names of the joints between the IMU and any foot, which its angles need; none without IMU."""
        if self.imu is None:
            return frozenset()
        imu = self.imu.placement
        return frozenset().union(*(self.joints_between(imu, foot.bush) for foot in self.feet.values()))


def load_robot(path: str | os.PathLike[str]) -> RobotModel:
    """Read a robot file (YAML) and its URDF.

    Args:
        path: the robot file; `docs/robot_file.md` has its keys.

    Returns:
        The robot, with its sensors and feet placed on the URDF's links [m, rad].

    Raises:
        RobotError: the file or the URDF is missing or broken, a key is unknown, a link is not in the URDF, or a foot's
            sensor is not rigidly fixed to its ankle.

    Example:
        >>> import plantar
        >>> plantar.load_robot("robot.yaml").feet["left"].ankle
        'left_foot'
    """
    path = Path(path)
    entry, guesses = read_robot_file(path)
    urdf_path = _urdf_path(path, entry["urdf"])
    imu, names = entry["imu"], entry["joint_names"]
    robot = RobotModel(
        name=entry["name"],
        path=path,
        urdf_path=urdf_path,
        urdf=read_urdf(urdf_path),
        base=entry["base"],
        imu=Imu(imu["name"], _placement(imu)) if imu else None,
        feet={name: _foot(name, foot) for name, foot in entry["feet"].items()},
        joints={name: JointTerms(_terms(joint), joint["passive"]) for name, joint in entry["joints"].items()},
        topics=dict(entry["topics"]),
        columns=dict(entry["columns"]),
        joint_names_in_logs=JointNames(names["prefix"], names["suffix"], dict(names["renamed"])),
        uncertainty=Uncertainty(**entry["uncertainty"]),
        guesses=guesses,
        weighed=entry["mass"],
    )
    _check(robot)
    return robot


def check_feet(robot: RobotModel) -> None:
    """Raise RobotError unless the robot file names the feet of a biped, or one of them."""
    if not robot.feet:
        raise RobotError("names no feet", path=robot.path, valid="feet: {left: ..., right: ...}")
    if len(robot.feet) > MOST_FEET:
        raise RobotError(f"names {len(robot.feet)} feet", path=robot.path, valid="two: the feet of a biped")


def _urdf_path(path: Path, urdf: str) -> Path:
    found = path.parent / urdf
    if not os.path.exists(found):  # nothing here knows ROS's packages, or a shell's names
        valid = "a path from this file's folder, or a whole one"
        raise RobotError("urdf: there is no such file", path=path, value=urdf, valid=valid)
    return found


def _placement(entry: Entry, default_link: str = "") -> Placement:
    xyz, rpy = np.array(entry["xyz"], dtype=float), np.array(entry["rpy"], dtype=float)
    return Placement(entry["link"] or default_link, xyz, rpy)


def _foot(name: str, entry: Entry) -> Foot:
    ankle, wrench, sole = entry["ankle"], entry["wrench"], entry["sole"]
    sensor = WrenchSensor(wrench["name"], _placement(wrench, ankle), float(wrench["sign"]))
    outline = Sole(_placement(sole, ankle), np.array(sole["polygon"], dtype=float))
    return Foot(name, ankle, _placement(entry["bush"], ankle), sensor, outline, entry["contact"])


def _terms(entry: Entry) -> tuple[str, ...]:
    if entry["terms"] is not None:
        return tuple(entry["terms"])
    return ("stiffness", "viscous", "offset") if entry["passive"] else ("viscous", "coulomb", "offset")


def _check(robot: RobotModel) -> None:
    check_weight(robot.path, robot.weighed, robot.urdf_mass)
    if robot.imu is not None:
        robot.frame(robot.imu.placement)
    for foot in robot.feet.values():
        ankle, _ = robot.frame(Placement(foot.ankle, np.zeros(3), np.zeros(3)))
        parts = {"bush": foot.bush, "wrench": foot.wrench.placement, "sole": foot.sole.placement}
        for part, placement in parts.items():
            if robot.frame(placement)[0] != ankle:
                message = f"feet.{foot.name}.{part} is not rigidly fixed to the ankle link '{foot.ankle}'"
                raise RobotError(message, path=robot.path, valid="a link without a joint in between")
    keys = [("joints", name) for name in robot.joints]
    keys += [("joint_names.renamed", name) for name in robot.joint_names_in_logs.renamed]
    for key, name in keys:
        if name not in robot.joint_names:
            message = f"{key}.{name}: the URDF has no such movable joint"
            raise RobotError(message, path=robot.path, valid=f"one of {nearest(name, robot.joint_names)}")
