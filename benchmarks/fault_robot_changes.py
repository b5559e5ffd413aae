"""What faults do to a case's robot file and URDF: a frame elsewhere, another mass, another joint."""

from __future__ import annotations

import math
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from before_gears import before_gears
from fault_case import FEET, Case, Change, Table
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import load_robot


def frame(part: str, key: str, axis: int, by: float, *feet: str) -> Change:
    """A frame of the feet moved along (`xyz`, m) or about (`rpy`, rad) one axis."""

    def write(robot: dict[str, Any]) -> None:
        for foot in feet or FEET:
            _moved(robot["feet"][foot][part], key, axis, by)

    return lambda case: case.with_robot(write)


def imu_frame(key: str, axis: int, by: float) -> Change:
    return lambda case: case.with_robot(lambda robot: _moved(robot["imu"], key, axis, by))


def _moved(entry: dict[str, Any], key: str, axis: int, by: float) -> None:
    values = list(entry.get(key, (0.0, 0.0, 0.0)))
    values[axis] += by
    entry[key] = values


def soles(factor: float) -> Change:
    """Outlines of both soles larger or smaller."""

    def write(robot: dict[str, Any]) -> None:
        for foot in FEET:
            sole = robot["feet"][foot]["sole"]
            sole["polygon"] = [[factor * x, factor * y] for x, y in sole["polygon"]]

    return lambda case: case.with_robot(write)


def sensors_elsewhere(robot: dict[str, Any]) -> None:
    """The sensors said to be at the ankle; those that are there, at the sole."""
    for foot in FEET:
        sensor, sole = robot["feet"][foot]["wrench"], robot["feet"][foot]["sole"]
        sensor["xyz"] = [0.0, 0.0, 0.0] if any(sensor.get("xyz", ())) else list(sole["xyz"])


def feet_exchanged(robot: dict[str, Any]) -> None:
    """The left foot's entry says the right ankle, and the other way round."""
    left, right = robot["feet"]["left"], robot["feet"]["right"]
    left["ankle"], right["ankle"] = right["ankle"], left["ankle"]
    for foot in (left, right):
        for part in ("bush", "wrench", "sole"):
            foot[part].pop("link", None)


def negative_sign(robot: dict[str, Any]) -> None:
    for foot in FEET:
        robot["feet"][foot]["wrench"]["sign"] = -robot["feet"][foot]["wrench"].get("sign", 1)


def ankle_above(case: Case) -> Case:
    """The left foot hangs on the link above its ankle: the last joint is left out of the chain."""
    parent = next(
        joint.find("parent").get("link")
        for joint in ET.fromstring(case.urdf).findall("joint")
        if joint.get("name") == case.legs["left"][-1]
    )

    def write(robot: dict[str, Any]) -> None:
        foot = robot["feet"]["left"]
        foot["ankle"] = parent
        for part in ("bush", "wrench", "sole"):
            foot[part].pop("link", None)

    return case.with_robot(write)


def imu_on_root(case: Case) -> Case:
    """The IMU said to be on the root link; where it is there, on the first link of the left leg."""
    root = ET.fromstring(case.urdf)
    joints = root.findall("joint")
    children = {joint.find("child").get("link") for joint in joints}
    link = next(each.get("name") for each in root.findall("link") if each.get("name") not in children)
    if case.robot["imu"]["link"] == link:
        first = next(joint for joint in joints if joint.get("name") == case.legs["left"][0])
        link = first.find("child").get("link")
    return case.with_robot(lambda robot: robot["imu"].update(link=link))


def urdf(edit: Callable[[ET.Element, Case], None]) -> Change:
    """The URDF changed by `edit`."""

    def change(case: Case) -> Case:
        root = ET.fromstring(case.urdf)
        edit(root, case)
        return replace(case, urdf=ET.tostring(root, encoding="unicode"))

    return change


def joints(root: ET.Element, *names: str) -> Iterator[ET.Element]:
    return (joint for joint in root.findall("joint") if joint.get("name") in names)


def masses(factor: float, which: Callable[[str], bool] = lambda _: True) -> Change:
    """Masses and inertias of some links multiplied."""

    def edit(root: ET.Element, _: Case) -> None:
        for link in root.findall("link"):
            if (inertial := link.find("inertial")) is None or not which(link.get("name", "")):
                continue
            for part in (inertial.find("mass"), inertial.find("inertia")):
                for key, value in part.attrib.items():
                    part.set(key, str(factor * float(value)))

    return urdf(edit)


def trunk_mass(added: float) -> Change:
    """The heaviest link, the trunk, heavier by a mass [kg]."""

    def edit(root: ET.Element, _: Case) -> None:
        heaviest = max(root.iter("mass"), key=lambda mass: float(mass.get("value")))
        heaviest.set("value", str(float(heaviest.get("value")) + added))

    return urdf(edit)


def _children(root: ET.Element, link: str) -> list[str]:
    own = [joint for joint in root.findall("joint") if joint.find("parent").get("link") == link]
    return [joint.find("child").get("link") for joint in own]


def bent_ankles(compliance: float) -> Change:
    """Ankles whose encoders sit before a gear that bends [rad/(N.m)], and a robot file that says so."""

    def change(case: Case) -> Case:
        said = case.with_robot(
            lambda robot: robot.setdefault("uncertainty", {}).update(joint_compliance=compliance)
        )

        def each(table: Table) -> Table:
            table = dict(table)
            for foot in FEET:
                torque = table[f"wrench.{case.robot['feet'][foot]['wrench']['name']}.torque.y"]
                table[f"joint.{case.legs[foot][-2]}.position"] = (
                    table[f"joint.{case.legs[foot][-2]}.position"] - compliance * torque
                )
            return table

        return said.with_tables(each)

    return change


def untold_gears(compliance: float) -> Change:
    """All joints between the feet and the IMU read before gears that bend [rad/(N.m)], which nobody says."""

    def change(case: Case) -> Case:
        with tempfile.TemporaryDirectory() as folder:
            robot = load_robot(case.write(Path(folder))[0])
        assert robot.imu is not None
        joints: set[str] = set().union(
            *(robot.joints_between(foot.bush, robot.imu.placement) for foot in robot.feet.values())
        )

        def each(table: Table) -> Table:
            columns = {name: values for name, values in table.items() if name != "time"}
            read = before_gears(robot, MotionLog("walk", table["time"], columns), compliance, sorted(joints))
            return table | {
                name: read.column(name) for name in (f"joint.{joint}.position" for joint in joints)
            }

        return case.with_tables(each)

    return change


def without_arm(root: ET.Element, case: Case) -> None:
    """The heaviest limb that carries neither foot nor IMU is cut off: another version of the robot."""
    weights = {link.get("name"): float(mass.get("value")) for link in root.findall("link")
               if (mass := link.find("inertial/mass")) is not None}  # fmt: skip
    kept = {foot["ankle"] for foot in case.robot["feet"].values()} | {case.robot["imu"]["link"]}

    def below(link: str) -> list[str]:
        return [link, *(each for child in _children(root, link) for each in below(child))]

    limbs = [(joint, below(joint.find("child").get("link"))) for joint in root.findall("joint")]
    joint, links = max(
        (limb for limb in limbs if not kept & set(limb[1])),
        key=lambda limb: sum(weights.get(link, 0.0) for link in limb[1]),
    )
    root.remove(joint)
    for other in root.findall("joint"):
        if other.find("parent").get("link") in links:
            root.remove(other)
    for link in root.findall("link"):
        if link.get("name") in links:
            root.remove(link)


def longer_shanks(by: float) -> Change:
    """The ankle's pitch joints further from the knees [m]."""

    def edit(root: ET.Element, case: Case) -> None:
        for joint in joints(root, *(case.legs[foot][-2] for foot in FEET)):
            origin = joint.find("origin")
            xyz = [float(part) for part in origin.get("xyz").split()]
            length = math.hypot(*xyz)
            origin.set("xyz", " ".join(str(part * (1 + by / max(length, 1e-9))) for part in xyz))

    return urdf(edit)


def turned_axis(place: int, turn: Callable[[list[float]], list[float]], *feet: str) -> Change:
    """Another axis of one joint of the legs."""

    def edit(root: ET.Element, case: Case) -> None:
        for joint in joints(root, *(case.legs[foot][place] for foot in feet)):
            axis = joint.find("axis")
            axis.set("xyz", " ".join(map(str, turn([float(part) for part in axis.get("xyz").split()]))))

    return urdf(edit)


def mirrored_hip(root: ET.Element, case: Case) -> None:
    """The first joint of the left leg on the right side."""
    for joint in joints(root, case.legs["left"][0]):
        x, y, z = joint.find("origin").get("xyz").split()
        joint.find("origin").set("xyz", f"{x} {-float(y)} {z}")
