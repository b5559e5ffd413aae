"""The result to export: read, checked for what every target needs, and its URDF found."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from plantar.conventions import DAMPING_UNIT, STIFFNESS_UNIT
from plantar.errors import ExportError
from plantar.results.dynamics import INERTIA_SCHEMA, DynamicsResult
from plantar.results.feet import FEET_SCHEMA, FeetResult
from plantar.results.io import read_result, result_path

UNITS: Mapping[str, Mapping[str, str]] = {"stiffness": STIFFNESS_UNIT, "damping": DAMPING_UNIT}
SCHEMAS = (FEET_SCHEMA, INERTIA_SCHEMA)
ResultInput = FeetResult | DynamicsResult | Mapping[str, Any] | str | os.PathLike[str]


def open_result(result: ResultInput) -> tuple[Mapping[str, Any], Path]:
    """The result as `result.json` holds it, and the directory that its relative paths start from."""
    base = Path()
    if isinstance(result, FeetResult | DynamicsResult):
        result = result.to_dict()
    elif isinstance(result, str | os.PathLike):
        file = result_path(result)
        base, result = file.parent, read_result(file, error=ExportError)
    elif not isinstance(result, Mapping):
        kind = type(result).__name__
        raise ExportError("is not a result", value=kind, valid="a FeetResult or the path of a result.json")
    schema = result.get("schema")
    if schema not in SCHEMAS:
        raise ExportError(
            "a result of this schema cannot be exported", value=str(schema), valid=", ".join(SCHEMAS)
        )
    rows = result.get("parameters")
    if schema == FEET_SCHEMA and isinstance(rows, list):
        result = {**result, "parameters": [_read(row) if isinstance(row, Mapping) else row for row in rows]}
    return result, base


def _read(row: Mapping[str, Any]) -> Mapping[str, Any]:
    """A parameter with open ends of its interval, which JSON holds as null, as numbers; ExportError in another unit."""
    usual = UNITS.get(str(row.get("name")), {}).get(str(row.get("axis")))
    if usual is not None and (row.get("unit") or usual) != usual:
        what = f"{row.get('foot')} {row.get('axis')}: the unit of the {row.get('name')}"
        raise ExportError(what, value=str(row["unit"]), valid=usual)
    ends = row.get("interval95")
    if not isinstance(ends, list | tuple) or len(ends) != 2:
        return row
    low, high = ends
    return {**row, "interval95": [-math.inf if low is None else low, math.inf if high is None else high]}


def robot_model(result: Mapping[str, Any]) -> Mapping[str, Any]:
    """The result's `robot_model`; ExportError where an older result has none."""
    entry = result.get("robot_model")
    if not isinstance(entry, Mapping):
        raise ExportError("the result holds no 'robot_model'", valid="a result of this version of identify")
    return entry


def robot_urdf(result: Mapping[str, Any], base: Path) -> Path:
    """The URDF of the result: absolute, or relative to the result, to the working directory, or to the folder that
    `identify` was run in, which holds the result somewhere below."""
    named = robot_model(result).get("urdf")
    if not isinstance(named, str):
        raise ExportError("the result names no URDF", valid="--model with a robot model")
    for folder in (base, Path(), *base.resolve().parents):
        if (folder / named).is_file():
            return folder / named
    raise ExportError("the result's URDF is not there", path=named, valid="--model with a robot model")
