"""An SDFormat model as links and joints: poses in the model frame, collision shapes, mesh files.

Pose semantics as in SDFormat's own page (sdformat.org, "Pose frame semantics"): a link's pose is in the model
frame and a joint's in its child link, unless `relative_to` names another frame (version 1.7 and later).
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from functools import partial
from pathlib import Path

import numpy as np

from plantar.choices import nearest
from plantar.conventions import Array
from plantar.errors import ExportError
from plantar.exporters.poses import inverse, pose, rpy_of
from plantar.exporters.urdf.geometry import mesh_points, solid_corners
from plantar.exporters.xml_file import DEPTH_LIMIT, load_xml, numbers, vector

OF_LINKS = "a <model> with the robot's <link>s in this file itself: what it includes is not read"
OLDEST = (1, 5)  # before it a joint's axis stood in another frame


class SdfTree:
    """The XML of one model, with its links, joints and frames by name."""

    def __init__(self, root: ET.Element, path: Path, ankles: tuple[str, ...]) -> None:
        self.root, self.path = root, path
        self.version = _version(root.get("version", ""), path)
        models = list(root.iter("model"))
        holding = [m for m in models if {link.get("name") for link in m.findall("link")} >= set(ankles)]
        if not holding:
            names = [link.get("name", "") for model in models for link in model.findall("link")]
            missing = next((ankle for ankle in ankles if ankle not in names), ankles[0])
            message = f"has no model with the link '{missing}'"
            raise ExportError(message, path=path, valid=nearest(missing, names) or OF_LINKS)
        self.model = holding[0]
        self.links = {e.get("name", ""): e for e in self.model.findall("link")}
        self.joints = {e.get("name", ""): e for e in self.model.findall("joint")}
        self._frames = {e.get("name", ""): e for e in self.model.findall("frame")}

    @classmethod
    def load(cls, path: Path, ankles: tuple[str, ...]) -> SdfTree:
        return cls(load_xml(path, "sdf"), path, ankles)

    @property
    def relative_poses(self) -> bool:
        """Whether this version knows `relative_to`."""
        return self.version >= (1, 7)

    def in_model(self, name: str, depth: int = 0) -> Array:
        """Pose of a link, joint or frame in the model frame, (4, 4)."""
        if name in ("", "__model__"):
            return np.eye(4)
        if depth > DEPTH_LIMIT:
            raise ExportError(f"frame '{name}' refers to itself", path=self.path)
        if name in self.links:
            element, default = self.links[name], ""
        elif name in self.joints:
            element = self.joints[name]
            default = element.findtext("child", "").strip()
        elif name in self._frames:
            element = self._frames[name]
            default = element.get("attached_to", "")
        else:
            raise ExportError(f"has no frame '{name}'", path=self.path)
        place = element.find("pose")
        base = default if place is None else place.get("relative_to", place.get("frame", "")) or default
        return self.in_model(base, depth + 1) @ pose_of(element)

    def mass(self) -> float:
        """Of the model's links [kg]. ExportError where they have none."""
        texts = [link.findtext("inertial/mass") for link in self.links.values()]
        total = float(sum(vector(text, 1, "mass")[0] for text in texts))
        if total <= 0:
            raise ExportError(
                "the model's links weigh nothing", path=self.path, valid="<inertial> with <mass>"
            )
        return total

    def fixed_children(self, link: str) -> list[tuple[ET.Element, str]]:
        """Fixed joints whose parent is a link, each with its child link."""
        return [
            (joint, child)
            for joint in self.joints.values()
            if joint.get("type") == "fixed" and joint.findtext("parent", "").strip() == link
            and (child := joint.findtext("child", "").strip()) in self.links
        ]  # fmt: skip

    def parents(self, link: str) -> list[str]:
        """The links that carry a link."""
        joints = self.joints.values()
        return [j.findtext("parent", "").strip() for j in joints if j.findtext("child", "").strip() == link]

    def points(self, shape: ET.Element) -> Array | None:
        """Extreme points (n, 3) of a shape in its link's frame; None for a mesh that cannot be read."""
        geometry = shape.find("geometry")
        corners = None if geometry is None else self._local_points(geometry)
        if corners is None:
            return None
        place = pose_of(shape)
        return corners @ place[:3, :3].T + place[:3, 3]

    def _local_points(self, geometry: ET.Element) -> Array | None:
        if geometry.find("mesh") is not None:
            name = geometry.findtext("mesh/uri", "").strip().removeprefix("file://").removeprefix("model://")
            starts = [self.path.resolve().parent, *self.path.resolve().parents[1:6]]
            found = next((start / name for start in starts if (start / name).is_file()), None)
            return mesh_points(found, vector(geometry.findtext("mesh/scale"), 3, "scale", 1.0))
        for kind in geometry:
            if (corners := solid_corners(kind.tag, partial(_size, kind))) is not None:
                return corners
        return None


def _size(kind: ET.Element, key: str, count: int) -> Array:
    return vector(kind.findtext(key), count, f"{kind.tag} {key}")


def pose_of(element: ET.Element) -> Array:
    """The numbers of an element's <pose>, (4, 4), in whatever frame it is given."""
    place = element.find("pose")
    if place is None:
        return np.eye(4)
    values = [float(part) for part in vector(place.text, 6, "pose")]
    if place.get("degrees") in ("true", "1"):
        values[3:] = np.radians(values[3:])
    return pose(np.array(values[:3]), np.array(values[3:]))


def set_pose(element: ET.Element, place: Array, relative_to: str | None = None) -> None:
    """Write an element's <pose>."""
    for old in element.findall("pose"):
        element.remove(old)
    new = ET.Element("pose", {} if relative_to is None else {"relative_to": relative_to})
    new.text = numbers([*place[:3, 3], *rpy_of(place)])
    element.insert(0, new)


def relative(tree: SdfTree, link: str, base: str) -> Array:
    """Pose of one frame in another, (4, 4)."""
    return inverse(tree.in_model(base)) @ tree.in_model(link)


def _version(text: str, path: Path) -> tuple[int, int]:
    try:
        major, minor = (int(part) for part in text.split(".")[:2])
    except ValueError:
        raise ExportError(
            "has no SDFormat version", path=path, value=text, valid='<sdf version="1.9">'
        ) from None
    if (major, minor) < OLDEST:
        raise ExportError("is of an SDFormat version too old", path=path, value=text, valid="1.5 or later")
    return major, minor
