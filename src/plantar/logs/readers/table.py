"""Table logs: CSV, CSV.gz and Parquet with one row a sample and the contract's column names."""

from __future__ import annotations

import zlib
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pa_parquet

from plantar.conventions import Array
from plantar.errors import LogError, located
from plantar.files import read_bounded, sha256
from plantar.logs.motion_log import COLUMN, MotionLog
from plantar.logs.readers import motion_name
from plantar.notes import Note
from plantar.robot.model import RobotModel

SIZE_LIMIT = 4 * 2**30  # bytes of text, after decompression
LATEST = 1e20  # in any unit, nanoseconds since 1970 among them: what no clock shows
STRAY_ROWS = 0.01  # share of rows whose time may step back before the file is refused


def read(path: Path, robot: RobotModel | None = None) -> MotionLog:
    """Read a table log; `robot` is not needed. Raises LogError with file, column, time and value."""
    notes: list[Note] = []
    if path.name.lower().endswith(".parquet"):
        table = _read_parquet(path)
    else:
        table = _read_csv(path, notes)
    if table.num_rows == 0 or table.num_columns == 0:
        raise LogError(located("holds no samples", path=path, valid="a header and one row a sample"))
    names = table.column_names
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise LogError(located("stands twice in the header", path=path, column=twice[0]))
    if "time" not in names:
        raise LogError(located("is missing", path=path, column="time", valid="a first column 'time' [s]"))
    time = _numbers(table, "time", None, path)
    columns = {name: _numbers(table, name, time, path) for name in names if COLUMN.fullmatch(name)}
    ignored = [name for name in names if name not in columns and name != "time"]
    if ignored:
        shown = ", ".join(ignored[:6]) + (f" and {len(ignored) - 6} more" if len(ignored) > 6 else "")
        notes.append(
            Note("columns_ignored", "info", f"{path.name}: columns of no known name, not used: {shown}")
        )
    del table
    # Arrow keeps what it has freed: with many logs, a tenth of all memory.
    pa.default_memory_pool().release_unused()
    keep = _increasing(time, path, notes)
    if not keep.all():
        time, columns = time[keep], {name: values[keep] for name, values in columns.items()}
    return MotionLog(motion_name(path), time, columns, path, sha256(path), tuple(notes))


def read_raw(path: Path, notes: list[Note]) -> dict[str, Array]:
    """Every column of numbers of a table under its own name, for logs with a column map. Raises LogError."""
    table = _read_parquet(path) if path.name.lower().endswith(".parquet") else _read_csv(path, notes)
    numeric = [
        field.name
        for field in table.schema
        if pa.types.is_floating(field.type) or pa.types.is_integer(field.type)
    ]
    twice = next((name for name in numeric if numeric.count(name) > 1), None)
    if twice is not None:
        raise LogError(located("stands twice in the header", path=path, column=twice))
    return {name: _numbers(table, name, None, path) for name in numeric}


def _read_csv(path: Path, notes: list[Note]) -> pa.Table:
    content = read_bounded(path, SIZE_LIMIT, LogError)
    if path.name.lower().endswith(".gz"):
        content = _gunzip(content, path, notes)
    if not content.strip():
        raise LogError(located("is empty", path=path, valid="a header and one row a sample"))
    if not content.endswith((b"\n", b"\r")) and b"\n" in content:
        # No end of line: the last number may have lost digits, and nobody could tell.
        content = content[: content.rindex(b"\n") + 1]
        notes.append(_cut(path, "ends in the middle of a line; that line is left out"))
    try:
        content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise LogError(located(f"is not UTF-8 text at line {line}", path=path, valid="a CSV")) from error
    ragged: list[pa_csv.InvalidRow] = []

    def collect(row: pa_csv.InvalidRow) -> str:
        ragged.append(row)
        return "skip"

    try:
        table = pa_csv.read_csv(
            pa.BufferReader(content),
            read_options=pa_csv.ReadOptions(block_size=2**22, use_threads=True),
            parse_options=pa_csv.ParseOptions(invalid_row_handler=collect),
            convert_options=pa_csv.ConvertOptions(
                strings_can_be_null=True, null_values=["", "nan", "NaN", "null"]
            ),
        )
    except (pa.ArrowInvalid, pa.ArrowKeyError) as error:
        reason = str(error).splitlines()[0]
        raise LogError(located(f"is not a readable CSV: {reason}", path=path)) from error
    if ragged:
        if len(ragged) > 1 or content.rstrip().rsplit(b"\n", 1)[-1] != ragged[0].text.encode().rstrip():
            row = ragged[0]
            message = f"a row has {row.actual_columns} values where the header has {row.expected_columns}: "
            raise LogError(located(message + row.text[:40] + "...", path=path))
        notes.append(_cut(path, "ends in an incomplete row; that row is left out"))
    return table


def _gunzip(content: bytes, path: Path, notes: list[Note]) -> bytes:
    """Decompress what can be: a cut file gives its whole lines and a note."""
    parts: list[bytes] = []
    size = 0
    try:
        while content:
            inflater = zlib.decompressobj(wbits=31)
            part = inflater.decompress(content, SIZE_LIMIT - size + 1)
            parts.append(part)
            size += len(part)
            if size > SIZE_LIMIT:
                raise LogError(located(f"decompresses to more than {SIZE_LIMIT} bytes", path=path))
            if not inflater.eof:
                notes.append(_cut(path, "is a cut gzip file; what is whole was read"))
                text = b"".join(parts)
                return text[: text.rfind(b"\n") + 1]
            content = inflater.unused_data.lstrip(b"\0")
    except zlib.error as error:
        raise LogError(located(f"is not a readable gzip file: {error}", path=path)) from error
    return b"".join(parts)


def _read_parquet(path: Path) -> pa.Table:
    try:
        source = pa_parquet.ParquetFile(path)
        metadata = source.metadata
        if metadata.num_rows * max(metadata.num_columns, 1) * 8 > SIZE_LIMIT:
            raise LogError(located(f"holds more than {SIZE_LIMIT} bytes of values", path=path))
        return source.read()
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        reason = str(error).splitlines()[0]
        raise LogError(located(f"is not a readable Parquet file: {reason}", path=path)) from error


def _numbers(table: pa.Table, name: str, time: Array | None, path: Path) -> Array:
    """A column as float64, empty cells as NaN; a text in it is an error that shows it."""
    column = table.column(name)
    if not (
        pa.types.is_floating(column.type) or pa.types.is_integer(column.type) or pa.types.is_null(column.type)
    ):
        for row, text in enumerate(column.to_pylist()):
            try:
                float("nan" if text is None else str(text))
            except ValueError:
                at = None if time is None else float(time[row])
                raise LogError(
                    located("is not a number", path=path, column=name, time=at, value=text)
                ) from None
        return np.array([float("nan" if text is None else str(text)) for text in column.to_pylist()])
    return np.asarray(column.cast(pa.float64()).to_numpy(), dtype=np.float64)


def _increasing(time: Array, path: Path, notes: list[Note]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Which rows to keep so that time increases: a few strays go with a note, more is an error."""
    finite = np.isfinite(time) & (np.abs(time) < LATEST)
    latest = np.maximum.accumulate(np.where(finite, time, -np.inf))
    keep = finite.copy()
    keep[1:] &= time[1:] > latest[:-1]
    strays = np.flatnonzero(~keep)
    if strays.size == 0:
        return keep
    first = int(strays[0])
    at = float(time[first - 1]) if first else None
    if strays.size > max(1, STRAY_ROWS * time.size):
        message = f"does not increase in {strays.size} of {time.size} rows, first here"
        valid = "seconds that increase from row to row"
        raise LogError(
            located(message, path=path, column="time", time=at, value=float(time[first]), valid=valid)
        )
    text = (
        f"{path.name}: time does not increase in {strays.size} of {time.size} rows (first after t = {at} s); "
    )
    notes.append(Note("time_order", "warning", text + "those rows are left out"))
    return keep


def _cut(path: Path, what: str) -> Note:
    return Note("file_cut", "warning", f"{path.name} {what}")
