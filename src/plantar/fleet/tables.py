"""`results.parquet` and `failures.parquet`: what the units hold beside what the manifest says of their groups."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import datetime
from typing import Any, Final

import pyarrow as pa
import pyarrow.parquet as pa_parquet

from plantar.errors import PlantarError
from plantar.fleet.manifest import Group
from plantar.fleet.places import AT_ONCE, Store
from plantar.fleet.unit import Failure, Unit, read_unit, unit_file

RESULTS: Final = "results.parquet"
FAILURES: Final = "failures.parquet"
GROUPS: Final = "groups.parquet"  # which finished unit is whose

_TEXT: Final = pa.string()
RESULTS_SCHEMA: Final = pa.schema(
    [("group", _TEXT), ("unit", _TEXT), ("time", pa.timestamp("us", tz="UTC"))]
    + [(name, _TEXT) for name in ("foot", "axis", "name", "unit_of_value")]
    + [(name, pa.float64()) for name in ("value", "std", "low", "high")]
    + [("verdict", _TEXT), ("model", _TEXT)]
)
FAILURES_SCHEMA: Final = pa.schema([("group", _TEXT), ("log", _TEXT), ("error", _TEXT)])

GROUPS_SCHEMA: Final = pa.schema(
    [("group", _TEXT), ("unit", _TEXT), ("time", pa.timestamp("us", tz="UTC")), ("key", _TEXT)]
)


@dataclass(frozen=True)
class GroupRow:
    """A group with results, and the key of its unit: `groups/KEY/result.json` holds them all."""

    group: str
    unit: str
    time: datetime | None
    key: str


@dataclass(frozen=True)
class Written:
    """How much is in the tables: groups with results, groups without, rows of `failures.parquet`."""

    finished: int
    failed: int
    failures: int


def write_tables(
    store: Store, groups: Sequence[Group], keys: Mapping[str, str], lost: Mapping[str, Sequence[Failure]]
) -> Written:
    """The tables of a store, in the manifest's order, so that the same work gives the same bytes.

    keys: of the finished units, by group. lost: by group, what failed without a unit.
    """
    finished = failed = failures = 0
    schemas = (RESULTS_SCHEMA, FAILURES_SCHEMA, GROUPS_SCHEMA)
    results, broken, finished_groups = (_Table(schema) for schema in schemas)
    for start in range(0, len(groups), AT_ONCE):
        rows: list[dict[str, Any]] = []
        errors: list[dict[str, Any]] = []
        named: list[dict[str, Any]] = []
        for group, unit in _units(store, groups[start : start + AT_ONCE], keys):
            head = {"group": group.name, "unit": group.unit, "time": group.time}
            own = () if unit is None else unit.rows
            rows += [head | asdict(row) for row in own]
            failing = [*lost.get(group.name, ()), *(() if unit is None else _failures(group, unit))]
            errors += [{"group": group.name, **asdict(failure)} for failure in failing]
            named += [head | {"key": keys[group.name]}] if own else []
            finished += bool(own)
            failed += not own
        results.add(rows)
        broken.add(errors)
        finished_groups.add(named)
        failures += len(errors)
    store.write(FAILURES, broken.content())
    store.write(GROUPS, finished_groups.content())
    store.write(RESULTS, results.content())
    return Written(finished, failed, failures)


def read_results(store: Store) -> pa.Table:
    """The rows of `results.parquet`. PlantarError where it is not there or not such a table."""
    return _read(store, RESULTS, RESULTS_SCHEMA)


def read_failures(store: Store) -> pa.Table:
    """The rows of `failures.parquet`. PlantarError where it is not there or not such a table."""
    return _read(store, FAILURES, FAILURES_SCHEMA)


def read_groups(store: Store) -> list[GroupRow]:
    """The rows of `groups.parquet`. PlantarError where it is not there or not such a table."""
    return [GroupRow(**row) for row in _read(store, GROUPS, GROUPS_SCHEMA).to_pylist()]


def _units(
    store: Store, groups: Sequence[Group], keys: Mapping[str, str]
) -> Iterator[tuple[Group, Unit | None]]:
    known = [group for group in groups if group.name in keys]
    contents = store.read_each([unit_file(keys[group.name]) for group in known])
    units = dict(zip((group.name for group in known), contents, strict=True))
    for group in groups:
        content = units.get(group.name)
        yield group, None if content is None else read_unit(content, unit_file(keys[group.name]))


def _failures(group: Group, unit: Unit) -> Iterator[Failure]:
    """A unit's failures with the places that the manifest has now: the logs may have lain elsewhere before."""
    now = {entry.place: log.place for entry, log in zip(unit.inputs, group.logs, strict=True)}
    for failure in unit.failures:
        text = failure.error
        for before, place in now.items():
            text = text.replace(before, place)
        yield Failure(now.get(failure.log, failure.log), text)


def _read(store: Store, name: str, schema: pa.Schema) -> pa.Table:
    content = store.read(name)
    if content is None:
        raise PlantarError("does not exist", path=store.path(name), valid="the --out of `plantar fleet run`")
    try:
        return pa_parquet.read_table(io.BytesIO(content)).select(schema.names).cast(schema)
    except (pa.ArrowException, KeyError, ValueError) as error:
        valid = "the --out of `plantar fleet run`"
        raise PlantarError(f"is not such a table: {error}", path=store.path(name), valid=valid) from error


class _Table:
    """Rows that become a Parquet file, some at a time."""

    def __init__(self, schema: pa.Schema) -> None:
        self._schema = schema
        self._out = io.BytesIO()
        self._writer = pa_parquet.ParquetWriter(self._out, schema, compression="zstd")

    def add(self, rows: Sequence[Mapping[str, Any]]) -> None:
        self._writer.write_table(pa.Table.from_pylist(list(rows), schema=self._schema))

    def content(self) -> bytes:
        self._writer.close()
        return self._out.getvalue()
