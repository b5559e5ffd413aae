"""Results as JSON: written for people and scripts alike, read with bounds."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from plantar.errors import PlantarError, located
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


def read_result(path: Path, schema: str = "plantar.") -> dict[str, Any]:
    """A result file as plain data. Raises PlantarError when it is not one, or not of the schema asked for."""
    try:
        content = json.loads(read_bounded(path, RESULT_LIMIT))
    except (ValueError, RecursionError) as error:
        raise PlantarError(
            located(f"is not readable JSON: {error}", path=path, valid="a result.json")
        ) from error
    found = content.get("schema") if isinstance(content, dict) else None
    if not isinstance(found, str) or not found.startswith(schema):
        raise PlantarError(
            located("is not such a result", path=path, value=found, valid=f"schema '{schema}...'")
        )
    return dict(content)
