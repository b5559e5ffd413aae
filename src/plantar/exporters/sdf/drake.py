"""Drake: SDFormat with free bush joints under a `drake:linear_bushing_rpy` in each foot.

Drake's bushing acts between frame A on the ankle and frame C on the sole with torque constants in the order
roll, pitch, yaw of `R_AC = Rz(yaw) Ry(pitch) Rx(roll)`, which at yaw 0 is plantar's own, and force constants
x, y, z (drake.mit.edu, LinearBushingRollPitchYaw and the page on parsing multibody files). The joints keep
x, y and yaw rigid and have no effort, without which Drake makes no actuators of them; a collision filter group keeps
ankle and sole apart.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from plantar.conventions import AXES, rotation_from_rpy
from plantar.errors import ExportError
from plantar.exporters.bush import FootBush
from plantar.exporters.job import Job
from plantar.exporters.poses import pose
from plantar.exporters.sdf.target import fixed_to_ankle, insert_bushes
from plantar.exporters.sdf.tree import SdfTree, set_pose
from plantar.exporters.spring import Spring
from plantar.exporters.xml_file import child_of, numbers, to_text
from plantar.notes import Notes

EXTENDS = True
MESHES = (".obj", ".vtk", ".gltf")  # what Drake makes collision shapes of
URI = "http://drake.mit.edu"  # the name space of Drake's own tags


def write(job: Job, notes: Notes) -> str:
    """The model with its feet on bushes, as text.

    Raises ExportError: no ankle, a model whose bush has other axes than the result.
    """
    tree = insert_bushes(job, notes, springs=False, meshes=MESHES)
    ET.register_namespace("drake", URI)
    for foot in job.feet:
        _unactuated(tree, foot)
        _bushing(tree, foot)
        _filter(tree, foot)
    if job.with_offset:
        text = "the bushing has no rest position: its frame on the ankle is tilted, exact for small angles"
        notes.info("export_offset", text)
    return to_text(tree.root, job.head("Drake", notes))


def _unactuated(tree: SdfTree, foot: FootBush) -> None:
    """No effort for the bush's joints: to any other Drake gives an actuator, and the plant's input grows by it."""
    for spring in foot.springs:
        axis = tree.joints[foot.joint(spring.axis)].find("axis")
        assert axis is not None, "the joint's dynamics were looked for there"
        child_of(child_of(axis, "limit"), "effort").text = "0"


def _bushing(tree: SdfTree, foot: FootBush) -> None:
    free = [foot.joint(axis) for axis in AXES if foot.joint(axis) in tree.joints and not foot.spring(axis)]
    if free:
        message = f"has the bush of '{foot.name}' with {free[0]}, which the result has not"
        raise ExportError(f"{message}: it would move freely", path=tree.path, valid="a model without bushes")
    frame_a = f"{foot.name}_bushing_A"
    for old in list(tree.model):
        between = old.findtext(tag("bushing_frameA"), "").strip()
        ours = old.tag == tag("linear_bushing_rpy") and between == frame_a
        if ours or old.get("name") == frame_a:
            tree.model.remove(old)
    pitch, roll, z = (foot.spring(axis) for axis in ("pitch", "roll", "z"))
    tilt = rotation_from_rpy(np.array([_rest(roll), _rest(pitch), 0.0]))
    rest = pose(np.array([0, 0, _rest(z)]), rotation=tilt)
    frame = ET.SubElement(tree.model, "frame", name=frame_a, attached_to=foot.ankle)
    set_pose(frame, pose(foot.centre, rotation=foot.rotation) @ rest, foot.ankle)
    bushing = ET.SubElement(tree.model, tag("linear_bushing_rpy"))
    ET.SubElement(bushing, tag("bushing_frameA")).text = frame_a
    ET.SubElement(bushing, tag("bushing_frameC")).text = foot.sole_link
    for kind, springs in (("torque", (roll, pitch, None)), ("force", (None, None, z))):
        stiffness = [0.0 if spring is None else spring.stiffness for spring in springs]
        damping = [0.0 if spring is None else spring.damping for spring in springs]
        ET.SubElement(bushing, tag(f"bushing_{kind}_stiffness")).text = numbers(stiffness)
        ET.SubElement(bushing, tag(f"bushing_{kind}_damping")).text = numbers(damping)


def _rest(spring: Spring | None) -> float:
    return 0.0 if spring is None else spring.rest


def _filter(tree: SdfTree, foot: FootBush) -> None:
    name = f"{foot.name}_bush_filter"
    if any(e.get("name") == name for e in tree.model.findall(tag("collision_filter_group"))):
        return
    group = ET.SubElement(tree.model, tag("collision_filter_group"), name=name)
    above = fixed_to_ankle(tree, foot)[1]
    members = [*above, *(foot.link(spring.axis) for spring in foot.springs), *tree.parents(foot.ankle)]
    for member in members:
        if member in tree.links:
            ET.SubElement(group, tag("member")).text = member
    ET.SubElement(group, tag("ignored_collision_filter_group")).text = name


def tag(name: str) -> str:
    """One of Drake's own tags, with its name space."""
    return f"{{{URI}}}{name}"
