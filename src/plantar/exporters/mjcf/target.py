"""MJCF: one light body in each foot with the bush's slide and hinges, the ground's shapes moved to it.

The new body's frame is the ankle's own, and its joints carry the bush centre in their `pos`, so that shapes,
sites and child bodies move over unchanged. Joints of one body act in the order written: slide along z, hinge
about y (pitch), hinge about x (roll), which is `R_ankle_sole = Ry(pitch) Rx(roll)`. MuJoCo's passive force is
-stiffness (q - springref) - damping q̇ (mujoco.readthedocs.io, XMLreference, body/joint).
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np

from plantar.errors import ExportError
from plantar.exporters.bush import FootBush, earlier_joints
from plantar.exporters.comment import moved_note, plate_note, updated_note
from plantar.exporters.job import Job
from plantar.exporters.mjcf.file import Compiled, relocate
from plantar.exporters.mjcf.from_urdf import STIFF, opened
from plantar.exporters.mjcf.hysteresis import set_slip, slip_joint
from plantar.exporters.shapes import SOLE_INERTIA, SOLE_MASS, plate, reaches_sole
from plantar.exporters.spring import Spring
from plantar.exporters.xml_file import child_of, numbers, to_text
from plantar.notes import Note, Notes

EXTENDS = True
HYSTERESIS = True
SENSORS_ABOVE = {"force", "torque", "accelerometer", "gyro", "velocimeter", "magnetometer"}


def write(job: Job, notes: Notes) -> str:
    """The model with its feet on bushes, as text; compiled by MuJoCo before and after.

    Raises ExportError: MuJoCo refuses the model, or an ankle body is not in it. MissingExtra: no mujoco.
    """
    root = opened(job, "export to MJCF", notes)
    assert job.model is not None
    before = Compiled(root, job.model)
    for foot in job.feet:
        _insert(root, foot, before, notes)
        for spring in foot.springs:
            ankle = before.body_element(root, foot.ankle)
            set_slip(root, ankle, foot, spring, float(before.model.opt.timestep))
    _widen_keyframes(root, before, job)
    after = Compiled(root, job.model)  # MuJoCo must take what is written
    _check_timestep(after, job, notes)
    relocate(root, job.out)
    notes.append(_floor_note(job.model.suffix.lower() == ".urdf"))
    return to_text(root, job.head("MuJoCo", notes))


def _floor_note(ours: bool) -> Note:
    """How stiff the ground is, which is a spring in series with the bush; `ours`: floor and shapes are from a URDF."""
    if ours:
        text = "floor and shapes have a contact of 4 ms (solref 0.004 1), a spring in series: 1 to 2 percent off K"
        return Note("export_floor", "info", text)
    text = "the contact is as soft as the model has it, a spring in series: solref 0.004 takes 1 to 2 percent off K, "
    return Note("export_floor", "info", f"{text}MuJoCo's default of 0.02 about ten")


def _insert(root: ET.Element, foot: FootBush, before: Compiled, notes: Notes) -> None:
    body = before.body_element(root, foot.ankle)
    joints = {joint.get("name", ""): joint for joint in root.iter("joint")}
    if earlier := earlier_joints(foot, joints, before.path):
        for spring, joint in earlier:
            _set_spring(joint, spring, before.degrees)
        notes.append(updated_note(foot, joints))
        return
    if before.has_body(foot.sole_link):
        raise ExportError(f"the model already has a body '{foot.sole_link}'", valid="a model without bushes")
    sole = ET.Element("body", name=foot.sole_link)
    for spring in foot.springs:
        _add_joint(sole, foot, spring, before)
    shapes = _move_shapes(body, sole, foot, before)
    bodies = _move_bodies(body, sole, foot, before)
    sites = _move_sites(root, body, sole, foot, before)
    if moved := shapes + bodies + sites:
        notes.append(moved_note(foot, moved))
    _check_level(foot, before, notes)
    if not before.reaching(foot):
        size, centre = plate(foot)
        place = foot.rotation @ centre + foot.centre
        axes = numbers([*foot.rotation[:, 0], *foot.rotation[:, 1]])
        ET.SubElement(sole, "geom", name=f"{foot.name}_bush_plate", type="box", size=numbers(size / 2), solref=STIFF,
                      pos=numbers(place), xyaxes=axes, mass="0")  # fmt: skip
        notes.append(plate_note(foot))
    _share_mass(body, sole, foot, before)
    body.append(sole)
    _exclude(root, foot, before)


def _add_joint(sole: ET.Element, foot: FootBush, spring: Spring, before: Compiled) -> None:
    """One axis of the bush; what a sole on the ground needs beside spring and damper is an inertia.

    MuJoCo's implicit integrators take the joint's damping C into account, its contact solver does not: contacts turn a
    sole of inertia I by I / (I + step·C) of what they should, and a light one bounces. An armature of step·C keeps that
    above a half. Against the spring it weighs as one step against C/K.
    """
    joint = ET.SubElement(
        sole, "joint", name=foot.joint(spring.axis), type="slide" if spring.axis == "z" else "hinge",
        pos=numbers(foot.centre), axis=numbers(foot.direction(spring.axis)), ref="0", limited="false",
        armature=numbers([float(before.model.opt.timestep) * spring.damping]), frictionloss="0", springdamper="0 0",
    )  # fmt: skip
    # Every attribute that a default class of the model could set is written out.
    _set_spring(joint, spring, before.degrees)


def _set_spring(joint: ET.Element, spring: Spring, degrees: bool) -> None:
    joint.set("stiffness", numbers([spring.stiffness]))
    joint.set("damping", numbers([spring.damping]))
    rest = np.degrees(spring.rest) if degrees and spring.axis != "z" else spring.rest
    joint.set("springref", numbers([rest]))


def _move_shapes(body: ET.Element, sole: ET.Element, foot: FootBush, before: Compiled) -> list[str]:
    moved = []
    for element, geom in before.geom_elements(body, foot.ankle):
        if reaches_sole(before.geom_points(geom, foot.ankle), foot):
            body.remove(element)
            sole.append(element)
            moved.append(f"geom {element.get('name') or element.get('mesh') or geom}")
    return moved


def _move_bodies(body: ET.Element, sole: ET.Element, foot: FootBush, before: Compiled) -> list[str]:
    moved = []
    for element in body.findall("body"):
        name = element.get("name")
        if name is None:
            continue
        points = before.subtree_points(name, foot.ankle)
        jointed = any(element.find(tag) is not None for tag in ("joint", "freejoint"))
        low = len(points) > 0 and reaches_sole(points, foot)
        below = foot.below(before.body_origin(name, foot.ankle))
        if (low and not jointed) or (below and (low or not jointed)):
            body.remove(element)
            sole.append(element)
            moved.append(f"body {name}")
    return moved


def _move_sites(
    root: ET.Element, body: ET.Element, sole: ET.Element, foot: FootBush, before: Compiled
) -> list[str]:
    """Sites below the bush go along, but not those of inertial and force sensors, which sit above it."""
    sensed = {e.get("site") for section in root.findall("sensor") for e in section if e.tag in SENSORS_ABOVE}
    moved = []
    for element in body.findall("site"):
        name = element.get("name")
        if name and name not in sensed and foot.below(before.site_origin(name)):
            body.remove(element)
            sole.append(element)
            moved.append(f"site {name}")
    return moved


def _check_level(foot: FootBush, before: Compiled, notes: Notes) -> None:
    depths = [max(foot.depth(point) for point in points) for points in before.reaching(foot)]
    if depths and abs(max(depths) - foot.sole_depth) > 0.02:
        text = f"{foot.name}: the model's lowest shape lies {max(depths):.3f} m below the bush, "
        text += f"the result's sole {foot.sole_depth:.3f} m: is '{foot.ankle}' the URDF's link?"
        notes.warning("export_sole_level", text)


def _share_mass(body: ET.Element, sole: ET.Element, foot: FootBush, before: Compiled) -> None:
    """Give the sole a light inertia about the bush and take its mass off the ankle."""
    if before.inertia_from_geoms:
        return  # MuJoCo ignores <inertial> then: the moved shapes bring their own mass
    mass, com, orientation, inertia = before.inertia(foot.ankle)
    light = min(SOLE_MASS, 0.1 * mass) or SOLE_MASS
    for old in body.findall("inertial"):
        body.remove(old)
    if mass > 0:
        rest = mass - light
        shifted = (mass * com - light * foot.centre) / rest
        element = ET.Element("inertial", mass=numbers([rest]), pos=numbers(shifted))
        element.attrib |= {"quat": numbers(orientation), "diaginertia": numbers(inertia)}
        body.insert(0, element)
    sole.insert(0, ET.Element("inertial", mass=numbers([light]), pos=numbers(foot.centre),
                              diaginertia=numbers([SOLE_INERTIA] * 3)))  # fmt: skip


def _exclude(root: ET.Element, foot: FootBush, before: Compiled) -> None:
    """No contacts that MuJoCo filtered while the sole was part of the ankle, and those excluded by hand."""
    section = child_of(root, "contact")
    others = {foot.ankle, *before.neighbours(foot.ankle)}
    for element in section.findall("exclude"):
        pair = {element.get("body1"), element.get("body2")}
        if foot.ankle in pair:
            others |= {str(name) for name in pair - {foot.ankle}}
    for other in sorted(others):
        ET.SubElement(section, "exclude", body1=other, body2=foot.sole_link)


def _check_timestep(after: Compiled, job: Job, notes: Notes) -> None:
    """MuJoCo integrates springs explicitly: the step must be shorter than the bush's own time C/K."""
    step = float(after.model.opt.timestep)
    fast = [
        foot.joint(s.axis) for foot in job.feet for s in foot.springs if s.damping <= 0.7 * step * s.stiffness
    ]
    if fast:
        text = f"the time step of {step:g} s is long for {', '.join(fast)} (C/K is shorter): shorten it"
        notes.warning("export_timestep", text)


def _widen_keyframes(root: ET.Element, before: Compiled, job: Job) -> None:
    """Keyframes get a 0 for every new joint, where MuJoCo's order puts it."""
    keys = [key for section in root.findall("keyframe") for key in section.findall("key")]
    if not any(key.get("qpos") or key.get("qvel") for key in keys):
        return
    sections = root.findall("keyframe")
    for section in sections:
        root.remove(section)
    after = Compiled(root, before.path)
    root.extend(sections)
    springs = [(foot, spring) for foot in job.feet for spring in foot.springs]
    names = [name for foot, spring in springs for name in (foot.joint(spring.axis), slip_joint(foot, spring))]
    added = [name for name in names if after.has_joint(name) and not before.has_joint(name)]
    for place, key in enumerate(keys):
        for attribute in ("qpos", "qvel"):
            if key.get(attribute) is not None:
                wide: Any = np.ones(after.size(attribute), bool)
                wide[[after.address(name, attribute) for name in added]] = False
                values = np.zeros(len(wide))
                # As MuJoCo reads it: a short one goes on as at rest.
                values[wide] = getattr(before.model, f"key_{attribute}")[place]
                key.set(attribute, numbers(values))
