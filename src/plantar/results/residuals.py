"""Reading `residuals.parquet` or `.csv`: what was measured and reconstructed, sample by sample."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import AXES, Array, Mask
from plantar.errors import PlantarError
from plantar.files import atomic_write

FILE_NAMES: Final = ("residuals.parquet", "residuals.csv", "residuals.csv.gz")
SIZE_LIMIT: Final = 2_000_000_000
"""Largest file that is read [bytes]."""

_REQUIRED: Final = ("motion", "foot", "time", "used")
_QUANTITIES: Final = ("deflection", "rate", "torque", "predicted", "offset")


@dataclass(frozen=True)
class Track:
    """One foot in one motion, N samples in time's order.

    `time` (N,) [s]; `used` (N,): whether a sample was used for the fit or the score; `support` (N,): double, single,
    air or transition. `values` has the other columns, (N,) each, NaN where not computed: `pitch.deflection` and
    `roll.deflection` [rad], their `.rate` [rad/s], measured `.torque` and the model's `.predicted` [N·m] about the
    bush. `.offset` [N·m] is the part of the latter that is not the bush's: the offset of the motion or of the stance,
    and the load's torque about a centre that walks show beside its place. `force_z` [N], and the centre of pressure
    `cop_x`, `cop_y` in the sole's frame [m].
    """

    motion: str
    role: str
    foot: str
    time: Array
    used: Mask
    support: NDArray[np.str_]
    values: Mapping[str, Array]

    @property
    def axes(self) -> tuple[str, ...]:
        return tuple(a for a in AXES if f"{a}.deflection" in self.values and f"{a}.torque" in self.values)


def residuals_path(directory: Path) -> Path | None:
    """The residuals in `directory`, or None where there are none."""
    return next((directory / name for name in FILE_NAMES if (directory / name).is_file()), None)


def read_residuals(path: str | os.PathLike[str]) -> tuple[Track, ...]:
    """Every sample that an identification of the feet looked at, beside what its model says of it.

    Args:
        path: `residuals.parquet`, `.csv` or `.csv.gz`; the folder of a result that holds one of them, or the result's
            `.json` in it.

    Returns:
        A `Track` for each motion and foot, in the order in which the file first names them.

    Raises:
        PlantarError: an unreadable file, a missing column or a time that is not finite.

    Example:
        >>> import plantar
        >>> track = plantar.read_residuals("out/feet")[0]
        >>> track.motion, track.foot, track.axes
        ('sway_1', 'left', ('pitch', 'roll'))
        >>> error = track.values["pitch.torque"] - track.values["pitch.predicted"]
        >>> bool(abs(error[track.used]).mean() < 0.5)
        True
    """
    file = Path(path)
    if file.suffix == ".json":
        file = file.parent
    if file.is_dir():
        found = residuals_path(file)
        if found is None:
            raise PlantarError("holds no residuals", path=file, valid=", ".join(FILE_NAMES))
        file = found
    return tracks_of(read_table(file), file)


def tracks_of(table: Any, path: Path | None = None) -> tuple[Track, ...]:
    """The tracks of a residual table (Arrow), as in `FeetResult.residuals`; `path` says in an error where it is from.

    Raises PlantarError for a missing column or a time that is not finite.
    """
    missing = [name for name in _REQUIRED if name not in table.column_names]
    if missing:
        raise PlantarError("is missing", path=path, column=missing[0], valid=", ".join(_REQUIRED))
    names = {"force_z", "cop_x", "cop_y"} | {f"{axis}.{what}" for axis in AXES for what in _QUANTITIES}
    motion, motions = _labels(table, "motion")
    foot, feet = _labels(table, "foot")
    text = {name: _labels(table, name) for name in ("role", "support") if name in table.column_names}
    time = _floats(table, "time", path)
    if not np.isfinite(time).all():
        raise PlantarError("is not finite", path=path, column="time", valid="seconds")
    used = _floats(table, "used", path) > 0.5
    tracks: list[Track] = []
    rows_of: list[NDArray[np.intp]] = []
    for m, motion_name in enumerate(motions):
        for f, foot_name in enumerate(feet):
            rows = np.flatnonzero((motion == m) & (foot == f))
            if not rows.size:
                continue
            rows = rows[np.argsort(time[rows], kind="stable")]
            role = text["role"][1][text["role"][0][rows[0]]] if "role" in text else ""
            support = _text(text.get("support"), rows)
            tracks.append(Track(motion_name, role, foot_name, time[rows], used[rows], support, {}))
            rows_of.append(rows)
    columns: list[dict[str, Array]] = [{} for _ in tracks]
    for name in table.column_names:  # one column in memory at a time beside the tracks
        if name in names:
            values = _floats(table, name, path)
            for own, rows in zip(columns, rows_of, strict=True):
                own[name] = values[rows]
    return tuple(replace(track, values=own) for track, own in zip(tracks, columns, strict=True))


def write_table(table: Any, folder: Path) -> None:
    """Write a residual table (Arrow) as `residuals.parquet` into a folder, whole or not at all; nothing where None."""
    import pyarrow as pa
    import pyarrow.parquet

    if table is None:
        return
    # Measured numbers hardly repeat: a dictionary of them costs time and room.
    text = [column.name for column in table.schema if pa.types.is_dictionary(column.type)]
    with atomic_write(folder / FILE_NAMES[0]) as handle:
        pyarrow.parquet.write_table(table, handle, compression="zstd", use_dictionary=text)


def read_table(path: Path) -> Any:
    """A residual file as an Arrow table; PlantarError where it cannot be read."""
    import pyarrow as pa
    import pyarrow.csv
    import pyarrow.parquet

    try:
        if path.stat().st_size > SIZE_LIMIT:
            raise PlantarError(f"is larger than {SIZE_LIMIT} bytes", path=path, valid="a smaller file")
        if path.suffix == ".parquet":
            return pyarrow.parquet.read_table(path)
        text = {name: pa.string() for name in ("motion", "role", "foot", "support")}
        return pyarrow.csv.read_csv(path, convert_options=pyarrow.csv.ConvertOptions(column_types=text))
    except (OSError, pa.ArrowException) as error:
        raise PlantarError(f"cannot be read: {error}", path=path) from error


def _labels(table: Any, name: str) -> tuple[NDArray[np.intp], list[str]]:
    """A text column as codes and the texts in order of first appearance."""
    import pyarrow as pa

    column = table.column(name)
    if not pa.types.is_dictionary(column.type) or column.null_count:
        column = column.cast("string").combine_chunks().fill_null("").dictionary_encode()
        words = [str(text) for text in column.dictionary.to_pylist()]
        return np.asarray(column.indices, dtype=np.intp), words
    coded = column.unify_dictionaries().combine_chunks()
    codes, texts = np.asarray(coded.indices, dtype=np.intp), coded.dictionary.to_pylist()
    present, first = np.unique(codes, return_index=True)
    order = present[np.argsort(first)]
    place = np.zeros(len(texts), dtype=np.intp)
    place[order] = np.arange(len(order))
    return place[codes], [str(texts[code]) for code in order]


def _text(labels: tuple[NDArray[np.intp], list[str]] | None, rows: NDArray[np.intp]) -> NDArray[np.str_]:
    if labels is None:
        return np.full(rows.size, "", dtype=np.str_)
    codes, texts = labels
    return np.array(texts, dtype=np.str_)[codes[rows]]


def _floats(table: Any, name: str, path: Path | None) -> Array:
    import pyarrow as pa

    try:
        column = table.column(name).combine_chunks()
        plain = pa.types.is_floating(column.type) or pa.types.is_boolean(column.type)
        if plain and column.null_count == 0:  # a cast would import what nothing else needs
            return np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)
        if pa.types.is_string(column.type):
            column = column.cast("bool")
        return np.asarray(column.cast("float64").to_numpy(zero_copy_only=False), dtype=np.float64)
    except pa.ArrowException as error:
        raise PlantarError(f"is not numeric: {error}", path=path, column=name) from error
