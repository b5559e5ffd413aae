"""A robot as it is, and the file a careful lab would write of it: masses, mounts and places a little off."""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import yaml

from biped_twins import known_robot, urdf_of
from outside.physics import ENTRIES
from outside.rubber import Rubber, draw_rubber
from plantar.conventions import Array
from plantar.robot.model import Foot, Placement, RobotModel

NAMES = ("hrp2", "talos", "g1", "icub", "romeo", "alexander")


@dataclass(frozen=True)
class Spread:
    """Standard deviations of what the robot file is off by."""

    mass: float = 0.05  # share, of each link
    centre: float = 0.005  # m
    inertia: float = 0.1  # share
    bush: float = 0.003  # m
    sensor: float = 0.003  # m
    imu: float = 0.005  # m
    mount: float = 0.01  # rad, of IMU and force sensors


EXACT = Spread(0, 0, 0, 0, 0, 0, 0)


def real_robot(name: str, folder: Path) -> RobotModel:
    """The robot itself; all parts of a foot in its ankle's axes."""
    robot = known_robot(name, urdf_of(name, folder), folder)
    feet = {}
    for side, foot in robot.feet.items():
        upper = robot.frame(Placement(foot.ankle, np.zeros(3), np.zeros(3)))[1]

        def on_ankle(place: Placement, foot: Foot = foot, upper: pin.SE3 = upper) -> Placement:
            found = upper.actInv(robot.frame(place)[1])
            return Placement(foot.ankle, np.array(found.translation), pin.rpy.matrixToRpy(found.rotation))

        sensor = replace(foot.wrench, placement=on_ankle(foot.wrench.placement))
        sole = replace(foot.sole, placement=on_ankle(foot.sole.placement))
        feet[side] = replace(foot, bush=on_ankle(foot.bush), wrench=sensor, sole=sole)
    return replace(robot, feet=feet)


def rubber_of(robot: RobotModel, seed: int, sliding: bool) -> dict[str, Rubber]:
    return draw_rubber(robot, np.random.default_rng([seed, zlib.crc32(robot.name.encode()), 1]), sliding)


def with_soles(robot: RobotModel, mass: float, inertia: float) -> RobotModel:
    """The robot whose URDF counts to its ankles' links, as URDFs do, the soles that its physics hang below."""
    root = ET.fromstring(robot.urdf)
    for foot in robot.feet.values():
        link = next(each for each in root.iter("link") if each.get("name") == foot.ankle)
        given = _inertia_of(link)
        whole = given + pin.Inertia(mass * robot.mass, foot.bush.xyz, inertia * robot.mass * np.eye(3))
        for inertial in link.findall("inertial"):
            link.remove(inertial)
        inertial = ET.SubElement(link, "inertial")
        ET.SubElement(inertial, "origin", xyz=" ".join(repr(float(v)) for v in whole.lever))
        ET.SubElement(inertial, "mass", value=repr(float(whole.mass)))
        places = {name: repr(float(whole.inertia[place])) for place, name in ENTRIES.items()}
        ET.SubElement(inertial, "inertia", places)
    return replace(robot, urdf=ET.tostring(root, encoding="unicode"))


def _inertia_of(link: ET.Element) -> pin.Inertia:
    """Of a URDF's link, in its axes."""
    inertial = link.find("inertial")
    if inertial is None:
        return pin.Inertia.Zero()
    origin, mass, inertia = (inertial.find(tag) for tag in ("origin", "mass", "inertia"))
    assert mass is not None
    assert inertia is not None
    xyz, rpy = (
        np.zeros(3) if origin is None else np.array([float(v) for v in origin.get(key, "0 0 0").split()])
        for key in ("xyz", "rpy")
    )
    own, turn = np.zeros((3, 3)), pin.rpy.rpyToMatrix(*rpy)
    for (row, column), name in ENTRIES.items():
        own[row, column] = own[column, row] = float(inertia.get(name, 0))
    return pin.Inertia(float(mass.get("value", 0)), xyz, turn @ own @ turn.T)


def write_told(robot: RobotModel, spread: Spread, seed: int, folder: Path) -> Path:
    """The robot file and URDF that are told of a robot, in `folder`."""
    random = np.random.default_rng([seed, zlib.crc32(robot.name.encode()), 2])
    urdf = folder / f"{robot.name}.urdf"
    urdf.write_text(_wrong_urdf(robot.urdf, spread, random))
    assert robot.imu is not None
    told = {
        "name": robot.name,
        "urdf": urdf.name,
        "imu": {"name": robot.imu.name} | _off(robot.imu.placement, spread.imu, spread.mount, random),
        "feet": {name: _foot(foot, spread, random) for name, foot in robot.feet.items()},
    }
    if spread == EXACT:
        names = (
            "wrench_gain",
            "wrench_crosstalk",
            "bush_position",
            "encoder_zero",
            "imu_mount",
            "link_mass",
            "link_com",
        )
        told["uncertainty"] = dict.fromkeys(names, 0.0)
    file = folder / "robot.yaml"
    file.write_text(yaml.safe_dump(told))
    return file


def _foot(foot: Foot, spread: Spread, random: np.random.Generator) -> dict[str, object]:
    sensor = {"name": foot.wrench.name, "sign": int(foot.wrench.sign)}
    return {
        "ankle": foot.ankle,
        "bush": _off(foot.bush, spread.bush, 0.0, random),
        "wrench": sensor | _off(foot.wrench.placement, spread.sensor, spread.mount, random),
        "sole": _off(foot.sole.placement, 0.0, 0.0, random)
        | {"polygon": np.array(foot.sole.polygon).tolist()},
    }


def _off(placement: Placement, place: float, turn: float, random: np.random.Generator) -> dict[str, object]:
    moved, turned = place * random.standard_normal(3), turn * random.standard_normal(3)
    rpy = pin.rpy.matrixToRpy(placement.rotation @ pin.exp3(turned))
    return {"link": placement.link, "xyz": (placement.xyz + moved).tolist(), "rpy": rpy.tolist()}


def _wrong_urdf(urdf: str, spread: Spread, random: np.random.Generator) -> str:
    root = ET.fromstring(urdf)
    for inertial in root.iter("inertial"):
        share, more = (
            1 + spread.mass * random.standard_normal(),
            1 + spread.inertia * random.standard_normal(),
        )
        moved = spread.centre * random.standard_normal(3)
        mass, inertia, origin = (inertial.find(tag) for tag in ("mass", "inertia", "origin"))
        assert mass is not None
        assert inertia is not None
        if origin is None:
            origin = ET.SubElement(inertial, "origin")
        xyz: Array = np.array([float(v) for v in origin.get("xyz", "0 0 0").split()])
        origin.set("xyz", " ".join(repr(float(v)) for v in xyz + moved))
        mass.set("value", repr(share * float(mass.get("value", 0))))
        for axes in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"):
            inertia.set(axes, repr(share * more * float(inertia.get(axes, 0))))
    return ET.tostring(root, encoding="unicode")
