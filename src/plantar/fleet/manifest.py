"""The manifest of a fleet: a CSV file whose rows say which logs are fitted together."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import Final, Literal

from plantar.errors import PlantarError
from plantar.files import read_bounded
from plantar.fleet.places import joined_place, name_of

REQUIRED: Final = ("group", "robot", "log")
COLUMNS: Final = (*REQUIRED, "role", "time", "unit")
ROLES: Final = ("fit", "validate")
LIMIT: Final = 2**30  # bytes: some millions of rows
UTF8_MARK: Final = "\ufeff"

Role = Literal["fit", "validate"]


@dataclass(frozen=True)
class Log:
    """One log of a group: where it lies (a path or a URL) and what for."""

    place: str
    role: Role


@dataclass(frozen=True)
class Group:
    """Logs that are fitted together: one robot, one time (UTC, of the earliest row that has one), one unit."""

    name: str
    robot: str
    logs: tuple[Log, ...]
    time: datetime | None
    unit: str


@dataclass(frozen=True)
class Row:
    """One row of the manifest, as it stands in its line."""

    line: int
    group: str
    robot: str
    log: Log
    time: datetime | None
    unit: str


def read_manifest(path: str | os.PathLike[str]) -> tuple[Group, ...]:
    """The groups of a manifest, in the order in which it first names them.

    Args:
        path: a CSV file with columns `group`, `robot`, `log`, and optionally `role` (fit, which stands for an empty
            cell, or validate), `time` (ISO 8601; UTC where it names no zone) and `unit` (the robot's serial number; the
            robot file's name where left out). Paths that are not absolute are relative to the manifest.

    Raises:
        PlantarError: no such file, a column that is missing or unknown, or a row that cannot be meant; in one line with
            the file, its line and the value.

    Example:
        >>> from plantar.fleet.manifest import read_manifest
        >>> [(group.name, len(group.logs)) for group in read_manifest("fleet.csv")]
        [('monday', 2), ('tuesday', 1)]
    """
    file = Path(path)
    try:
        text = read_bounded(file, LIMIT).decode().removeprefix(UTF8_MARK)
    except UnicodeDecodeError as error:
        raise PlantarError("is not UTF-8 text", path=file, valid="a CSV file") from error
    groups = grouped(_rows(text, file), file)
    if not groups:
        raise PlantarError("holds no rows", path=file, valid=f"rows under {', '.join(REQUIRED)}")
    return groups


def grouped(rows: Iterable[Row], file: Path) -> tuple[Group, ...]:
    """Rows of one group name put together. PlantarError where they contradict one another."""
    found: dict[str, list[Row]] = {}
    for row in rows:
        found.setdefault(row.group, []).append(row)
    return tuple(_group(name, own, file) for name, own in found.items())


def written(groups: Sequence[Group]) -> str:
    """The groups as the text of a manifest."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for group in groups:
        time = "" if group.time is None else group.time.isoformat().replace("+00:00", "Z")
        for log in group.logs:
            writer.writerow([group.name, group.robot, log.place, log.role, time, group.unit])
    return out.getvalue()


def _rows(text: str, file: Path) -> Iterable[Row]:
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        head = [name.strip() for name in next(reader, [])]
        _check_head(head, file)
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield _row(
                    dict(zip(head, cells, strict=False)), len(cells) - len(head), reader.line_num, file
                )
    except csv.Error as error:
        message = f"line {reader.line_num} is not CSV: {error}"
        raise PlantarError(message, path=file, valid="a CSV file") from error


def _check_head(head: Sequence[str], file: Path) -> None:
    missing = [name for name in REQUIRED if name not in head]
    if missing:
        raise PlantarError("is missing", path=file, column=missing[0], valid=", ".join(COLUMNS))
    for place, name in enumerate(head):
        if name not in COLUMNS:
            raise PlantarError("is unknown", path=file, column=name, valid=", ".join(COLUMNS))
        if name in head[:place]:
            raise PlantarError("stands there twice", path=file, column=name, valid="once")


def _row(cells: dict[str, str], beyond: int, line: int, file: Path) -> Row:
    if beyond > 0:
        raise PlantarError(f"line {line} has {beyond} cells more than the head", path=file, valid="as many")
    values = {name: cell.strip() for name, cell in cells.items()}
    for name in REQUIRED:
        if not values.get(name):
            raise PlantarError(f"is empty in line {line}", path=file, column=name, valid="a value")
    role = values.get("role") or ROLES[0]
    if role not in ROLES:
        message = f"is no role in line {line}"
        raise PlantarError(message, path=file, column="role", value=role, valid=" or ".join(ROLES))
    log = Log(joined_place(file, values["log"]), "fit" if role == ROLES[0] else "validate")
    robot = joined_place(file, values["robot"])
    time = _time(values.get("time", ""), line, file)
    unit = values.get("unit") or PurePosixPath(name_of(robot)).stem
    return Row(line, values["group"], robot, log, time, unit)


def _time(text: str, line: int, file: Path) -> datetime | None:
    """An ISO 8601 time in UTC; None for an empty cell."""
    if not text:
        return None
    try:
        time = datetime.fromisoformat(text)
        return time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)
    except (ValueError, OverflowError) as error:
        message, valid = f"is no time in line {line}", "ISO 8601, such as 2026-05-04T09:30:00Z"
        raise PlantarError(message, path=file, column="time", value=text, valid=valid) from error


def _group(name: str, rows: Sequence[Row], file: Path) -> Group:
    first = rows[0]
    for row in rows:
        for what, same in (("robot", row.robot == first.robot), ("unit", row.unit == first.unit)):
            if not same:
                message = f"line {row.line} gives group '{name}' another {what} than line {first.line}"
                raise PlantarError(message, path=file, column=what, valid=f"one {what} a group")
    logs = tuple(row.log for row in rows)
    places = [log.place for log in logs]
    twice = next((row for k, row in enumerate(rows) if row.log.place in places[:k]), None)
    if twice is not None:
        message = f"line {twice.line} names a log of group '{name}' again"
        raise PlantarError(message, path=file, column="log", value=twice.log.place, valid="each log once")
    if all(log.role != ROLES[0] for log in logs):
        message = f"group '{name}' has no log to fit"
        raise PlantarError(message, path=file, column="role", valid="at least one row with role fit")
    times = [row.time for row in rows if row.time is not None]
    return Group(name, first.robot, logs, min(times, default=None), first.unit)
