"""The identified URDF: a result of plantar.inertia/1 written into the links' <inertial>."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from plantar.conventions import INERTIAL_NAMES
from plantar.errors import ExportError, PlantarError
from plantar.exporters.xml_file import load_xml, to_text
from plantar.notes import Note
from plantar.robot.identified_urdf import write_inertias
from plantar.robot.urdf import parse_urdf


def with_inertial_parameters(result: Mapping[str, Any], model: Path) -> tuple[str, tuple[Note, ...]]:
    """The URDF `model` with the result's inertial parameters, as text.

    Raises ExportError: a parameter is missing or unknown, a link is not in the URDF, a mass is negative.
    """
    bodies: dict[str, dict[str, float]] = {}
    for row in result.get("inertial_parameters", ()):
        bodies.setdefault(str(row["link"]), {})[str(row["name"])] = float(row["value"])
    if not bodies:
        raise ExportError("the result holds no inertial_parameters", valid="a result of identify inertia")
    for name, values in bodies.items():
        missing = [key for key in INERTIAL_NAMES if key not in values]
        if missing:
            raise ExportError(f"link '{name}' has no parameter {missing[0]}", valid=", ".join(INERTIAL_NAMES))
    parameters = {name: np.array([values[key] for key in INERTIAL_NAMES]) for name, values in bodies.items()}
    root = load_xml(model, "robot")
    try:
        tree = parse_urdf(ET.tostring(root, encoding="unicode"), model, floating=True)
        notes = write_inertias(root, tree, parameters)
    except PlantarError as error:
        raise ExportError(str(error)) from error
    robot, version = result.get("robot", "robot"), result.get("plantar", "")
    lines = [f"Inertias of '{robot}', identified by plantar {version}.",
             *(f"{note.severity}: {note.text}" for note in notes)]  # fmt: skip
    return to_text(root, lines), notes
