"""CSV and CSV.gz as numbers, some lines at a time; a text in a column of numbers is shown where it stands.

Lines of plain numbers are read by the native core, straight to where they stay; whatever else a CSV may hold is
Arrow's, which comes to the same numbers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar import _core
from plantar.conventions import Array
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.tables.csv_text import pieces, survey
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.logs.readers.tables.arrow_lines import ArrowLines

NOWHERE = -1
"""The place of a column that is not read."""

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
    header = told_apart([name.strip() for name in found.names])
    names = choose(header)
    limit.numbers(found.rows, len(names))
    if found.units:
        text = f"{path.name}: the line below the names holds no number and is not read, as units: '{found.units[:40]}'"
        notes.append(Note("units_line", "info", text))
    if found.cut is not None:
        notes.append(Note("file_cut", "warning", f"{path.name} {found.cut}"))
    place = {name: row for row, name in enumerate(names)}
    places = [place.get(name, NOWHERE) for name in header]
    values, count, lines = np.empty((len(names), found.rows)), 0, None
    for piece in pieces(path, found):
        plain = None if lines and lines.texts else _core.numbers_into(piece, places, values, count)
        if plain is None:
            lines = lines or _arrow_lines(path, header, names, found.last_line, strict)
            plain = lines.numbers_into(piece, values, count)
        count += plain
    if lines is not None and lines.cut:
        notes.append(
            Note("file_cut", "warning", f"{path.name} ends in an incomplete row; that row is left out")
        )
    texts = lines.texts if lines is not None else set()
    return {name: row[:count] for name, row in zip(names, values, strict=True) if name not in texts}


def _arrow_lines(
    path: Path, header: list[str], names: list[str], last_line: bytes, strict: bool
) -> ArrowLines:
    from plantar.logs.readers.tables.arrow_lines import ArrowLines  # Arrow costs start-up

    return ArrowLines(path, header, names, last_line, strict)


def told_apart(names: Sequence[str]) -> list[str]:
    """The names, with a mark behind each that stood there before."""
    seen: Counter[str] = Counter()
    apart = []
    for name in names:
        apart.append(name + "\0" * seen[name])
        seen[name] += 1
    return apart
