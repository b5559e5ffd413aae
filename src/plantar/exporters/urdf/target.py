"""URDF with Gazebo's spring tags: light links in series, z slide, pitch and roll, between ankle and sole.

<dynamics damping> is URDF's own (wiki.ros.org/urdf/XML/joint); <springStiffness>, <springReference> and
<implicitSpringDamper> in <gazebo reference="joint"> are those that SDFormat's URDF converter reads into the
joint's <dynamics> (sdformat, SDFExtension.hh and parser_urdf.cc).
"""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from plantar.conventions import Array
from plantar.exporters.bush import FootBush, earlier_joints
from plantar.exporters.comment import moved_note, plate_note, updated_note
from plantar.exporters.job import Job
from plantar.exporters.poses import inverse, pose
from plantar.exporters.shapes import SOLE_INERTIA, SOLE_MASS, plate, taken_off
from plantar.exporters.spring import Spring
from plantar.exporters.urdf.tree import UrdfTree, origin_of, set_origin
from plantar.exporters.xml_file import child_of, numbers, to_text, vector
from plantar.notes import Notes

EXTENDS = True
REACH = {"z": 0.05, "pitch": 0.6, "roll": 0.6}  # limits far beyond any bush: a URDF must have some


def write(job: Job, notes: Notes) -> str:
    """The model with its feet on bushes, as text."""
    assert job.model is not None
    tree = UrdfTree.load(job.model)
    insert_bushes(tree, job.feet, notes)
    for foot in job.feet:
        for spring in foot.springs:
            _gazebo_spring(tree.root, foot.joint(spring.axis), spring)
    notes.info(
        "export_urdf_springs", "URDF itself has no springs: only Gazebo and what reads its tags sees them"
    )
    notes.info("export_urdf_collision", "URDF cannot exclude ankle-sole collisions: disable them in the SRDF")
    return to_text(tree.root, job.head("URDF with Gazebo spring tags", notes))


def insert_bushes(tree: UrdfTree, feet: tuple[FootBush, ...], notes: Notes) -> None:
    """Put each foot's chain of bush joints into the tree, or update the joints where they already stand."""
    for foot in feet:
        ankle = tree.link(foot.ankle)
        if earlier := earlier_joints(foot, tree.joints, tree.path):
            for spring, joint in earlier:
                _dynamics(joint, spring)
            notes.append(updated_note(foot, tree.joints))
            continue
        bush = pose(foot.centre, rotation=foot.rotation)
        sole = _add_chain(tree, foot, bush)
        moved, above = _move_fixed_links(tree, foot, bush)
        for name, place in above:
            for said, shape in taken_off(tree.links[name], place, tree.points, foot, notes):
                set_origin(shape, inverse(bush) @ place @ origin_of(shape))
                sole.append(shape)
                moved.append(said)
        if moved:
            notes.append(moved_note(foot, moved))
        if not any(word.startswith(("collision", "link")) for word in moved):
            _add_plate(sole, foot)
            notes.append(plate_note(foot))
        _lighten(ankle, foot)


def _add_chain(tree: UrdfTree, foot: FootBush, bush: Array) -> ET.Element:
    parent, place = foot.ankle, bush
    link = tree.link(foot.ankle)
    for spring in foot.springs:
        name, kind = foot.joint(spring.axis), "prismatic" if spring.axis == "z" else "revolute"
        joint = ET.SubElement(tree.root, "joint", name=name, type=kind)
        set_origin(joint, place)
        ET.SubElement(joint, "parent", link=parent)
        ET.SubElement(joint, "child", link=foot.link(spring.axis))
        ET.SubElement(joint, "axis", xyz={"z": "0 0 1", "pitch": "0 1 0", "roll": "1 0 0"}[spring.axis])
        reach = numbers([REACH[spring.axis]])
        ET.SubElement(joint, "limit", lower=f"-{reach}", upper=reach, effort="100000", velocity="1000")
        _dynamics(joint, spring)
        link = ET.SubElement(tree.root, "link", name=foot.link(spring.axis))
        inertial = ET.SubElement(link, "inertial")
        ET.SubElement(inertial, "mass", value=numbers([SOLE_MASS]))
        unit = numbers([SOLE_INERTIA])
        ET.SubElement(inertial, "inertia", ixx=unit, ixy="0", ixz="0", iyy=unit, iyz="0", izz=unit)
        tree.joints[name], tree.links[foot.link(spring.axis)] = joint, link
        parent, place = foot.link(spring.axis), np.eye(4)
    return link


def _dynamics(joint: ET.Element, spring: Spring) -> None:
    element = child_of(joint, "dynamics")
    element.set("damping", numbers([spring.damping]))
    element.set("friction", "0")


def _move_fixed_links(
    tree: UrdfTree, foot: FootBush, bush: Array
) -> tuple[list[str], list[tuple[str, Array]]]:
    """Hang on the sole what is fixed to the ankle and lies below the bush centre; what it is, and the links above it
    with their places in the ankle, itself first."""
    moved, above = [], [(foot.ankle, np.eye(4))]
    for name, place in above:
        for joint, child in tree.fixed_children(name):
            here = place @ origin_of(joint)
            if foot.below(here[:3, 3]):
                parent = joint.find("parent")
                assert parent is not None
                parent.set("link", foot.sole_link)
                set_origin(joint, inverse(bush) @ here)
                shaped = tree.links[child].find("collision") is not None
                moved.append(f"{'link' if shaped else 'frame'} {child}")
            else:
                above.append((child, here))
    return moved, above


def _add_plate(sole: ET.Element, foot: FootBush) -> None:
    size, centre = plate(foot)
    collision = ET.SubElement(sole, "collision", name=f"{foot.name}_bush_plate")
    set_origin(collision, pose(centre))
    ET.SubElement(ET.SubElement(collision, "geometry"), "box", size=numbers(size))


def _lighten(ankle: ET.Element, foot: FootBush) -> None:
    """Take the light links' mass off the ankle, so that the robot weighs what it did."""
    mass = ankle.find("inertial/mass")
    added = SOLE_MASS * len(foot.springs)
    if mass is not None and (value := vector(mass.get("value"), 1, "mass")[0]) > 2 * added:
        mass.set("value", numbers([value - added]))


def _gazebo_spring(root: ET.Element, joint: str, spring: Spring) -> None:
    entry = next((e for e in root.findall("gazebo") if e.get("reference") == joint), None)
    entry = ET.SubElement(root, "gazebo", reference=joint) if entry is None else entry
    for tag, text in (
        ("springStiffness", numbers([spring.stiffness])),
        ("springReference", numbers([spring.rest])),
        ("implicitSpringDamper", "true"),
    ):
        element = entry.find(tag)
        element = ET.SubElement(entry, tag) if element is None else element
        element.text = text
