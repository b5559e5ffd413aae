"""Files of numbers in lines, blocks at a time: what is whole is read, what is not is said."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.logs.readers.read_limit import BLOCK, ReadLimit
from plantar.logs.readers.streams import STRAY_STAMPS
from plantar.notes import Note

HEAD = 2**16  # bytes in which decimal commas show
DECIMAL_COMMA = re.compile(rb"[-+]?\d+,\d+([eE][-+]?\d+)?")
COMMENT = (b"#", b"%", b"//")


def read_numbers(
    path: Path, limit: ReadLimit, notes: list[Note], strip: bytes = b""
) -> tuple[Array, list[str]]:
    """A file's numbers (n, k), and the names of its columns where its first line holds names.

    `strip` are bytes that count as spaces (brackets, commas). Raises LogError: empty, no number, or
    larger than `limit`.
    """
    spaces = bytes.maketrans(strip + b"\t\r,;", b" " * (len(strip) + 4))
    reader = _Lines(path, limit)
    with open(path, "rb") as handle:
        _refuse_decimal_commas(handle.read(HEAD), path)
        handle.seek(0)
        rest = b""
        while block := handle.read(BLOCK):
            text = rest + block
            end = text.rfind(b"\n") + 1
            rest = text[end:]
            if len(rest) > BLOCK:
                raise LogError("holds no lines", path=path, valid="one sample a line")
            reader.add(text[:end].translate(spaces))
    if rest.strip():
        # No end of line: its last number may have lost digits.
        notes.append(
            Note("file_cut", "warning", f"{path.name} ends in the middle of a line; that line is left out")
        )
    return reader.finish(notes), reader.names


class _Lines:
    def __init__(self, path: Path, limit: ReadLimit) -> None:
        self.path, self.limit, self.names = path, limit, list[str]()
        self._width, self._line, self._bad, self._first_bad = 0, 0, 0, 0
        self._blocks: list[Array] = []

    def add(self, text: bytes) -> None:
        lines = [line for line in text.split(b"\n") if line.strip()]
        if not self._width and lines:
            lines = self._start(lines)
        if not lines:
            return
        words = b" ".join(lines).split()
        try:
            if len(words) != len(lines) * self._width:
                raise ValueError
            values = np.array(words, dtype=np.float64).reshape(-1, self._width)
        except ValueError:
            values = self._one_by_one(lines)
        self._line += len(lines)
        self.limit.hold(values.nbytes)
        self._blocks.append(values)

    def _start(self, lines: list[bytes]) -> list[bytes]:
        """Take comments and a line of names off the top; the first line of numbers gives the width."""
        for index, line in enumerate(lines):
            words = line.lstrip(b"#%/ ").split()
            if line.lstrip().startswith(COMMENT) or not is_number(words[0] if words else b""):
                self.names = [word.decode("utf-8", "replace") for word in words]
                continue
            self.limit.columns(len(words))
            self._width, self._line = len(words), self._line + index
            if len(self.names) != self._width:
                self.names = []
            return lines[index:]
        self._line += len(lines)
        return []

    def _one_by_one(self, lines: list[bytes]) -> Array:
        rows = []
        for number, line in enumerate(lines, self._line + 1):
            words = line.split()
            if len(words) == self._width:
                try:
                    rows.append([float(word) for word in words])
                    continue
                except ValueError:
                    pass
            self._bad += 1
            self._first_bad = self._first_bad or number
        return np.array(rows, dtype=np.float64).reshape(-1, self._width)

    def finish(self, notes: list[Note]) -> Array:
        if not self._blocks:
            raise LogError("holds no numbers", path=self.path, valid="one sample a line")
        values = np.concatenate(self._blocks)
        if self._bad:
            where = f"line {self._first_bad}" + (f" and {self._bad - 1} more" if self._bad > 1 else "")
            if self._bad > max(1, STRAY_STAMPS * self._line):
                raise LogError(f"{where} do not hold {self._width} numbers", path=self.path)
            text = f"{self.path.name}: {where} left out: not {self._width} numbers"
            notes.append(Note("lines_broken", "warning", text))
        return values


def _refuse_decimal_commas(head: bytes, path: Path) -> None:
    """LogError where the numbers of a line are parted by something else and hold commas, and no points."""
    for line in head.splitlines():
        words = re.split(rb"[;\s]+", line.strip())
        if len(words) > 1 and b"." not in line and any(DECIMAL_COMMA.fullmatch(word) for word in words):
            told = line.decode("utf-8", "replace").strip()[:40]
            raise LogError(f"has decimal commas: '{told}'", path=path, valid="decimal points")


def is_number(word: str | bytes) -> bool:
    """Whether Python reads a word as a number, NaN and infinity among them."""
    try:
        float(word)
    except ValueError:
        return False
    return True
