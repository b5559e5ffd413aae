"""MuJoCo contact: points under each foot whose `solref` and `solimp` turn like the bush. No joint is added.

The shapes that stood on the ground stay, to be seen and weighed, but touch nothing any more.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Final

import numpy as np

from plantar.conventions import GRAVITY
from plantar.errors import ExportError
from plantar.exporters.bush import FootBush, raised
from plantar.exporters.contact.alone import IMPRATIO, RADIUS, contact_attributes
from plantar.exporters.contact.fit import LOADS, STEPS, Check, Fitted, fitted
from plantar.exporters.contact.hysteresis import carry, take_out
from plantar.exporters.contact.springs import vertical_note
from plantar.exporters.job import Job
from plantar.exporters.mjcf.file import Compiled, relocate
from plantar.exporters.mjcf.from_urdf import opened
from plantar.exporters.shapes import reaches_sole
from plantar.exporters.xml_file import child_of, numbers, to_text
from plantar.notes import Note, Notes

EXTENDS = True
HYSTERESIS_IN_LOOP = True
STANCE = True
TOUCH: Final = ("contype", "conaffinity", "priority", "friction")
FRICTION: Final = (1.0, 0.005, 0.0001)  # MuJoCo's own, where the model has no shape to take it from


def write(job: Job, notes: Notes) -> str:
    """The model with its feet on points, as text; compiled by MuJoCo before and after.

    Raises ExportError: MuJoCo refuses the model, an ankle body is not in it, or a foot cannot stand on points.
    MissingExtra: no mujoco.
    """
    root = opened(job, "export to MuJoCo's contact", notes)
    assert job.model is not None
    earlier = {foot.name: _taken_out(root, foot) for foot in job.feet}
    model = Compiled(root, job.model)
    for foot in job.feet:
        model.body_element(root, foot.ankle)  # one that is missing is named before its robot is weighed
    weight = model.robot_mass(job.feet[0].ankle) * GRAVITY
    turns_in_bush = job.stance.pivot == "bush"
    for foot in job.feet:
        found = fitted(raised(foot) if turns_in_bush else foot, weight, job.stance.least_load)
        _insert(root, foot, found, model, earlier[foot.name], job.hysteresis, notes)
        notes += _said(foot, found, float(model.model.opt.timestep))
        if turns_in_bush:
            text = f"{foot.name}: the points stand at the bush centre's height, where the foot turns: the robot stands "
            text += (
                f"{1e3 * foot.sole_depth:.0f} mm lower, with its sole in the ground; start it that much lower"
            )
            notes.info("export_pivot", text)
    _harden_friction(root, notes)
    Compiled(root, job.model)  # MuJoCo must take what is written
    relocate(root, job.out)
    text = "solref holds for this model's masses: after changing them, or the foot's body, export again"
    notes.info("export_masses", text)
    return to_text(root, job.head("MuJoCo's contact", notes, joints=False))


def _named(foot: FootBush) -> str:
    return f"{foot.name}_contact_"


def _taken_out(root: ET.Element, foot: FootBush) -> tuple[ET.Element, dict[str, str]] | None:
    """Take the points and the slip of an earlier export out: the body that held them and how they touched."""
    take_out(root, foot.name)
    found = None
    for body in list(root.iter("body")):
        for geom in body.findall("geom"):
            if geom.get("name", "").startswith(_named(foot)):
                body.remove(geom)
                found = body, {key: geom.get(key, "") for key in TOUCH}
    return found


def _insert(
    root: ET.Element,
    foot: FootBush,
    found: Fitted,
    model: Compiled,
    earlier: tuple[ET.Element, dict[str, str]] | None,
    hysteresis: bool,
    notes: Notes,
) -> None:
    body = model.body_element(root, foot.ankle)
    quiet, touch, holder = _silence(root, body, foot, model)
    if earlier is not None:
        holder, touch = earlier
    if quiet:
        text = f"{foot.name}: touches nothing any more, the points do: {', '.join(quiet)}"
        notes.info("export_silent", text)
    turn = foot.turn_at_rest
    name = str(holder.get("name"))
    inverse_mass = model.inverse_mass(name)
    for place, point in enumerate(found.foot.points):
        centre = turn @ np.array([point.x, point.y, RADIUS - found.foot.depth - point.lower])
        # Every attribute that a default class of the model could set is written out.
        place_in = model.moved(foot.rotation @ centre + foot.centre, foot.ankle, name)
        second = "second_" if point.lower < 0 else ""
        shape = {"name": f"{_named(foot)}{second}{place}", "type": "sphere", "size": numbers([RADIUS])}
        shape |= {"mass": "0", "pos": numbers(place_in), "condim": "3", "solmix": "1"}
        ET.SubElement(holder, "geom", shape | touch | contact_attributes(point, inverse_mass))
    if not hysteresis:
        return
    carry(root, holder, foot, turn, found.foot, model)
    text = f"{foot.name}: call plantar.FootHysteresis between mj_step1 and mj_step2: "
    if any(spring.slip for spring in foot.springs):
        text += "K and C are those of the rubber without its slip, and this foot is too soft without"
        notes.warning("export_hysteresis", text)
    else:
        text += "K goes on where points leave the ground, and the foot tips as its sole does"
        notes.info("export_hysteresis", text)


def _silence(
    root: ET.Element, body: ET.Element, foot: FootBush, model: Compiled
) -> tuple[list[str], dict[str, str], ET.Element]:
    """Take contact from the shapes that stand on the ground: their names, how points touch, the body that carried them.

    Points in that same body press through the same force sensors as the shapes did.
    """
    holder = body
    quiet: list[str] = []
    compiled = model.model
    priority = str(1 + int(compiled.geom_priority.max(initial=-1)))
    touch = {"contype": "1", "conaffinity": "1", "priority": priority, "friction": numbers(FRICTION)}
    for inner in body.iter("body"):
        name = inner.get("name")
        if name is None:
            message = f"a body below '{foot.ankle}' has no name"
            raise ExportError(message, path=model.path, valid="named bodies")
        for element, geom in model.geom_elements(inner, name):
            touches = bool(compiled.geom_contype[geom] or compiled.geom_conaffinity[geom])
            low = reaches_sole(model.geom_points(geom, foot.ankle), foot)
            if not touches or not low:
                continue
            if not quiet:
                holder = inner
                touch["contype"] = str(int(compiled.geom_contype[geom]))
                touch["conaffinity"] = str(int(compiled.geom_conaffinity[geom]))
                touch["friction"] = numbers(model.friction_on_floor(geom))
            element.attrib |= {"contype": "0", "conaffinity": "0"}
            quiet.append(f"geom {element.get('name') or element.get('mesh') or geom}")
            for section in root.findall("contact"):
                for pair in section.findall("pair"):
                    if element.get("name") in (pair.get("geom1"), pair.get("geom2")):
                        section.remove(pair)
    return quiet, touch, holder


def _harden_friction(root: ET.Element, notes: Notes) -> None:
    """Elliptic cones, for which the formulas of the points hold, and friction harder than the soft normal."""
    option = child_of(root, "option")
    impratio = max(IMPRATIO, float(option.get("impratio", "1")))
    option.attrib |= {"cone": "elliptic", "impratio": numbers([impratio])}
    text = f"the model's cone is elliptic and its impratio {impratio:g} now: soft feet creep sideways without"
    notes.info("export_friction", text)


def _said(foot: FootBush, found: Fitted, step: float) -> list[Note]:
    """What the foot alone showed, and what the points cannot be."""
    notes = Notes()
    for check in found.checks:
        said = f"{foot.name} {check.axis}: alone in MuJoCo at {LOADS[0]:g} to {LOADS[-1]:g} of the weight "
        said += f"K is right to {100 * check.stiffness_error:.2g} %, C to {100 * check.damping_error:.2g} %, "
        said += f"at steps of {_steps(check)}, up to {check.angle:.3f} rad ({check.torque:.0f} N·m); beyond, points "
        said += "leave the ground and others take over, for a robot on two feet"
        notes.info("export_contact", said)
        fits = [one for one in check.steps if one >= step * (1 - 1e-9)]
        if not fits:
            text = f"{foot.name} {check.axis}: the model's step of {step:g} s was not seen to hold K and C; "
            text += f"steps that do: {_steps(check)}"
            notes.warning("export_timestep", text)
    notes.append(vertical_note(foot, found.foot))
    return notes


def _steps(check: Check) -> str:
    if not check.steps:
        return f"none of {', '.join(f'{1e3 * step:g}' for step in STEPS)} ms"
    return ", ".join(f"{1e3 * step:g}" for step in check.steps) + " ms"
