"""Bullet's contact: a URDF whose feet stand on small links, each with a contact stiffness and damping of its own.

`<contact><stiffness/><damping/>` of a URDF's link are those that PyBullet's `changeDynamics` calls `contactStiffness`
and `contactDamping`, N/m and N·s/m (Bullet, URDFImporter). They belong to a link, so each point is one, fixed to the
ankle.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Final

from plantar.conventions import GRAVITY
from plantar.exporters.bush import FootBush
from plantar.exporters.contact.springs import (
    FRICTION,
    RADIUS,
    Placed,
    placed,
    said,
    share_of_friction,
    sliding_note,
    spring_foot,
)
from plantar.exporters.job import Job
from plantar.exporters.poses import pose
from plantar.exporters.shapes import taken_off
from plantar.exporters.urdf.tree import UrdfTree, origin_of, set_origin
from plantar.exporters.xml_file import numbers, to_text, vector
from plantar.notes import Notes

EXTENDS = True
LIGHT: Final = (1e-3, 1e-6)  # kg and kg·m² of a point's link: Bullet refuses to move one that weighs nothing


def write(job: Job, notes: Notes) -> str:
    """The model with its feet on points, as URDF.

    Raises ExportError: no ankle, a model without mass, a bush that does not stand over its sole.
    """
    assert job.model is not None
    tree = UrdfTree.load(job.model)
    for foot in job.feet:
        _taken_out(tree, foot)
    weight = tree.mass() * GRAVITY
    for foot in job.feet:
        made = spring_foot(foot, weight)
        friction = _silenced(tree, foot, notes)
        points = placed(foot, made, weight)
        outer = friction * share_of_friction(points)
        for point in points:
            _add(tree, foot, point, 0.0 if point.middle else outer)
        notes += [*said(foot, made, weight), *sliding_note(foot, points)]
    text = "load it without URDF_MERGE_FIXED_LINKS; the ground keeps Bullet's own hard contact"
    notes.info("export_bullet", f"{text}; steps of 0.5 to 4 ms hold K")
    return to_text(tree.root, job.head("Bullet's contact", notes, joints=False))


def _taken_out(tree: UrdfTree, foot: FootBush) -> None:
    """Take the points of an earlier export out."""
    for parts in (tree.joints, tree.links):
        for name in [name for name in parts if name.startswith(f"{foot.name}_contact_")]:
            tree.root.remove(parts.pop(name))


def _silenced(tree: UrdfTree, foot: FootBush, notes: Notes) -> float:
    """Take out the shapes that stand on the ground; the friction of the link that carried them."""
    quiet, friction = list[str](), FRICTION
    tree.link(foot.ankle)
    queue = [(foot.ankle, pose(foot.centre * 0))]
    while queue:
        name, place = queue.pop()
        queue += [(child, place @ origin_of(joint)) for joint, child in tree.fixed_children(name)]
        link = tree.links[name]
        if taken := taken_off(link, place, tree.points, foot, notes, ("collision",)):
            quiet += [f"{name} {said.removeprefix('collision ')}" for said, _ in taken]
            given = link.find("contact/lateral_friction")
            if given is not None:
                friction = float(vector(given.get("value"), 1, "lateral_friction")[0])
    if quiet:
        text = f"{foot.name}: these shapes are left out, the points touch instead: {', '.join(quiet)}"
        notes.info("export_silent", text)
    return friction


def _add(tree: UrdfTree, foot: FootBush, placed: Placed, friction: float) -> None:
    link = ET.SubElement(tree.root, "link", name=placed.name)
    contact = ET.SubElement(link, "contact")
    for name, value in (
        ("stiffness", placed.point.stiffness),
        ("damping", placed.point.damping),
        ("lateral_friction", friction),
    ):
        ET.SubElement(contact, name, value=numbers([value]))
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "mass", value=numbers([LIGHT[0]]))
    unit = numbers([LIGHT[1]])
    ET.SubElement(inertial, "inertia", ixx=unit, ixy="0", ixz="0", iyy=unit, iyz="0", izz=unit)
    geometry = ET.SubElement(ET.SubElement(link, "collision"), "geometry")
    ET.SubElement(geometry, "sphere", radius=numbers([RADIUS]))
    joint = ET.SubElement(tree.root, "joint", name=f"{placed.name}_fixed", type="fixed")
    set_origin(joint, pose(placed.centre))
    ET.SubElement(joint, "parent", link=foot.ankle)
    ET.SubElement(joint, "child", link=placed.name)
    tree.links[placed.name], tree.joints[f"{placed.name}_fixed"] = link, joint
