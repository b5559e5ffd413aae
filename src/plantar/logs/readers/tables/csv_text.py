"""The text of a CSV or CSV.gz in blocks: surveyed once, so that what is then kept is known to fit."""

from __future__ import annotations

import codecs
import csv
import gzip
import zlib
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from plantar.errors import LogError
from plantar.logs.readers.read_limit import BLOCK, COLUMNS, ReadLimit
from plantar.logs.readers.text_numbers import is_number

PIECE = 2**23  # bytes of whole lines at a time: few enough to hold, enough for two cores
LINE_LIMIT = 2**20  # bytes of one line: COLUMNS numbers at full precision need a quarter of it
MARK = codecs.BOM_UTF8
# What pandas, R, databases, spreadsheets and the C libraries write where nothing was recorded.
HOLES = [
    *("", "nan", "NaN", "null", "NULL", "None", "NA", "<NA>", "N/A", "n/a", "#N/A"),
    *("-nan", "-NaN", "nan(ind)", "-nan(ind)", "1.#QNAN", "-1.#IND"),
]


@dataclass(frozen=True)
class Survey:
    """Names of the columns, where in the text its rows begin and end, and how many there are at most.

    `units` is the second line of a header that has one; `cut` says what is missing at the end of the file, if anything
    is.
    """

    names: list[str]
    units: str
    first: int
    end: int
    rows: int
    last_line: bytes
    cut: str | None


def survey(path: Path, limit: ReadLimit) -> Survey:
    """Walk over the whole text without keeping it. LogError: empty, no text, or more than `limit` allows."""
    check = codecs.getincrementaldecoder("utf-8")()
    head, size, rows, end = b"", 0, 0, 0
    behind, held = deque[bytes](), 0  # the last blocks: a line or more
    names: list[str] | None = None
    units, first = "", 0
    whole = True  # no character waits for its end in the next block
    text = _Text(path)
    for block in text.blocks():
        limit.unpack(len(block))
        try:
            if not (block.isascii() and whole):
                check.decode(block)
                whole = not check.getstate()[0]
        except UnicodeDecodeError as error:
            line = 1 + rows + (0 if names is None else 1) + block.count(b"\n", 0, error.start)
            valid = "a CSV saved as UTF-8, which spreadsheets offer; one packed by gzip ends in .csv.gz"
            raise LogError(f"is not UTF-8 text at line {line}", path=path, valid=valid) from error
        behind.append(block)
        held += len(block)
        while held - len(behind[0]) >= LINE_LIMIT:
            held -= len(behind.popleft())
        size += len(block)
        if names is None:
            head += block
            found = _header(head, path, limit)
            if found is None:
                continue
            names, units, first = found
            rows, end = _ends(head[first:]), size - len(block) + _after_last(block)
        elif cut := _after_last(block):
            rows, end = rows + _ends(block), size - len(block) + cut
        if size - end > LINE_LIMIT:
            raise _long_line(path)
    if names is None:
        if not head.strip(MARK + b" \t\r\n"):
            raise LogError("is empty", path=path, valid="a header and one row a sample")
        raise LogError("holds no samples", path=path, valid="a header and one row a sample")
    cut_by = text.cut or (None if end == size else "ends in the middle of a line; that line is left out")
    tail = b"".join(behind)[-LINE_LIMIT:]
    last = tail[: len(tail) - (size - end)].rstrip().rsplit(b"\n", 1)[-1]
    return Survey(names, units, first, end, rows, last, cut_by)


def pieces(path: Path, found: Survey) -> Iterator[bytes]:
    """The rows of a surveyed text, some whole lines at a time."""
    kept: list[bytes] = []
    held = at = 0
    for block in _Text(path).blocks():
        part = block[max(found.first - at, 0) : max(found.end - at, 0)]
        at += len(block)
        if held + len(part) >= PIECE and (cut := _after_last(part)):
            yield b"".join((*kept, part[:cut]))
            kept, part, held = [], part[cut:], 0
        kept.append(part)
        held += len(part)
        if at >= found.end:
            break
    if rest := b"".join(kept):
        yield rest


def _header(head: bytes, path: Path, limit: ReadLimit) -> tuple[list[str], str, int] | None:
    """The names in the first line that is not blank, a line of units below it, and where the rows begin; None where it
    goes on."""
    at = len(head) - len(head.removeprefix(MARK).lstrip(b" \t\r\n"))
    end = _end_of_line(head, at)
    line = head[at:end]
    if line.count(b",") >= COLUMNS:
        limit.columns(line.count(b",") + 1)
    if len(line) > LINE_LIMIT or (not line and len(head) > LINE_LIMIT):
        raise _long_line(path)
    if end is None:
        return None
    below = end + len(head[end:]) - len(head[end:].lstrip(b"\r\n"))
    second = _end_of_line(head, below)
    if second is None and len(head) - below <= LINE_LIMIT:
        return None
    try:
        names = next(csv.reader([line.decode()]))
        units = head[below:second].decode("utf-8", "replace")
        if second is not None and _is_text(next(csv.reader([units])), len(names)):
            return names, units, second + 1
        return names, "", end + 1
    except csv.Error as error:
        raise LogError(f"has no readable header: {error}", path=path) from error


def _end_of_line(text: bytes, at: int) -> int | None:
    ends = [place for mark in (b"\n", b"\r") if (place := text.find(mark, at)) >= 0]
    return min(ends, default=None)


def _is_text(cells: list[str], columns: int) -> bool:
    """Whether a line holds texts alone, as units below the names; "1" is a unit too, an empty cell may be one."""
    texts = [text for cell in cells if (text := cell.strip()) not in ("", "1")]
    return (
        len(cells) == columns and bool(texts) and not any(is_number(text) or text in HOLES for text in texts)
    )


def _ends(text: bytes) -> int:
    """How many lines end in a text, whatever ends them."""
    returns = text.count(b"\r") if b"\r" in text else 0
    return text.count(b"\n") + returns - (text.count(b"\r\n") if returns else 0)


def _after_last(text: bytes) -> int:
    """Where the last line that ends in a text ends."""
    return max(text.rfind(b"\n"), text.rfind(b"\r")) + 1


def _long_line(path: Path) -> LogError:
    return LogError(f"has a line of more than {LINE_LIMIT} bytes", path=path, valid="one sample a line")


class _Text:
    """The text of a file in blocks; a gzip file that was cut gives what is whole, and `cut` says so."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.cut: str | None = None

    def blocks(self) -> Iterator[bytes]:
        packed = self._path.name.lower().endswith(".gz")
        try:
            with gzip.open(self._path) if packed else open(self._path, "rb") as handle:
                yield from iter(lambda: handle.read1(BLOCK), b"")
        except EOFError:
            self.cut = "is a cut gzip file; what is whole was read"
        except (zlib.error, gzip.BadGzipFile) as error:
            raise LogError(f"is not a readable gzip file: {error}", path=self._path) from error
        except OSError as error:
            raise LogError(f"cannot be read: {error.strerror}", path=self._path) from error
