"""Results as JSON: written for people and scripts alike, read with bounds."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from plantar.errors import PlantarError
from plantar.files import read_bounded

RESULT_LIMIT = 256 * 2**20  # bytes


def dump_json(content: Mapping[str, Any]) -> str:
    """JSON for people and scripts alike: two spaces, one final newline, never NaN."""
    return json.dumps(finite(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def finite(content: Any) -> Any:
    """The same nested data with tuples as lists and numbers that are not finite as None."""
    if isinstance(content, Mapping):
        return {str(key): finite(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [finite(value) for value in content]
    if isinstance(content, float):
        return float(content) if math.isfinite(content) else None
    return content


def result_path(path: str | os.PathLike[str]) -> Path:
    """`result.json` in a folder, or the file itself."""
    given = Path(path)
    return given / "result.json" if given.is_dir() else given


def read_result(
    path: str | os.PathLike[str], schema: str = "plantar.", error: type[PlantarError] = PlantarError
) -> dict[str, Any]:
    """A result file (or its folder) as plain data; `error` when it is not one, or not of the schema asked for."""
    file = result_path(path)
    try:
        content = json.loads(read_bounded(file, RESULT_LIMIT, error))
    except (ValueError, RecursionError) as problem:
        raise error(f"is not readable JSON: {problem}", path=file, valid="a result.json") from problem
    found = content.get("schema") if isinstance(content, dict) else None
    if not isinstance(found, str) or not found.startswith(schema):
        raise error("is another kind of result", path=file, value=found, valid=f"schema '{schema}...'")
    return dict(content)
