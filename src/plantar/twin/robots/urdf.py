"""A description as URDF text; the bush has no place in it, it stands below the last link."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from plantar.conventions import Array
from plantar.twin.robots.description import Body, Description


def urdf_text(robot: Description) -> str:
    """URDF of the robot, links and joints in the description's order, boxes as visuals."""
    root = Element("robot", name=robot.name)
    for body in robot.bodies:
        _add_link(root, body)
    for body in robot.bodies[1:]:
        _add_joint(root, body, robot.bodies[body.parent].name)
    indent(root)
    return '<?xml version="1.0"?>\n' + tostring(root, encoding="unicode") + "\n"


def numbers(values: Array) -> str:
    """Numbers for an XML attribute, without loss."""
    return " ".join(f"{value + 0.0:.12g}" for value in np.ravel(values))


def rpy_from_rotation(rotation: Array) -> Array:
    """URDF's fixed-axis roll-pitch-yaw [rad] of a rotation matrix."""
    roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    pitch = np.arctan2(-rotation[2, 0], np.hypot(rotation[2, 1], rotation[2, 2]))
    return np.array([roll, pitch, np.arctan2(rotation[1, 0], rotation[0, 0])])


def _add_link(root: Element, body: Body) -> None:
    link = SubElement(root, "link", name=body.name)
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "origin", xyz=numbers(body.com), rpy="0 0 0")
    SubElement(inertial, "mass", value=f"{body.mass:.12g}")
    entries = {f"i{'xyz'[i]}{'xyz'[j]}": f"{body.inertia[i, j]:.12g}" for i in range(3) for j in range(i, 3)}
    SubElement(inertial, "inertia", entries)
    for shape in body.shapes:
        visual = SubElement(link, "visual")
        SubElement(visual, "origin", xyz=numbers(shape.xyz), rpy="0 0 0")
        SubElement(SubElement(visual, "geometry"), "box", size=numbers(shape.size))


def _add_joint(root: Element, body: Body, parent: str) -> None:
    joint = SubElement(root, "joint", name=body.joint, type=body.kind)
    SubElement(joint, "parent", link=parent)
    SubElement(joint, "child", link=body.name)
    SubElement(joint, "origin", xyz=numbers(body.xyz), rpy=numbers(rpy_from_rotation(body.rotation)))
    SubElement(joint, "axis", xyz=numbers(body.axis))
    limits = {"lower": body.lower, "upper": body.upper, "velocity": body.velocity, "effort": body.effort}
    SubElement(joint, "limit", {name: f"{value:.12g}" for name, value in limits.items()})
