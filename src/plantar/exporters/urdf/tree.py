"""A URDF as a tree of links and joints: fixed poses, collision shapes, mesh files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from plantar.choices import nearest
from plantar.conventions import Array
from plantar.errors import ExportError
from plantar.exporters.poses import inverse, pose, rpy_of
from plantar.exporters.urdf.geometry import mesh_points, solid_corners
from plantar.exporters.xml_file import load_xml, numbers, vector
from plantar.notes import Notes

PARENTS_SEARCHED = 8  # directories above the URDF in which a package:// path may start


class UrdfTree:
    """The XML of a URDF with its links and joints by name."""

    def __init__(self, root: ET.Element, path: Path) -> None:
        self.root, self.path = root, path
        self.links = {link.get("name", ""): link for link in root.findall("link")}
        self.joints = {joint.get("name", ""): joint for joint in root.findall("joint")}

    @classmethod
    def load(cls, path: Path) -> UrdfTree:
        return cls(load_xml(path, "robot"), path)

    def let_go(self, notes: Notes) -> None:
        """Take out the link 'world' and the joint to it, where there is one: the robot stands freely."""
        held = [name for name, joint in self.joints.items() if self.ends(joint)[0] == "world"]
        for element in [self.joints.pop(name) for name in held]:
            self.root.remove(element)
        if held and (world := self.links.pop("world", None)) is not None:
            self.root.remove(world)
            notes.info("export_world", "the joint to the link 'world' was left out: the robot stands freely")

    def link(self, name: str) -> ET.Element:
        if name not in self.links:
            raise ExportError(f"has no link '{name}'", path=self.path, valid=nearest(name, self.links))
        return self.links[name]

    def ends(self, joint: ET.Element) -> tuple[str, str]:
        """Names of a joint's parent and child links."""
        parent, child = joint.find("parent"), joint.find("child")
        return (
            "" if parent is None else parent.get("link", ""),
            "" if child is None else child.get("link", ""),
        )

    def mass(self) -> float:
        """Of all links [kg]. ExportError where they have none."""
        found = [
            element for link in self.links.values() if (element := link.find("inertial/mass")) is not None
        ]
        total = float(sum(vector(element.get("value"), 1, "mass")[0] for element in found))
        if total <= 0:
            raise ExportError("the links weigh nothing", path=self.path, valid="<inertial> with <mass>")
        return total

    def fixed_children(self, link: str) -> list[tuple[ET.Element, str]]:
        """Fixed joints below a link, each with its child link."""
        joints = [joint for joint in self.joints.values() if joint.get("type") == "fixed"]
        return [(joint, ends[1]) for joint in joints if (ends := self.ends(joint))[0] == link]

    def fixed_pose(self, start: str, goal: str) -> Array:
        """Pose of link `goal` in link `start`, (4, 4); ExportError unless only fixed joints lie between."""
        self.link(goal)
        found, queue = {start: np.eye(4)}, [start]
        while queue:
            here = queue.pop()
            for joint in self.joints.values():
                parent, child = self.ends(joint)
                if joint.get("type") != "fixed" or here not in (parent, child):
                    continue
                there = child if here == parent else parent
                if there not in found:
                    step = origin_of(joint)
                    found[there] = found[here] @ (step if here == parent else inverse(step))
                    queue.append(there)
        if goal not in found:
            message = f"link '{goal}' is not rigidly fixed to '{start}'"
            raise ExportError(message, path=self.path, valid="a link without a joint in between")
        return found[goal]

    def mesh_file(self, name: str) -> Path | None:
        """The file behind a mesh name (package://, file:// or a path), or None where it is not there."""
        bare = name.removeprefix("file://")
        if bare.startswith("package://"):
            bare = bare.removeprefix("package://")
            tails = [bare, bare.split("/", 1)[-1]]
        else:
            tails = [bare]
        starts = [self.path.resolve().parent, *list(self.path.resolve().parents)[1:PARENTS_SEARCHED]]
        candidates = (start / tail for start in starts for tail in tails)
        return next((candidate for candidate in candidates if candidate.is_file()), None)

    def points(self, shape: ET.Element) -> Array | None:
        """Extreme points (n, 3) of a shape in its link's frame; None for a mesh that cannot be read."""
        corners = self._local_points(shape.find("geometry"))
        if corners is None:
            return None
        place = origin_of(shape)
        return corners @ place[:3, :3].T + place[:3, 3]

    def _local_points(self, geometry: ET.Element | None) -> Array | None:
        if geometry is None or len(geometry) == 0:
            return None
        kind = geometry[0]
        if kind.tag == "mesh":
            scale = vector(kind.get("scale"), 3, "scale", 1.0)
            return mesh_points(self.mesh_file(kind.get("filename", "")), scale)
        return solid_corners(kind.tag, lambda key, size: vector(kind.get(key), size, f"{kind.tag} {key}"))


def origin_of(element: ET.Element) -> Array:
    """The pose in an element's <origin>, (4, 4)."""
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    return pose(vector(origin.get("xyz"), 3, "origin xyz"), vector(origin.get("rpy"), 3, "origin rpy"))


def set_origin(element: ET.Element, place: Array) -> None:
    """Write a pose to an element's <origin>."""
    origin = element.find("origin")
    if origin is None:
        origin = ET.Element("origin")
        element.insert(0, origin)
    origin.set("xyz", numbers(place[:3, 3]))
    origin.set("rpy", numbers(rpy_of(place)))
