"""Rows of a result read back from JSON, each checked, since a file may come from anywhere; and as an Arrow table."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, is_dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_args, get_type_hints

from pydantic_core import ValidationError

from plantar.errors import PlantarError

if TYPE_CHECKING:
    import pyarrow as pa
    from pydantic import TypeAdapter

Row = TypeVar("Row")
_INTERVALS = (tuple[float, float], tuple[float, float] | None)


def rows_of(
    kind: type[Row], content: Mapping[str, Any], key: str, path: Path | None, *, required: bool = False
) -> tuple[Row, ...]:
    """The list under `key` as rows of the dataclass `kind`; none where a key that is not `required` is missing.

    Raises PlantarError that names the row and its key where one does not fit. Keys that `kind` lacks are left out.
    """
    entries = value_of(list[Any], content, key, path, None if required else [])
    return tuple(row_of(kind, entry, f"{key}.{place}", path) for place, entry in enumerate(entries))


def row_of(kind: type[Row], entry: object, place: str, path: Path | None) -> Row:
    """One row as a `kind`, a dataclass; `place` says in an error where it stands in the file."""
    return _checked(kind, _infinite(entry, kind), place, path)


def value_of(
    kind: type[Row], content: Mapping[str, Any], key: str, path: Path | None, missing: Row | None = None
) -> Row:
    """The value under `key` as a plain type, such as str or dict[str, float]; PlantarError where it does not fit.

    missing: what stands where there is no such key; None: that is an error.
    """
    if key not in content:
        if missing is not None:
            return missing
        raise PlantarError("is missing", path=path, column=key, valid="a whole result.json")
    return _checked(kind, _infinite(content[key], kind), key, path)


def _checked(kind: type[Row], entry: object, place: str, path: Path | None) -> Row:
    try:
        checked: Row = _adapter(kind).validate_python(entry)  # type: ignore[arg-type]  # classes are hashable
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, (place, *first["loc"])))
        raise PlantarError(first["msg"], path=path, column=where) from error
    return checked


def _infinite(value: object, hint: Any) -> object:
    """JSON has no number that is not finite and holds null: NaN again where a number must stand, an open interval; also
    inside dataclasses and tuples of them."""
    if value is None and hint is float:
        return math.nan
    if isinstance(value, list) and len(value) == 2 and hint in _INTERVALS:
        low, high = value
        return (-math.inf if low is None else low, math.inf if high is None else high)
    if isinstance(value, Mapping) and is_dataclass(hint):
        hints = _hints(hint)  # type: ignore[arg-type]  # classes are hashable
        return {name: _infinite(one, hints.get(name)) for name, one in value.items()}
    if isinstance(value, list):
        kinds = [get_args(one)[0] for one in (hint, *get_args(hint)) if get_args(one)[1:] == (...,)]
        return [_infinite(one, kinds[0]) for one in value] if kinds else value
    return value


def table_of(
    rows: Iterable[Any], before: Sequence[str], numbers: Sequence[str], after: Sequence[str] = ()
) -> pa.Table:
    """Dataclass rows as an Arrow table: columns of text, of numbers, of text; `low` and `high` end `interval95`."""
    import pyarrow as pa  # costs start-up

    schema = pa.schema(
        [*((name, pa.string()) for name in before), *((name, pa.float64()) for name in numbers)]
        + [(name, pa.string()) for name in after]
    )
    cells = []
    for row in rows:
        low, high = getattr(row, "interval95", None) or (None, None)
        cells.append(asdict(row) | {"low": low, "high": high})
    return pa.Table.from_pylist(cells, schema=schema)


@cache
def _hints(kind: Any) -> dict[str, Any]:
    return get_type_hints(kind)


@cache
def _adapter(kind: Any) -> TypeAdapter[Any]:
    from pydantic import TypeAdapter  # it costs start-up

    return TypeAdapter(kind)
