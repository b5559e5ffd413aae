"""Parquet as numbers: what the footer claims and what the pages unpack to is checked, then rows come in batches."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pa_parquet

from plantar.conventions import Array, Mask
from plantar.errors import LogError
from plantar.logs.readers.read_limit import COLUMNS, ReadLimit
from plantar.logs.readers.tables.csv_file import Choice
from plantar.logs.readers.tables.parquet_pages import BrokenPage, check_pages

BATCH = 2**16  # rows at a time
BUFFER = 2**18  # bytes of a column read at a time
TOO_MANY = "Exceeded size limit"  # what the footer's decoder says of a longer list


def read_parquet(
    path: Path, limit: ReadLimit, choose: Choice, rows: Mask | None, *, strict: bool
) -> dict[str, Array]:
    """The chosen columns, (n,) each, in the file's order; these `rows` of them, all if left out.

    A column of something else than numbers is an error; where not `strict` it is left out. Raises LogError: broken,
    or larger than `limit`.
    """
    try:
        # Lists in the footer name columns and groups of rows; memory for them is taken by the length they claim.
        with pa_parquet.ParquetFile(
            path, pre_buffer=False, buffer_size=BUFFER, thrift_container_size_limit=2 * COLUMNS
        ) as source:
            schema = source.schema_arrow
            limit.columns(len(schema.names))
            names = choose(schema.names)
            numeric = [name for name in names if _holds_numbers(schema, name, path, strict)]
            kept = None if rows is None else int(np.count_nonzero(rows))
            limit.numbers(source.metadata.num_rows, len(numeric), kept)
            _check_unpacked(path, source.metadata, numeric, limit)
            return _columns(path, source.metadata, numeric, rows)
    except (pa.ArrowException, OSError, UnicodeDecodeError, BrokenPage) as error:
        reason = str(error).splitlines()[0]
        if TOO_MANY in reason:
            message = f"claims more than {2 * COLUMNS} columns or groups of rows"
            raise LogError(message, path=path, valid=f"at most {COLUMNS} columns") from error
        raise LogError(f"is not a readable Parquet file: {reason}", path=path) from error
    finally:
        # Arrow keeps what it has freed: with many logs, a tenth of all memory.
        pa.default_memory_pool().release_unused()


def _holds_numbers(schema: pa.Schema, name: str, path: Path, strict: bool) -> bool:
    places = schema.get_all_field_indices(name)
    kind = schema.field(places[0]).type
    numeric = any(
        is_kind(kind)
        for is_kind in (pa.types.is_floating, pa.types.is_integer, pa.types.is_decimal, pa.types.is_null)
    )
    numeric = numeric or (_tick(kind) is not None and (name == "time" or not strict))
    if numeric and len(places) > 1:
        raise LogError("stands twice in the header", path=path, column=name)
    if numeric and any(other.startswith(f"{name}.") for other in schema.names):
        # Arrow would read what is called <name>.<more> with it, unchecked.
        raise LogError("is also the beginning of another column's name", path=path, column=name)
    if strict and not numeric:
        raise LogError(f"holds {kind}", path=path, column=name, valid="numbers")
    return numeric


def _tick(kind: pa.DataType) -> float | None:
    """What one is of a column of dates or durations [s]; None of another one."""
    dated = pa.types.is_timestamp(kind) or pa.types.is_duration(kind)
    return {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[kind.unit] if dated else None


def _check_unpacked(
    path: Path, metadata: pa_parquet.FileMetaData, names: Sequence[str], limit: ReadLimit
) -> None:
    """LogError when the pages of the columns that will be read unpack to more than `limit` allows."""
    wanted = set(names)
    with open(path, "rb") as handle:
        for index in range(metadata.num_row_groups):
            group = metadata.row_group(index)
            for place in range(group.num_columns):
                column = group.column(place)
                if column.path_in_schema in wanted:
                    first = column.dictionary_page_offset if column.has_dictionary_page else None
                    start = min(offset for offset in (first, column.data_page_offset) if offset is not None)
                    check_pages(handle, start, column.total_compressed_size, limit)


def _columns(
    path: Path, metadata: pa_parquet.FileMetaData, names: list[str], kept: Mask | None
) -> dict[str, Array]:
    """A column for each core after another: pages of all at once would take as much memory as their numbers."""
    rows, together = metadata.num_rows, pa.cpu_count()
    if kept is not None and len(kept) != rows:
        raise LogError(
            f"had {len(kept)} rows a moment ago and has {rows} now", path=path, valid="a file that is closed"
        )
    values = np.empty((len(names), rows if kept is None else np.count_nonzero(kept)))

    def fill(first: int) -> None:
        with pa_parquet.ParquetFile(path, metadata=metadata, pre_buffer=False, buffer_size=BUFFER) as source:
            for row, name in zip(values[first::together], names[first::together], strict=True):
                count = place = 0
                for batch in source.iter_batches(BATCH, columns=[name], use_threads=False):
                    end = count + batch.num_rows
                    if end > rows:
                        break
                    column = batch.column(name)
                    tick = _tick(column.type)
                    column = column if tick is None else column.cast(pa.int64())
                    # Not safely: nanoseconds since 1970 are more than a float64 tells apart, and near enough.
                    numbers = column.cast(pa.float64(), safe=False).to_numpy(zero_copy_only=False)
                    numbers = numbers if tick is None else tick * numbers
                    numbers = numbers if kept is None else numbers[kept[count:end]]
                    row[place : place + len(numbers)] = numbers
                    count, place = end, place + len(numbers)
                if count != rows:
                    message = f"does not hold the {rows} rows that the file claims"
                    raise LogError(message, path=path, column=name)

    with ThreadPoolExecutor(together) as pool:
        list(pool.map(fill, range(together)))
    return dict(zip(names, values, strict=True))
