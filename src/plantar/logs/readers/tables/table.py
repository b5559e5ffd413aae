"""Table logs: CSV, CSV.gz and Parquet with one row a sample and the contract's column names."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Array, Mask
from plantar.errors import LogError
from plantar.files import sha256
from plantar.logs.motion_log import COLUMN, MotionLog
from plantar.logs.readers import motion_name
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.streams import STRAY_STAMPS, in_order
from plantar.logs.readers.tables.csv_file import Choice, read_csv
from plantar.logs.stretches import Stretches, stretches_of
from plantar.notes import Note, listing

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

LATEST = 1e20  # in any unit, nanoseconds since 1970 among them: what no clock shows
PARTED = "a first line of column names with commas between; decimal points"
OTHER_MARKS = (";", "\t", "#", "%")  # of columns that are not parted by commas, or of a remark before them


def read(path: Path, robot: RobotModel | None, limit: ReadLimit) -> MotionLog:
    """Read a table log; `robot`: whose torques choose of a long one. Raises LogError with file, column, time, value."""
    notes: list[Note] = []
    header: list[str] = []

    def choose(names: Sequence[str]) -> list[str]:
        header.extend(names)
        return _known(names, path)

    stretches = _stretches(path, robot, limit) if _is_parquet(path) and limit.longest < np.inf else None
    rows = None if stretches is None else stretches.rows
    columns = _columns(path, limit, choose, notes, rows, strict=True)
    time = columns.pop("time")
    if not time.size:
        raise LogError("holds no samples", path=path, valid="a header and one row a sample")
    plain = dict.fromkeys(name.rstrip("\0") for name in header)
    ignored = [name or "one without a name" for name in plain if name not in columns and name != "time"]
    if ignored:
        names = listing(ignored, 6)
        text = f"{path.name}: columns of no known name, not used: {names}"
        notes.append(Note("columns_ignored", "info", text))
    if stretches is not None:
        for values in columns.values():
            values[stretches.blank] = np.nan
    keep = _increasing(time, path, notes)
    if not keep.all():
        time, columns = time[keep], {name: values[keep] for name, values in columns.items()}
        stretches = None if stretches is None else stretches.without(~keep)
    for values in (time, *columns.values()):
        values.setflags(write=False)  # handed over, not copied
    log = MotionLog(motion_name(path), time, columns, path, sha256(path), tuple(notes))
    return log if stretches is None else stretches.log(log)


def _stretches(path: Path, robot: RobotModel | None, limit: ReadLimit) -> Stretches | None:
    """Those of a Parquet file that move most; None where it is no longer than the limit. Raises LogError."""
    names: list[str] = []

    def read(name: str) -> Array:
        return _columns(path, limit, lambda _: [name], [], strict=True)[name]

    def choose(header: Sequence[str]) -> list[str]:
        names.extend(_known(header, path))
        return ["time"]

    time = _columns(path, limit, choose, [], strict=True)["time"]
    sensors = [] if robot is None else [foot.wrench.name for foot in robot.feet.values()]
    return stretches_of(time, names, read, sensors, limit.longest)


def read_raw(path: Path, limit: ReadLimit, notes: list[Note]) -> dict[str, Array]:
    """Every column of numbers of a table under its own name, for logs with a column map. Raises LogError."""

    def choose(names: Sequence[str]) -> list[str]:
        if len(names) == 1 and any(mark in names[0] for mark in OTHER_MARKS):
            raise LogError(f"has one column, '{names[0][:40]}'", path=path, valid=PARTED)
        return list(names)

    columns = _columns(path, limit, choose, notes, strict=False)
    columns = {name: values for name, values in columns.items() if not np.isnan(values).all()}
    twice = next((name for name in columns if name.endswith("\0")), None)
    if twice is not None:
        raise LogError("stands twice in the header", path=path, column=twice.rstrip("\0"))
    return columns


def _is_parquet(path: Path) -> bool:
    return path.name.lower().endswith(".parquet")


def _columns(
    path: Path, limit: ReadLimit, choose: Choice, notes: list[Note], rows: Mask | None = None, *, strict: bool
) -> dict[str, Array]:
    """The chosen columns; of Parquet, these `rows` of them alone."""
    if not _is_parquet(path):
        return read_csv(path, limit, choose, notes, strict=strict)
    from plantar.logs.readers.tables.parquet_file import read_parquet  # Arrow costs start-up

    return read_parquet(path, limit, choose, rows, strict=strict)


def _known(names: Sequence[str], path: Path) -> list[str]:
    """The names that mean something. LogError: one of them stands twice, or time is missing."""
    known: dict[str, None] = {}
    for name in (name.rstrip("\0") for name in names):
        if name in known:
            raise LogError("stands twice in the header", path=path, column=name)
        if name == "time" or COLUMN.fullmatch(name):
            known[name] = None
    if "time" not in known:
        begin = names[0] if names else ""
        valid = (
            "a first column 'time' [s]; or `columns` in the robot file, for `plantar init` as --columns FILE"
        )
        if any(mark in begin for mark in OTHER_MARKS):
            valid = (
                "a first line of column names with commas between, the first one 'time' [s]; decimal points"
            )
        message = f"is missing: the header begins with '{begin[:40]}'"
        raise LogError(message, path=path, column="time", valid=valid)
    return list(known)


def _increasing(time: Array, path: Path, notes: list[Note]) -> Mask:
    """Which rows to keep so that time increases: a few strays go with a note, more is an error."""
    keep = in_order(time, LATEST)
    strays = np.flatnonzero(~keep)
    if strays.size == 0:
        return keep
    first = int(strays[0])
    at = float(time[first - 1]) if first else None
    if strays.size > max(1, STRAY_STAMPS * time.size):
        message = f"does not increase in {strays.size} of {time.size} rows, first here"
        valid = "seconds that increase from row to row, in double precision"
        raise LogError(message, path=path, column="time", time=at, value=float(time[first]), valid=valid)
    text = (
        f"{path.name}: time does not increase in {strays.size} of {time.size} rows (first after t = {at} s); "
    )
    notes.append(Note("time_order", "warning", text + "those rows are left out"))
    return keep
