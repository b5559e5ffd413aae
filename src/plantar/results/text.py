"""A result in plain text and in a notebook: aligned columns, values rounded to their uncertainty."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from plantar.notes import Note

MOST_WARNINGS = 8  # of a result in text; the rest is counted
CELL = 'style="text-align:left;padding:2px 10px"'


def columns(rows: Iterable[Sequence[str]], indent: str = "  ") -> list[str]:
    """Rows of cells as lines in which every column begins at one place."""
    cells = [[str(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return [
        (indent + "  ".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True))).rstrip()
        for row in cells
    ]


def warnings(notes: Sequence[Note]) -> list[str]:
    """The warnings among `notes`, at most a handful; how many there are beside."""
    texts = [note.text for note in notes if note.severity == "warning"]
    lines = [f"  warning: {text}" for text in texts[:MOST_WARNINGS]]
    rest = len(notes) - len(lines)
    return [*lines, f"  further notes, in .notes: {rest}"] if rest else lines


def html_table(caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table for a notebook; every text is escaped."""
    head = "".join(f"<th {CELL}>{escape(name)}</th>" for name in heads)
    filled = ("".join(f"<td {CELL}>{escape(cell)}</td>" for cell in row) for row in rows)
    body = "".join(f"<tr>{cells}</tr>" for cells in filled)
    title = f'<caption style="text-align:left;padding:4px 10px">{escape(caption)}</caption>'
    return f"<table>{title}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def html_lines(lines: Iterable[str]) -> str:
    """Lines of text under a table."""
    return "".join(
        f'<div style="padding:1px 10px 1px {10 + 10 * (len(line) - len(line.lstrip()))}px">{escape(line.strip())}</div>'
        for line in lines
    )
