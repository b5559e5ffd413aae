"""The URDF with identified inertias in place of the CAD's: the one place that writes them."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from typing import Final

import numpy as np
import pinocchio as pin

from plantar.choices import nearest
from plantar.conventions import ROUNDING, Array, skew
from plantar.errors import PlantarError
from plantar.notes import Note, listing

ENTRIES: Final = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}


def write_inertias(root: ET.Element, model: pin.Model, bodies: Mapping[str, Array]) -> tuple[Note, ...]:
    """Put new inertias into a URDF's links.

    Links that are fixed to one another move as one body, and only the body's sum can be identified. The link that is
    heaviest in the URDF carries it, and the others of the body lose theirs. So a root without mass stays without:
    readers like KDL ignore an inertia there. Where no link of a body has mass, the first one carries it.

    Args:
        root: the URDF's <robot>, which is changed.
        model: of that URDF, with or without a free-flyer.
        bodies: by the name of any link of a body, its ten parameters about that link's frame, (10,) [kg, kg·m, kg·m²].

    Returns:
        Notes: which links gave their inertia to another, and which inertias no body can have.

    Raises:
        PlantarError: a link is not in the URDF, or its mass is negative.
    """
    links = {link.get("name", ""): link for link in root.findall("link")}
    emptied: list[str] = []
    notes: list[Note] = []
    for name, parameters in bodies.items():
        if name not in links:
            raise PlantarError(f"the URDF has no link '{name}'", valid=nearest(name, links))
        if parameters[0] < 0:
            message = f"link '{name}' has the identified mass {parameters[0]:.4g} kg"
            raise PlantarError(message, valid="a mass that is not negative")
        own = model.frames[model.getFrameId(name, pin.FrameType.BODY)]
        fixed = [
            frame
            for frame in model.frames
            if frame.type == pin.FrameType.BODY and frame.parentJoint == own.parentJoint
        ]
        carrier = max(fixed, key=lambda frame: _mass(links[frame.name]))
        for frame in fixed:
            for old in links[frame.name].findall("inertial"):
                links[frame.name].remove(old)
                emptied += [frame.name] if frame is not carrier else []
        about = carrier.placement.inverse() * own.placement
        mass, centre, inertia = _about_centre(parameters, about)
        links[carrier.name].insert(0, _inertial(mass, centre, inertia))
        principal = np.linalg.eigvalsh(inertia)
        if principal[2] > principal[0] + principal[1] + ROUNDING:  # as also where one is negative
            text = f"'{carrier.name}': no body can have the identified inertia; simulators may refuse it"
            notes.append(Note("export_inertia", "warning", text))
    if emptied:
        text = f"links whose inertia is now in a heavier link that they are fixed to: {listing(emptied)}"
        notes.append(Note("export_lumped", "info", text))
    return tuple(notes)


def _mass(link: ET.Element) -> float:
    mass = link.find("inertial/mass")
    return 0.0 if mass is None else float(mass.get("value", "0"))


def _about_centre(parameters: Array, placement: pin.SE3) -> tuple[float, Array, Array]:
    """Mass [kg], centre of mass (3,) [m] and inertia about it (3, 3) [kg·m²] in the frame that `placement` leads to."""
    mass, moment = float(parameters[0]), parameters[1:4]
    xx, xy, yy, xz, yz, zz = parameters[4:]
    centre = moment / mass if mass > 0 else np.zeros(3)
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) + mass * skew(centre) @ skew(centre)
    turn = placement.rotation
    return mass, np.asarray(placement.act(centre)), np.asarray(turn @ inertia @ turn.T)


def _inertial(mass: float, centre: Array, inertia: Array) -> ET.Element:
    """<inertial> about the centre of mass, in the link's axes."""
    element = ET.Element("inertial")
    ET.SubElement(element, "origin", xyz=" ".join(repr(float(x)) for x in centre), rpy="0 0 0")
    ET.SubElement(element, "mass", value=repr(mass))
    ET.SubElement(element, "inertia", {name: repr(float(inertia[at])) for name, at in ENTRIES.items()})
    return element
