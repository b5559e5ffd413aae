"""A unit of work: one group's logs, and what came of them, kept under the content of everything it comes from."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from plantar import __version__
from plantar.errors import PlantarError
from plantar.feet.settings import FeetSettings
from plantar.fleet.manifest import Role
from plantar.fleet.places import Stamp
from plantar.results.feet import FeetResult, Verdict
from plantar.results.io import dump_json
from plantar.results.stored import row_of

SCHEMA: Final = "plantar.fleet.unit/1"
UNITS: Final = "units"  # folder of the store


@dataclass(frozen=True)
class UnitInput:
    """A log as it was read: its place, its name there, what for, its content, and what its listing said."""

    place: str
    name: str
    role: Role
    sha256: str
    stamp: Stamp


@dataclass(frozen=True)
class Failure:
    """A log that could not be used and why, in one line; `log` is empty where the whole group is meant."""

    log: str
    error: str


@dataclass(frozen=True)
class UnitRow:
    """One parameter of one foot: the columns of `results.parquet` that do not come from the manifest."""

    foot: str
    axis: str
    name: str
    unit_of_value: str
    value: float | None
    std: float | None
    low: float | None
    high: float | None
    verdict: Verdict
    model: str


@dataclass(frozen=True)
class Unit:
    """What came of one group; `seconds` that it took, reading included."""

    key: str
    inputs: tuple[UnitInput, ...]
    rows: tuple[UnitRow, ...]
    failures: tuple[Failure, ...]
    seconds: float

    def dump(self) -> bytes:
        content = {"schema": SCHEMA, "plantar": __version__, **asdict(self)}
        return dump_json(content).encode()


def read_unit(content: bytes, place: str) -> Unit:
    """What `Unit.dump` wrote. Raises PlantarError for anything else."""
    path = Path(place)
    try:
        found = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise PlantarError(f"is not JSON: {error}", path=path) from error
    if not isinstance(found, dict) or found.get("schema") != SCHEMA:
        raise PlantarError("is not a unit of a fleet", path=path, valid=f"schema '{SCHEMA}'")
    return row_of(Unit, found, "unit", path)


def readable_unit(content: bytes | None, place: str) -> Unit | None:
    """`read_unit`, or None for no content and for a damaged unit, which is made again."""
    try:
        return None if content is None else read_unit(content, place)
    except PlantarError:
        return None


def unit_key(robot: str, inputs: Sequence[tuple[Role, str, str]], settings: FeetSettings) -> str:
    """The key of a unit of work: its content, settings and plantar's version, and nothing of where it lies.

    robot: hash of the robot file and its URDF. inputs: role, file name (results name motions by it) and SHA-256 of
    each log, in the manifest's order.
    """
    content = {
        "schema": SCHEMA,
        "plantar": __version__,
        "robot": robot,
        "inputs": [list(entry) for entry in inputs],
        "settings": settings.to_dict(),
    }
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def unit_file(key: str) -> str:
    """A unit's file in the store; 256 folders, since some file systems are slow with many files in one."""
    return f"{UNITS}/{key[:2]}/{key}.json"


def result_file(key: str) -> str:
    """The group's whole `result.json` in the store."""
    return f"groups/{key}/result.json"


def rows_of_result(result: FeetResult) -> tuple[UnitRow, ...]:
    """A feet result's parameters, each with the model of its axis."""
    models: dict[tuple[str, str], str] = {(axis.foot, axis.axis): axis.model for axis in result.models}
    rows: list[UnitRow] = []
    for row in result.parameters:
        low, high = row.interval95 or (None, None)
        model = models.get((row.foot, row.axis), result.model)
        rows.append(
            UnitRow(row.foot, row.axis, row.name, row.unit, row.value, row.std, low, high, row.verdict, model)
        )
    return tuple(rows)


def contents_of(unit: Unit) -> dict[tuple[str, Stamp], str]:
    """What the unit knows of its logs' contents: the hash by place and stamp."""
    return {(entry.place, entry.stamp): entry.sha256 for entry in unit.inputs}
