"""What a report is made of: tables, pictures and sections, before any HTML."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

MediaType = Literal["image/svg+xml", "image/png"]
Mark = Literal["", "good", "weak", "bad"]


@dataclass(frozen=True)
class Figure:
    """A picture (SVG or PNG) with a title and a caption.

    It is embedded as an image, so scripts in an SVG do not run. `description` is read out in place of the
    picture; it is the title where left empty.
    """

    title: str
    caption: str
    content: bytes = field(repr=False)
    media_type: MediaType = "image/svg+xml"
    description: str = ""

    @property
    def data_uri(self) -> str:
        return f"data:{self.media_type};base64,{base64.b64encode(self.content).decode('ascii')}"


@dataclass(frozen=True)
class Cell:
    """One entry of a table: text, an optional mark (said by colour and by the text) and a text on hover."""

    text: str
    mark: Mark = ""
    hover: str = ""


@dataclass(frozen=True)
class Column:
    """A column's heading and unit; numbers are set flush right."""

    heading: str
    unit: str = ""
    numeric: bool = True

    @classmethod
    def words(cls, *headings: str) -> list[Column]:
        """Columns of text."""
        return [cls(heading, numeric=False) for heading in headings]


@dataclass(frozen=True)
class Table:
    """A captioned table. `rows` hold cells or plain strings; `folded` hides a long one behind its caption."""

    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    remark: str = ""
    folded: bool = False

    @classmethod
    def of(
        cls,
        caption: str,
        columns: Sequence[Column],
        rows: Sequence[Sequence[Cell | str]],
        *,
        remark: str = "",
        folded: bool = False,
    ) -> Table:
        cells = tuple(tuple(c if isinstance(c, Cell) else Cell(c) for c in row) for row in rows)
        return cls(caption, tuple(columns), cells, remark, folded)


@dataclass(frozen=True)
class Section:
    """An extra part of a report: paragraphs of plain text, then tables, then pictures."""

    title: str
    paragraphs: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    figures: tuple[Figure, ...] = ()
