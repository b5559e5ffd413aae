"""Files of columns (OpenHRP's astate.log and its like, NPZ, tables with other names) through `columns:`."""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.files import sha256
from plantar.logs.motion_log import COLUMN, MotionLog
from plantar.logs.readers import motion_name
from plantar.logs.readers.column_map import apply, maps_columns
from plantar.logs.readers.read_limit import COLUMNS, NUMBER, ReadLimit
from plantar.logs.readers.streams import Stream, increasing
from plantar.logs.readers.tables import table
from plantar.logs.readers.text_numbers import read_numbers
from plantar.notes import Note, listing

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

# As NumPy writes them; others may ask for gigabytes to unpack.
PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
BROKEN = (zipfile.BadZipFile, zlib.error, OSError, ValueError, EOFError, RuntimeError, KeyError)


def read(path: Path, robot: RobotModel | None, limit: ReadLimit) -> MotionLog:
    """Read a file of columns by the robot file's map. LogError: broken, or no map where one is needed, too large."""
    notes: list[Note] = []
    ending = path.name.lower()
    if ending.endswith(".npz"):
        columns = _read_npz(path, limit, notes)
    elif ending.endswith((".csv", ".csv.gz", ".parquet")):
        columns = table.read_raw(path, limit, notes)
    else:
        values, names = read_numbers(path, limit, notes)
        columns = {name: values[:, i] for i, name in enumerate(names or map(str, range(values.shape[1])))}
    time, mapped = _mapped(columns, robot, path)
    if not mapped:
        valid = "columns.<column of plantar>: <column of the file>, in the robot file"
        raise LogError("has no column of a known name", path=path, valid=valid)
    stream = increasing(Stream(path.name, time, mapped), path, notes)
    return MotionLog(motion_name(path), stream.time, stream.columns, path, sha256(path), tuple(notes))


def _mapped(
    columns: Mapping[str, Array], robot: RobotModel | None, path: Path
) -> tuple[Array, dict[str, Array]]:
    if robot is not None and maps_columns(robot):
        return apply(columns, robot, path)
    if "time" not in columns:
        valid = "a column 'time', or columns.time in the robot file"
        raise LogError("is missing", path=path, column="time", valid=valid)
    return columns["time"], {name: values for name, values in columns.items() if COLUMN.fullmatch(name)}


def _read_npz(path: Path, limit: ReadLimit, notes: list[Note]) -> dict[str, Array]:
    """Every numeric array of an NPZ, those of two dimensions column by column as name.0, name.1, ...

    Nothing is unpickled; sizes are checked before memory is asked for. A damaged array is left out with a note.
    """
    arrays: dict[str, Array] = {}
    try:
        with zipfile.ZipFile(path) as archive:
            entries = [entry for entry in archive.infolist() if entry.filename.endswith(".npy")]
            limit.unpack(sum(entry.file_size for entry in entries))
            for entry in entries:
                name = entry.filename.removesuffix(".npy")
                try:
                    if entry.compress_type not in PACKED:
                        raise ValueError("neither stored nor deflated")
                    arrays |= _by_column(name, _read_npy(archive.read(entry), limit))
                except BROKEN as error:
                    reason = " ".join(str(error).split())[:80]
                    notes.append(
                        Note("array_broken", "warning", f"{path.name}: '{name[:80]}' is left out: {reason}")
                    )
    except BROKEN as error:
        reason = " ".join(str(error).split())[:120]
        raise LogError(f"is not a readable NPZ file: {reason}", path=path) from error
    usual = max((values.size for values in arrays.values()), default=0)
    usual = arrays["time"].size if "time" in arrays else usual
    others = [f"{name} ({values.size})" for name, values in arrays.items() if values.size != usual]
    if others:
        text = f"{path.name}: not of {usual} samples as the recording has, left out: {listing(others)}"
        notes.append(Note("array_length", "warning", text))
    return {name: values for name, values in arrays.items() if values.size == usual}


def _by_column(name: str, array: Array | None) -> dict[str, Array]:
    if array is None:
        return {}
    if array.ndim == 1:
        return {name: array}
    return {f"{name}.{index}": array[:, index] for index in range(min(array.shape[1], COLUMNS))}


def _read_npy(content: bytes, limit: ReadLimit) -> Array | None:
    handle = BytesIO(content)
    version = np.lib.format.read_magic(handle)
    header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, fortran, kind = header(handle)
    if kind.kind not in "fiub" or len(shape) not in (1, 2):
        return None
    count = int(np.prod(shape, dtype=object))
    if count * kind.itemsize != len(content) - handle.tell():
        raise ValueError("an array's shape does not agree with its data")
    limit.numbers(count, 1)
    limit.hold(NUMBER * count)
    values = np.frombuffer(content, kind, count, handle.tell()).astype(np.float64)
    return values.reshape(shape, order="F" if fortran else "C")
