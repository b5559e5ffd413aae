"""A URDF as text and as Pinocchio's model, and what is said of one that cannot be used."""

from __future__ import annotations

import difflib
import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import pinocchio as pin

from plantar.errors import RobotError
from plantar.files import read_bounded

LIMIT = 64 * 2**20  # bytes: the model of a humanoid has some hundred thousand
FARTHEST = 20.0  # m from a joint to the next, or from a link to its centre of mass
_DECLARES = re.compile(r"<!(DOCTYPE|ENTITY)", re.IGNORECASE)
NO_XML = (2, 3, 5, 7, 8)
"""Expat's codes: no syntax, no elements, unclosed, mismatched, an attribute twice."""
TURNING = ("revolute", "continuous", "prismatic")  # joints that have an axis
INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def read_urdf(path: Path) -> str:
    """The text of a URDF, from its trunk on. Raises RobotError where it cannot be read or is no text."""
    try:
        return from_trunk(read_bounded(path, LIMIT, RobotError).decode())
    except UnicodeDecodeError as error:
        raise RobotError("is not UTF-8 text", path=path, valid="a URDF") from error


def parse_urdf(urdf: str, path: Path, *, floating: bool) -> pin.Model:
    """Pinocchio's model of a URDF's text, with a free-flyer above the root link where `floating`.

    Raises RobotError, with `path` for the file, where it declares an entity, is no URDF, holds a text where a number
    must stand, or Pinocchio cannot read it.
    """
    if _DECLARES.search(urdf):
        raise RobotError("declares a DOCTYPE or an entity", path=path, valid="plain URDF")
    broken = ""
    try:
        _check(ET.fromstring(urdf), path)
    except ET.ParseError as error:  # Pinocchio reads more than Python does, but prints what it cannot read
        broken = str(error)
        if error.code in NO_XML:  # nor does Pinocchio read that
            raise RobotError(f"is not a readable URDF: {broken}", path=path) from error
    root = [pin.JointModelFreeFlyer()] if floating else []
    try:
        return pin.buildModelFromXML(urdf, *root)
    except (ValueError, RuntimeError, IndexError) as error:
        reason = broken or (str(error).splitlines()[0] if str(error) else "unreadable")
        raise RobotError(f"is not a readable URDF: {reason}", path=path) from error


def following_joints(urdf: str) -> dict[str, tuple[str, float, float]]:
    """Of each joint with <mimic>: the joint that it follows, which follows none, the factor and the offset [rad]."""
    if "<mimic" not in urdf:
        return {}
    named = {str(joint.get("name")): joint.find("mimic") for joint in ET.fromstring(urdf).iterfind("joint")}
    found = {}
    for name in named:
        leader, factor, offset = name, 1.0, 0.0
        for _ in named:
            if (mimic := named.get(leader)) is None:
                break
            offset += factor * float(mimic.get("offset", 0))
            factor *= float(mimic.get("multiplier", 1))
            leader = str(mimic.get("joint"))
        if leader != name and named.get(leader) is None:  # else they follow each other in a circle
            found[name] = (leader, factor, offset)
    return found


def unknown_link(link: str, model: pin.Model, path: Path) -> RobotError:
    """One line that names an unknown link and what may have been meant."""
    names = [frame.name for frame in model.frames]
    near = difflib.get_close_matches(link, names, n=3)
    valid = "one of " + ", ".join(near) if near else f"a frame of the URDF, such as {', '.join(names[1:4])}"
    return RobotError(f"link '{link}' is not in the URDF", path=path, valid=valid)


def from_trunk(urdf: str, joint: str = "floating") -> str:
    """Without a bare link for the world and the `joint` on it: every robot floats unless its file says other.

    On a fixed joint a link of another name is a frame of the trunk's own.
    """
    if joint not in urdf or _DECLARES.search(urdf):
        return urdf
    try:
        root = ET.fromstring(urdf)
    except ET.ParseError:
        return urdf
    ends = [end.get("link") for end in root.iterfind("joint/*[@link]")]
    for own in root.findall(f"joint[@type='{joint}']"):
        worlds = [parent.get("link") for parent in own.iterfind("parent")]
        for link in root.findall("link"):
            name = link.get("name")
            if joint == "fixed" and name != "world":
                continue
            if name in worlds and ends.count(name) == 1 and link.find("inertial") is None:
                root.remove(link)
                root.remove(own)
                return ET.tostring(root, encoding="unicode")
    return urdf


def _check(root: ET.Element, path: Path) -> None:
    """Refuse what Pinocchio would pass over: it leaves out an inertia or a place that it cannot read."""
    for element in root.iter():
        if "xacro" in element.tag or any("${" in text for text in element.attrib.values()):
            valid = f"the URDF that `xacro {path.name} > robot.urdf` writes"
            raise RobotError("is xacro that was not expanded", path=path, valid=valid)
    if root.tag != "robot":
        raise RobotError(f"is not a URDF: its root is <{root.tag}>", path=path, valid="<robot name=...>")
    _check_tree(root, path)
    for owner, element, key, count in _numbers(root):
        text = element.get(key)
        if text is not None and not _are_numbers(text, count):
            where = f"{key} of <{element.tag}> in {owner.tag} '{owner.get('name')}'"
            valid = "a number" if count == 1 else f"{count} numbers with spaces between"
            raise RobotError(where, path=path, value=text, valid=valid)
        if key == "xyz" and text is not None and max(map(abs, map(float, text.split()))) > FARTHEST:
            where = (
                f"{owner.tag} '{owner.get('name')}' is {FARTHEST:g} m away or more; are these millimetres?"
            )
            raise RobotError(where, path=path, value=text, valid="metres")
        if (
            element.tag == "axis"
            and text
            and owner.get("type") in TURNING
            and not any(map(float, text.split()))
        ):
            where = f"axis of {owner.get('type')} joint '{owner.get('name')}' has no direction"
            raise RobotError(where, path=path, value=text, valid="a unit vector, such as 0 0 1")
        if element.tag == "mass" and float(text or 0) < 0:
            where = f"the mass of link '{owner.get('name')}' is negative"
            raise RobotError(where, path=path, value=text, valid="kg, 0 or more")


def _check_tree(root: ET.Element, path: Path) -> None:
    """Refuse what its parser would print to the terminal, and say no more of than that it cannot be read."""
    names = {kind: [str(one.get("name")) for one in root.findall(kind)] for kind in ("link", "joint")}
    if not names["link"]:
        raise RobotError("is not a readable URDF: it has no <link>", path=path)
    for kind, known in names.items():
        if twice := [name for name in known if known.count(name) > 1]:
            raise RobotError(f"{kind} '{twice[0]}' is there twice", path=path, valid="names of their own")
    carried: dict[str, str] = {}
    for joint in root.findall("joint"):
        name, ends = str(joint.get("name")), [joint.find(end) for end in ("parent", "child")]
        for end, found in zip(("parent", "child"), ends, strict=True):
            link = None if found is None else found.get("link")
            if link not in names["link"]:
                valid = "the name of a link of the URDF"
                raise RobotError(f"joint '{name}' has the {end} '{link}'", path=path, valid=valid)
        child = str(ends[1].get("link") if ends[1] is not None else "")
        if child in carried:
            text = f"link '{child}' hangs on two joints, '{carried[child]}' and '{name}'"
            raise RobotError(text, path=path, valid="a tree; a loop is cut open")
        carried[child] = name
        if joint.get("type") in ("revolute", "prismatic") and joint.find("limit") is None:
            valid = "<limit lower=... upper=... effort=... velocity=...>, or type continuous"
            raise RobotError(f"{joint.get('type')} joint '{name}' has no limits", path=path, valid=valid)
    roots = [name for name in names["link"] if name not in carried]
    if len(roots) > 1:
        text = f"its links do not hang together: '{roots[0]}' and '{roots[1]}' hang on no joint"
        raise RobotError(text, path=path, valid="one root link")


def _numbers(root: ET.Element) -> Iterator[tuple[ET.Element, ET.Element, str, int]]:
    """What kinematics and dynamics need: the link or joint, the element in it, the attribute, and how many numbers."""
    for owner in root:
        if owner.tag not in ("link", "joint"):
            continue
        within = owner.find("inertial") if owner.tag == "link" else owner
        for element in within if within is not None else ():
            if element.tag in ("origin", "axis"):
                yield owner, element, "xyz", 3
                yield owner, element, "rpy", 3
            elif element.tag == "mass":
                yield owner, element, "value", 1
            elif element.tag == "mimic":
                yield from ((owner, element, key, 1) for key in ("multiplier", "offset"))
            elif element.tag == "inertia":
                yield from ((owner, element, key, 1) for key in INERTIA)


def _are_numbers(text: str, count: int) -> bool:
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        return False
    return len(values) == count and all(map(math.isfinite, values))
