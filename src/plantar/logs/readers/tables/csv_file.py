"""CSV and CSV.gz as numbers, some lines at a time; a text in a column of numbers is shown where it stands.

Lines of plain numbers are read by the native core, straight to where they stay; whatever else a CSV may hold is
Arrow's, which comes to the same numbers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv

from plantar import _core
from plantar.conventions import Array
from plantar.errors import LogError, located
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.tables.csv_text import Survey, pieces, survey
from plantar.notes import Note

HOLES = ["", "nan", "NaN", "null"]
PARSED = 2**20  # bytes of text that one core parses at a time
NOWHERE = -1  # the place of a column that is not read
UNREADABLE = (pa.ArrowInvalid, pa.ArrowKeyError)

# Which of a table's columns are read.
Choice = Callable[[Sequence[str]], list[str]]


def read_csv(
    path: Path, limit: ReadLimit, choose: Choice, notes: list[Note], *, strict: bool
) -> dict[str, Array]:
    """The chosen columns, (n,) each, in the header's order.

    Of columns with one name the second is called `<name>\\0`. A column that holds a text is an error that shows it;
    where not `strict` it is left out; where `strict`, a column `time` is among the chosen. Raises LogError: broken, or
    larger than `limit`.
    """
    found = survey(path, limit)
    limit.columns(len(found.names))
    names = choose(told_apart(found.names))
    limit.numbers(found.rows, len(names))
    if found.cut is not None:
        notes.append(Note("file_cut", "warning", f"{path.name} {found.cut}"))
    rows = _Rows(path, found, names, strict)
    for piece in pieces(path, found):
        rows.add(piece)
    return rows.finish(notes)


def told_apart(names: Sequence[str]) -> list[str]:
    """The names, with a mark behind each that stood there before."""
    seen: Counter[str] = Counter()
    apart = []
    for name in names:
        apart.append(name + "\0" * seen[name])
        seen[name] += 1
    return apart


class _Rows:
    """Takes lines piece by piece; `values` has one row for each column."""

    def __init__(self, path: Path, found: Survey, names: list[str], strict: bool) -> None:
        self.path, self.found, self.names, self.strict = path, found, names, strict
        self._header = told_apart(found.names)
        self._place = {name: place for place, name in enumerate(names)}
        self._places = [self._place.get(name, NOWHERE) for name in self._header]
        self._values = np.empty((len(names), found.rows))
        self._count = 0
        self._texts: set[str] = set()
        self._cut_row: pa_csv.InvalidRow | None = None
        self._wrong_row: pa_csv.InvalidRow | None = None

    def add(self, piece: bytes) -> None:
        """Parse whole lines. LogError: a row of another length, or a text where a number must stand."""
        plain = None if self._texts else _core.numbers_into(piece, self._places, self._values, self._count)
        if plain is not None:
            self._count += plain
            return
        cut_row = self._cut_row
        try:
            table = self._parse(piece, pa.float64())
        except UNREADABLE:
            self._cut_row = cut_row
            table = self._parse_texts(piece)
        end = self._count + table.num_rows
        if end > self._values.shape[1]:
            raise LogError(located("changed while it was read", path=self.path))
        # Time first: a message about another column tells it.
        for name in sorted(self.names, key=lambda name: name != "time"):
            if name not in self._texts:
                numbers = self._numbers(table.column(name), name)
                self._values[self._place[name], self._count : end] = np.nan if numbers is None else numbers
        self._count = end

    def finish(self, notes: list[Note]) -> dict[str, Array]:
        """The columns, views of one block of memory."""
        if self._cut_row is not None:
            text = f"{self.path.name} ends in an incomplete row; that row is left out"
            notes.append(Note("file_cut", "warning", text))
        return {
            name: values[: self._count]
            for name, values in zip(self.names, self._values, strict=True)
            if name not in self._texts
        }

    def _parse(self, piece: bytes, kind: pa.DataType) -> pa.Table:
        return pa_csv.read_csv(
            pa.BufferReader(piece),
            read_options=pa_csv.ReadOptions(block_size=PARSED, column_names=self._header),
            parse_options=pa_csv.ParseOptions(invalid_row_handler=self._invalid),
            convert_options=pa_csv.ConvertOptions(
                strings_can_be_null=True,
                null_values=HOLES,
                include_columns=self.names,
                column_types=dict.fromkeys(self.names, kind),
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
                raise LogError(located(reason + row.text[:40] + "...", path=self.path)) from error
            raise LogError(located(f"is not a readable CSV: {reason}", path=self.path)) from error

    def _invalid(self, row: pa_csv.InvalidRow) -> str:
        """Only the last row of a file may be short: it was cut."""
        if self._cut_row is None and row.text.encode().rstrip() == self.found.last_line:
            self._cut_row = row
            return "skip"
        self._wrong_row = row
        return "error"

    def _numbers(self, column: pa.ChunkedArray, name: str) -> Array | None:
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
                    self._texts.add(name)
                    return None
                at = None if name == "time" else float(self._values[self._place["time"], self._count + row])
                raise LogError(
                    located("is not a number", path=self.path, column=name, time=at, value=text)
                ) from None
        return numbers
