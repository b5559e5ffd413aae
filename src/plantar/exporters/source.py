"""The result to export: read, checked for what every target needs, and its URDF found."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from plantar.errors import ExportError, located
from plantar.files import read_bounded

RESULT_LIMIT = 256 * 2**20  # bytes
SCHEMAS = ("plantar.feet/1", "plantar.inertia/1")


def open_result(result: Mapping[str, Any] | str | os.PathLike[str]) -> tuple[Mapping[str, Any], Path]:
    """The result as a mapping, and the directory that its relative paths start from."""
    base = Path()
    if not isinstance(result, Mapping):
        path = Path(result)
        base = path.parent
        try:
            result = json.loads(read_bounded(path, RESULT_LIMIT, ExportError))
        except (ValueError, RecursionError) as error:
            raise ExportError(
                located("is not JSON", path=path, valid="the result.json of identify")
            ) from error
        if not isinstance(result, Mapping):
            raise ExportError(located("is not a result", path=path, valid="the result.json of identify"))
    schema = result.get("schema")
    if schema not in SCHEMAS:
        raise ExportError(
            located("a result of this schema cannot be exported", value=str(schema), valid=", ".join(SCHEMAS))
        )
    return result, base


def robot_model(result: Mapping[str, Any]) -> Mapping[str, Any]:
    """The result's `robot_model`; ExportError where an older result has none."""
    entry = result.get("robot_model")
    if not isinstance(entry, Mapping):
        raise ExportError(
            located("the result holds no 'robot_model'", valid="a result of this version of identify")
        )
    return entry


def robot_urdf(result: Mapping[str, Any], base: Path) -> Path:
    """The URDF of the result: absolute, or relative to the result or to the working directory."""
    named = robot_model(result).get("urdf")
    if not isinstance(named, str):
        raise ExportError(located("the result names no URDF", valid="--model with a robot model"))
    for candidate in (base / named, Path(named)):
        if candidate.is_file():
            return candidate
    raise ExportError(
        located("the result's URDF is not there", path=named, valid="--model with a robot model")
    )
