"""Drake's contact: spheres under each ankle with a point stiffness and damping of their own. No joint is added.

A point contact pushes with k·depth and damps, as the plant is set up, either by `relaxation_time` τ, k·τ·rate (the
discrete approximation SAP), or by `hunt_crossley_dissipation` d, k·depth·d·rate (all others). Both are written: τ is
c/k, and d is c over what the point carries on a robot on two feet (drake.mit.edu, "Modeling Compliant Contact" and the
page on parsing multibody files).
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Final

from plantar.conventions import GRAVITY
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.springs import FRICTION, RADIUS, Placed, placed, said, spring_foot
from plantar.exporters.job import Job
from plantar.exporters.poses import pose
from plantar.exporters.sdf.drake import MESHES, URI, tag
from plantar.exporters.sdf.from_urdf import tree_of
from plantar.exporters.sdf.tree import SdfTree, relative, set_pose
from plantar.exporters.shapes import taken_off
from plantar.exporters.xml_file import numbers, to_text, vector
from plantar.notes import Notes

EXTENDS = True
GROUND: Final = 1e9  # N/m: of a floor that is no second spring; Drake's own default is as soft as a foot


def write(job: Job, notes: Notes) -> str:
    """The model with its feet on points, as SDFormat.

    Raises ExportError: no ankle, a model without mass, a bush that does not stand over its sole.
    """
    tree = tree_of(job, notes, MESHES)
    ET.register_namespace("drake", URI)
    weight = tree.mass() * GRAVITY
    for foot in job.feet:
        made = spring_foot(foot, weight)
        friction = _silenced(tree, foot, notes)
        for point in placed(foot, made, weight):
            _add(tree.links[foot.ankle], point, friction)
        notes += said(foot, made, weight)
    text = f"give the ground drake:point_contact_stiffness of {GROUND:g} N/m or more, and no dissipation: else it is a "
    text += "second spring; a discrete plant of 4 ms or less holds these feet"
    notes.info("export_ground", text)
    return to_text(tree.root, job.head("Drake's contact", notes, joints=False))


def _silenced(tree: SdfTree, foot: FootBush, notes: Notes) -> float:
    """Take out the shapes that stand on the ground, points of an earlier export too; their friction."""
    quiet, friction = [], None
    queue = [foot.ankle]
    while queue:
        name = queue.pop()
        queue += [child for _, child in tree.fixed_children(name)]
        place = relative(tree, name, foot.ankle)
        for _, shape in taken_off(tree.links[name], place, tree.points, foot, notes, ("collision",)):
            if friction is None:
                friction = _friction(shape)
            if not shape.get("name", "").startswith(f"{foot.name}_contact_"):
                quiet.append(shape.get("name", ""))
    if quiet:
        text = f"{foot.name}: these shapes are left out, the points touch instead: {', '.join(quiet)}"
        notes.info("export_silent", text)
    return FRICTION if friction is None else friction


def _friction(shape: ET.Element) -> float | None:
    for path in (f"{tag('proximity_properties')}/{tag('mu_dynamic')}", "surface/friction/ode/mu"):
        if shape.findtext(path) is not None:
            return float(vector(shape.findtext(path), 1, "friction")[0])
    return None


def _add(ankle: ET.Element, placed: Placed, friction: float) -> None:
    point = placed.point
    collision = ET.SubElement(ankle, "collision", name=placed.name)
    set_pose(collision, pose(placed.centre))
    sphere = ET.SubElement(ET.SubElement(collision, "geometry"), "sphere")
    ET.SubElement(sphere, "radius").text = numbers([RADIUS])
    properties = ET.SubElement(collision, tag("proximity_properties"))
    # One that hardly touches must not damp without bound.
    carried = max(placed.push, 1e-3 * point.stiffness * RADIUS)
    for name, value in (
        ("point_contact_stiffness", point.stiffness),
        ("relaxation_time", point.damping / point.stiffness),
        ("hunt_crossley_dissipation", point.damping / carried),
        ("mu_dynamic", friction),
        ("mu_static", friction),
    ):
        ET.SubElement(properties, tag(name)).text = numbers([value])
