"""The identified URDF: a result of plantar.inertia/1 written into the links' <inertial>.

The ten numbers of a body stand about its link's frame and hold everything fixed to that link, so the fixed
links below it give their <inertial> up.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from plantar.conventions import INERTIAL_NAMES, Array, skew
from plantar.errors import ExportError, located
from plantar.exporters.poses import pose
from plantar.exporters.urdf.tree import UrdfTree, set_origin
from plantar.exporters.xml_file import numbers, to_text
from plantar.notes import Note


def with_inertial_parameters(result: Mapping[str, Any], model: Path) -> tuple[str, tuple[Note, ...]]:
    """The URDF `model` with the result's inertial parameters, as text.

    Raises ExportError: a parameter is missing or unknown, a link is not in the URDF.
    """
    tree = UrdfTree.load(model)
    notes: list[Note] = []
    bodies: dict[str, dict[str, float]] = {}
    for row in result.get("inertial_parameters", ()):
        bodies.setdefault(str(row["link"]), {})[str(row["name"])] = float(row["value"])
    if not bodies:
        raise ExportError(
            located("the result holds no inertial_parameters", valid="a result of identify inertia")
        )
    lumped = []
    for name, values in bodies.items():
        missing = [key for key in INERTIAL_NAMES if key not in values]
        if missing:
            raise ExportError(
                located(f"link '{name}' has no parameter {missing[0]}", valid=", ".join(INERTIAL_NAMES))
            )
        link = tree.link(name)
        _write(link, np.array([values[key] for key in INERTIAL_NAMES]), notes)
        lumped += _strip_fixed(tree, name, set(bodies))
    if lumped:
        text = f"fixed links whose inertia is now in the link that carries them: {', '.join(lumped)}"
        notes.append(Note("export_lumped", "info", text))
    robot, version = result.get("robot", "robot"), result.get("plantar", "")
    lines = [f"Inertias of '{robot}', identified by plantar {version}.",
             *(f"{note.severity}: {note.text}" for note in notes)]  # fmt: skip
    return to_text(tree.root, lines), tuple(notes)


def _write(link: ET.Element, parameters: Array, notes: list[Note]) -> None:
    mass, moment = parameters[0], parameters[1:4]
    xx, xy, yy, xz, yz, zz = parameters[4:]
    name = link.get("name", "")
    if mass <= 0:
        raise ExportError(
            located(f"link '{name}' has the identified mass {mass:.4g} kg", valid="a positive mass")
        )
    com = moment / mass
    about_com = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) + mass * skew(com) @ skew(com)
    principal = np.linalg.eigvalsh(about_com)
    if principal[0] < 0 or principal[2] > principal[0] + principal[1] + 1e-12:
        text = f"'{name}': the identified inertia is none that a body can have; simulators may refuse it"
        notes.append(Note("export_inertia", "warning", text))
    for old in link.findall("inertial"):
        link.remove(old)
    inertial = ET.Element("inertial")
    set_origin(inertial, pose(com))
    ET.SubElement(inertial, "mass", value=numbers([mass]))
    values = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    ET.SubElement(inertial, "inertia", {key: numbers([about_com[at]]) for key, at in values.items()})
    link.insert(0, inertial)


def _strip_fixed(tree: UrdfTree, link: str, kept: set[str]) -> list[str]:
    stripped = []
    for _, child in tree.fixed_children(link):
        if child in kept or child not in tree.links:
            continue
        for old in tree.links[child].findall("inertial"):
            tree.links[child].remove(old)
            stripped.append(child)
        stripped += _strip_fixed(tree, child, kept)
    return stripped
