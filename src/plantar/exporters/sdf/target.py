"""SDFormat: light links in series, z slide, pitch and roll, between ankle and sole, with spring and damper.

A joint axis carries <dynamics> with <damping>, <spring_reference> and <spring_stiffness>, in N·m/rad and
N·m·s/rad (N/m, N·s/m for prismatic joints): sdformat.org/spec, joint/axis/dynamics.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection

import numpy as np

from plantar.conventions import Array
from plantar.exporters.bush import FootBush, earlier_joints
from plantar.exporters.comment import moved_note, plate_note, updated_note
from plantar.exporters.job import Job
from plantar.exporters.poses import inverse, pose
from plantar.exporters.sdf.from_urdf import tree_of
from plantar.exporters.sdf.tree import SdfTree, pose_of, relative, set_pose
from plantar.exporters.shapes import SOLE_INERTIA, SOLE_MASS, plate, taken_off
from plantar.exporters.spring import Spring
from plantar.exporters.xml_file import child_of, numbers, to_text, vector
from plantar.notes import Notes

EXTENDS = True
REACH = {"z": 0.05, "pitch": 0.6, "roll": 0.6}  # m, rad: limits far beyond any bush
AXIS = {"z": "0 0 1", "pitch": "0 1 0", "roll": "1 0 0"}


def write(job: Job, notes: Notes) -> str:
    """The model with its feet on bushes, as text."""
    tree = insert_bushes(job, notes, springs=True)
    text = "SDFormat cannot exclude one pair of links: leave self_collide off, or ankle and sole touch"
    notes.info("export_sdf_collision", text)
    return to_text(tree.root, job.head("SDFormat", notes))


def insert_bushes(job: Job, notes: Notes, *, springs: bool, meshes: Collection[str] | None = None) -> SdfTree:
    """The job's model with a chain of bush joints in each foot; without `springs` the joints move freely.

    `meshes`: the mesh endings that the target reads, for a model made from a URDF.
    """
    tree = tree_of(job, notes, meshes)
    for foot in job.feet:
        if earlier := earlier_joints(foot, tree.joints, tree.path):
            for spring, joint in earlier:
                _dynamics(joint, spring if springs else None)
            notes.append(updated_note(foot, tree.joints))
            continue
        _insert(tree, foot, notes, springs)
    return tree


def _insert(tree: SdfTree, foot: FootBush, notes: Notes, springs: bool) -> None:
    ankle, bush = tree.links[foot.ankle], pose(foot.centre, rotation=foot.rotation)
    low, above = fixed_to_ankle(tree, foot)
    sole = _add_chain(tree, foot, bush, springs)
    moved = []
    for joint, child in low:
        place = tree.in_model(joint.get("name", ""))
        parent = joint.find("parent")
        assert parent is not None
        parent.text = foot.sole_link
        assert np.allclose(place, tree.in_model(joint.get("name", "")))
        moved.append(f"{'link' if tree.links[child].find('collision') is not None else 'frame'} {child}")
    for name in above:
        here = relative(tree, name, foot.ankle)
        for said, shape in taken_off(tree.links[name], here, tree.points, foot, notes):
            pose_element = shape.find("pose")
            if pose_element is None or not pose_element.get("relative_to"):
                set_pose(shape, inverse(bush) @ here @ pose_of(shape))
            sole.append(shape)
            moved.append(said)
    if moved:
        notes.append(moved_note(foot, moved))
    if not any(word.startswith(("collision", "link")) for word in moved):
        size, centre = plate(foot)
        collision = ET.SubElement(sole, "collision", name=f"{foot.name}_bush_plate")
        set_pose(collision, pose(centre))
        box = ET.SubElement(ET.SubElement(collision, "geometry"), "box")
        ET.SubElement(box, "size").text = numbers(size)
        notes.append(plate_note(foot))
    mass = ankle.find("inertial/mass")
    added = SOLE_MASS * len(foot.springs)
    if mass is not None and (value := vector(mass.text, 1, "mass")[0]) > 2 * added:
        mass.text = numbers([value - added])


def fixed_to_ankle(tree: SdfTree, foot: FootBush) -> tuple[list[tuple[ET.Element, str]], list[str]]:
    """Fixed joints of the links that lie below the bush centre, each with its link, and the links above it, the ankle
    first."""
    low, above = [], [foot.ankle]
    for name in above:
        for joint, child in tree.fixed_children(name):
            if foot.below(relative(tree, child, foot.ankle)[:3, 3]):
                low.append((joint, child))
            elif child not in above:
                above.append(child)
    return low, above


def _add_chain(tree: SdfTree, foot: FootBush, bush: Array, springs: bool) -> ET.Element:
    parent, place = foot.ankle, bush
    absolute = tree.in_model(foot.ankle) @ bush
    link = tree.links[foot.ankle]
    for spring in foot.springs:
        link = ET.SubElement(tree.model, "link", name=foot.link(spring.axis))
        if tree.relative_poses:
            set_pose(link, place, parent)
        else:
            set_pose(link, absolute)
        inertial = ET.SubElement(link, "inertial")
        ET.SubElement(inertial, "mass").text = numbers([SOLE_MASS])
        tensor = ET.SubElement(inertial, "inertia")
        for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
            ET.SubElement(tensor, key).text = numbers([SOLE_INERTIA if key[1] == key[2] else 0.0])
        name = foot.joint(spring.axis)
        kind = "prismatic" if spring.axis == "z" else "revolute"
        joint = ET.SubElement(tree.model, "joint", name=name, type=kind)
        ET.SubElement(joint, "parent").text = parent
        ET.SubElement(joint, "child").text = foot.link(spring.axis)
        axis = ET.SubElement(joint, "axis")
        ET.SubElement(axis, "xyz").text = AXIS[spring.axis]
        limit = ET.SubElement(axis, "limit")
        for key, sign in (("lower", -1), ("upper", 1)):
            ET.SubElement(limit, key).text = numbers([sign * REACH[spring.axis]])
        _dynamics(joint, spring if springs else None)
        tree.links[foot.link(spring.axis)], tree.joints[name] = link, joint
        parent, place = foot.link(spring.axis), np.eye(4)
    return link


def _dynamics(joint: ET.Element, spring: Spring | None) -> None:
    axis = child_of(joint, "axis")
    for old in axis.findall("dynamics"):
        axis.remove(old)
    if spring is not None:
        dynamics = ET.SubElement(axis, "dynamics")
        ET.SubElement(dynamics, "damping").text = numbers([spring.damping])
        ET.SubElement(dynamics, "spring_reference").text = numbers([spring.rest])
        ET.SubElement(dynamics, "spring_stiffness").text = numbers([spring.stiffness])
