"""Lines of a CSV that hold more than plain numbers, read by Arrow: empty cells, quotes, texts, a cut last row."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.logs.readers.tables.csv_text import HOLES

PARSED = 2**20  # bytes of text that one core parses at a time
UNREADABLE = (pa.ArrowInvalid, pa.ArrowKeyError)


class ArrowLines:
    """Reads the columns `names` of lines under a `header`, a column `time` first so that messages about others tell it.

    `texts`: columns that turned out to hold a text, where not `strict`; `cut`: whether the file's `last_line` is short.
    """

    def __init__(
        self, path: Path, header: list[str], names: list[str], last_line: bytes, strict: bool
    ) -> None:
        self.path, self.strict = path, strict
        self.texts: set[str] = set()
        self._header, self._last_line = header, last_line
        self._place = {name: place for place, name in enumerate(names)}
        self._cut_row: pa_csv.InvalidRow | None = None
        self._wrong_row: pa_csv.InvalidRow | None = None

    @property
    def cut(self) -> bool:
        return self._cut_row is not None

    def numbers_into(self, piece: bytes, values: Array, first: int) -> int:
        """Put whole lines into `values` (columns, n) from sample `first` on; how many there were.

        LogError: a row of another length, or a text where a number must stand.
        """
        cut_row = self._cut_row
        try:
            table = self._parse(piece, pa.float64())
        except UNREADABLE:
            self._cut_row = cut_row
            table = self._parse_texts(piece)
        end = first + int(table.num_rows)
        if end > values.shape[1]:
            raise LogError("changed while it was read", path=self.path)
        for name in sorted(self._place, key=lambda name: name != "time"):
            if name not in self.texts:
                time = None if name == "time" else values[self._place.get("time", 0), first:end]
                numbers = self._numbers(table.column(name), name, time)
                values[self._place[name], first:end] = np.nan if numbers is None else numbers
        # Arrow keeps what it has freed: with many logs, a tenth of all memory.
        del table
        pa.default_memory_pool().release_unused()
        return end - first

    def _parse(self, piece: bytes, kind: pa.DataType) -> pa.Table:
        return pa_csv.read_csv(
            pa.BufferReader(piece),
            read_options=pa_csv.ReadOptions(block_size=PARSED, column_names=self._header),
            parse_options=pa_csv.ParseOptions(invalid_row_handler=self._invalid),
            convert_options=pa_csv.ConvertOptions(
                strings_can_be_null=True,
                null_values=HOLES,
                include_columns=[*self._place],
                column_types=dict.fromkeys(self._place, kind),
            ),
        )

    def _parse_texts(self, piece: bytes) -> pa.Table:
        try:
            return self._parse(piece, pa.string())
        except UNREADABLE as error:
            reason = str(error).splitlines()[0]
            if (row := self._wrong_row) is not None:
                reason = (
                    f"a row has {row.actual_columns} values where the header has {row.expected_columns}: "
                )
                valid = "one line of column names, then as many values in each row"
                raise LogError(f"{reason}{row.text[:40]}...", path=self.path, valid=valid) from error
            raise LogError(f"is not a readable CSV: {reason}", path=self.path) from error

    def _invalid(self, row: pa_csv.InvalidRow) -> str:
        """Only the last row of a file may be short: it was cut."""
        if self._cut_row is None and row.text.encode().rstrip() == self._last_line:
            self._cut_row = row
            return "skip"
        self._wrong_row = row
        return "error"

    def _numbers(self, column: pa.ChunkedArray, name: str, time: Array | None) -> Array | None:
        """A piece of a column as float64, empty cells as NaN; None where it holds a text and need not be read."""
        if pa.types.is_floating(column.type):  # a cast would import what nothing else needs
            return np.asarray(column.to_numpy())
        try:
            return np.asarray(column.cast(pa.float64()).to_numpy(), dtype=np.float64)
        except pa.ArrowInvalid:
            pass  # Python reads more spellings, and finds the first text
        numbers = np.empty(len(column))
        for row, text in enumerate(column.to_pylist()):
            try:
                numbers[row] = float("nan" if text is None else text)
            except ValueError:
                if not self.strict:
                    self.texts.add(name)
                    return None
                at = None if time is None else float(time[row])
                valid = "a number, or an empty cell where nothing was recorded"
                raise LogError(
                    "is not a number", path=self.path, column=name, time=at, value=text, valid=valid
                ) from None
        return numbers
