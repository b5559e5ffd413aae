"""How much a log may take: one rule for every format, checked before memory is taken.

1. The numbers of a log (rows x columns, 8 bytes each) fit in the memory given, by default `SHARE` of the machine's.
2. What a file unpacks to is at most `SMALL` and `RATIO` times its own size, so that a small file stays small.
3. A log has at most `COLUMNS` columns.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from pathlib import Path

from plantar.errors import LogError, NoRoom

# Of the machine's memory, or a worker's: what is done with a log needs several times its numbers.
SHARE = 0.25
SMALL = 2**28  # bytes that any file may unpack to: the numbers of ten minutes at 1 kHz in 55 columns
RATIO = 100  # bytes out of a file for each of its own beyond that: recordings shrink to a twentieth at best
COLUMNS = 10_000  # a humanoid with every internal signal of its controller has a few thousand
BLOCK = 2**22  # bytes that readers and writers take at a time
NUMBER = 8
"""Bytes of a float64."""
CONTROL_GROUP = Path("/sys/fs/cgroup/memory.max")  # a container may have less than its machine


class ReadLimit:
    """The limit for one log: a file, a folder, or the `files` that belong to it. `memory` in bytes; `longest`: seconds
    of it that are worked on, so that a reader may leave out the others."""

    def __init__(
        self,
        path: Path,
        memory: int | None = None,
        files: Iterable[Path] | None = None,
        longest: float = math.inf,
    ) -> None:
        self.path = path
        self.longest = longest
        self.memory = usual_memory() if memory is None else memory
        if files is None:
            files = [path] if path.is_file() else path.rglob("*")
        try:
            self._file_size = sum(file.stat().st_size for file in files if file.is_file())
        except OSError as error:
            raise LogError(f"cannot be read: {error.strerror}", path=error.filename or path) from error
        self._unpacked = 0
        self._held = 0

    @property
    def unpacks_to(self) -> int:
        """Bytes that the files may unpack to in all."""
        return SMALL + RATIO * self._file_size

    @property
    def left(self) -> int:
        """Bytes that the files may still unpack to."""
        return self.unpacks_to - self._unpacked

    def columns(self, count: int) -> None:
        """LogError for more columns than any log has; `count` is how many were seen so far."""
        if count > COLUMNS:
            raise LogError(f"has more than {COLUMNS} columns", path=self.path, valid="fewer columns")

    def numbers(self, rows: int, columns: int, kept: int | None = None) -> None:
        """LogError for a table that is too large to hold; `kept`: how many of its rows are, all if left out."""
        size = NUMBER * rows * columns
        message = f"holds {rows} rows x {columns} columns, {shown(size)} as numbers"
        if size > self.unpacks_to:
            raise self.too_much(message)
        self._fits(size if kept is None else NUMBER * kept * columns, message)

    def unpack(self, size: int) -> None:
        """Count bytes that came out of the files, also those that are not kept. LogError: too many."""
        self._unpacked += size
        if self.left < 0:
            raise self.too_much(f"unpacks to {shown(self._unpacked)} or more")

    def hold(self, size: int) -> None:
        """Count bytes that are kept. LogError: more than the memory given."""
        self._held += size
        self._fits(self._held, f"holds {shown(self._held)} of samples or more")

    def too_much(self, message: str) -> LogError:
        """What to raise for a file that is larger inside than a recording of its size can be."""
        valid = (
            f"at most {shown(self.unpacks_to)} from a file of {shown(self._file_size)}: "
            f"{shown(SMALL)} and {RATIO} times its size"
        )
        return LogError(message, path=self.path, valid=valid)

    def _fits(self, size: int, message: str) -> None:
        if size > self.memory:
            valid = (
                f"at most {shown(self.memory)}, or more with --memory (memory= in Python), or a shorter log"
            )
            raise NoRoom(message, path=self.path, valid=valid)


def usual_memory() -> int:
    """Bytes that the numbers of a log may take where nobody says so."""
    return int(SHARE * machine_memory())


def machine_memory() -> int:
    """Bytes of memory of this machine, or of the container that this process runs in."""
    whole = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    try:
        allowed = CONTROL_GROUP.read_text().strip()
    except OSError:
        return whole
    return min(whole, int(allowed)) if allowed.isdigit() else whole


def shown(size: int) -> str:
    """A number of bytes as people say it."""
    for unit, name in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")):
        if size >= unit:
            return f"{size / unit:.3g} {name}"
    return f"{size} bytes"
