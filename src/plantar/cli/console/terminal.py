"""What commands share: progress on stderr, tables on stdout."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from plantar.notes import Note, NoteKind, kinds
from plantar.results.io import dump_json

if TYPE_CHECKING:  # what prints nothing does not import it
    from rich.console import Console
    from rich.table import Table

VERDICT_STYLE = {"usable": "green", "weak": "yellow", "unidentifiable": "red"}
SEVERITY_STYLE = {"info": "dim", "warning": "yellow"}
SCREENFUL = 16  # lines of notes
PIPE_WIDTH = 150  # columns where stdout is not a terminal
WORD = re.compile(r"[^\W\d_]{3}")


def console() -> Console:
    """Where tables go: stdout, wide enough for a table also in a pipe."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else PIPE_WIDTH, highlight=False)


def progress(quiet: bool) -> Callable[[str], None]:
    """A function that shows one step of long work on stderr: in place on a terminal, as lines elsewhere."""
    if quiet:
        return lambda _: None
    if not sys.stderr.isatty():
        return lambda line: print(f"  {line}", file=sys.stderr, flush=True)
    return lambda line: print(f"\r\033[K  {line}", end="", file=sys.stderr, flush=True)


def end_progress(quiet: bool) -> None:
    """Clear the progress line of a terminal."""
    if not quiet and sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr, flush=True)


def table(
    title: str, columns: Sequence[str], rows: Iterable[Sequence[str]], styles: Sequence[str] = ()
) -> Table:
    """A table of text cells; numbers to the right, markup in any text escaped. `styles` colours whole rows."""
    from rich.markup import escape
    from rich.table import Table

    drawn = Table(title=escape(title), title_justify="left", header_style="bold", box=None, pad_edge=False)
    cells = [[escape(str(cell)) for cell in row] for row in rows]
    for place, name in enumerate(columns):
        numeric = bool(cells) and all(_numeric(row[place]) for row in cells)
        drawn.add_column(escape(name), justify="right" if numeric else "left", overflow="fold")  # never cut
    for place, row in enumerate(cells):
        drawn.add_row(*row, style=styles[place] if place < len(styles) else None)
    return drawn


def print_json(**content: Any) -> None:
    """What a command says, for a script."""
    print(dump_json(content), end="")


def print_notes(out: Console, notes: Sequence[Note], room: int = SCREENFUL) -> None:
    """Notes by their kinds, each warning in full and before the others, of other kinds the first; those that `room`
    lines hold, the first in any case, the rest counted."""
    from rich.text import Text

    warnings = [note for note in notes if note.severity == "warning"]
    lines = [Text(f"note (warning): {note.text}", SEVERITY_STYLE["warning"]) for note in warnings]
    remarks = kinds(notes, "info")
    lines += [Text(f"note (info): {_remark(kind)}", SEVERITY_STYLE["info"]) for kind in remarks]
    for place, line in enumerate(lines):
        room -= len(line.wrap(out, out.width))
        if room < 0 and place:
            out.print(f"[dim]and {len(lines) - place} more notes, in the result's notes[/]")
            break
        out.print(line)


def _remark(kind: NoteKind) -> str:
    more = f" (and {len(kind.others)} more like it, in the result's notes)" if kind.others else ""
    return f"{kind.text}{more}"


def _numeric(cell: str) -> bool:
    """Whether a cell is numbers and their units, not a sentence that begins with a number."""
    return not cell or (cell[0] in "0123456789-−+–±." and not WORD.search(cell))
