"""The robot's URDF with identified inertias in place of the CAD's."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.dynamics.equation import PER_LINK


def identified_urdf(urdf: str, model: pin.Model, parameters: Array) -> str:
    """The URDF text with new inertias.

    model: of that URDF, with or without free-flyer; parameters: ten a joint of the model. Links that are fixed to one
    another are one body in the model: its heaviest link carries the inertia, the others lose theirs.
    """
    root = ET.fromstring(urdf)
    links = {link.get("name"): link for link in root.findall("link")}
    for joint in range(1, model.njoints):
        members = [
            frame
            for frame in model.frames
            if frame.parentJoint == joint and frame.type == pin.FrameType.BODY and frame.name in links
        ]
        if not members:
            continue
        carrier = max(members, key=lambda frame: _mass(links[frame.name]))
        for frame in members:
            for old in links[frame.name].findall("inertial"):
                links[frame.name].remove(old)
        ten = parameters[PER_LINK * (joint - 1) : PER_LINK * joint]
        inertia = carrier.placement.actInv(pin.Inertia.FromDynamicParameters(ten))
        links[carrier.name].insert(0, _inertial(inertia))
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _mass(link: ET.Element) -> float:
    mass = link.find("inertial/mass")
    return float(mass.get("value", "0")) if mass is not None else -1.0


def _inertial(inertia: pin.Inertia) -> ET.Element:
    """<inertial> with the inertia about the centre of mass, in the link's axes."""
    element = ET.Element("inertial")
    centre = " ".join(repr(float(x)) for x in np.asarray(inertia.lever))
    ET.SubElement(element, "origin", xyz=centre, rpy="0 0 0")
    ET.SubElement(element, "mass", value=repr(float(inertia.mass)))
    entries = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    matrix = np.asarray(inertia.inertia)
    ET.SubElement(element, "inertia", {name: repr(float(matrix[entry])) for name, entry in entries.items()})
    return element
