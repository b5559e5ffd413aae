"""One careless change of the source, and the tests that should notice it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

LIMITS = "docs/test_limits.py"


class StaleMutant(Exception):
    """The text that a mutant replaces is not in its file exactly once: the list has to follow the source."""


@dataclass(frozen=True)
class Mutant:
    """In `file` (below `src/plantar`), `before` becomes `after`; `why` says in words what then is wrong.

    `tests` are folders or files below `tests`; the room's own, nearest first, where none are named.
    """

    file: str
    why: str
    before: str
    after: str
    tests: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        return f"{self.file.removesuffix('.py')}: {self.why}"

    def changed(self, text: str) -> str:
        """The file's text with the change. StaleMutant where `before` is not there exactly once."""
        count = text.count(self.before)
        if count != 1:
            raise StaleMutant(f"src/plantar/{self.file}: found {count} times, not once: {self.before!r}")
        return text.replace(self.before, self.after)

    def judges(self, tests: Path, *, near: bool = False) -> tuple[str, ...]:
        """What pytest is to run, relative to the folder `tests`: the page of limits, the folder that mirrors the
        file's and its room. `near`: the mirroring folder alone, which is quicker.
        """
        if self.tests:
            return self.tests
        folder = Path(self.file).parent
        mirrored = [
            part for part in (folder, *folder.parents) if part != Path(".") and (tests / part).is_dir()
        ]
        rooms = tuple(str(part) for part in mirrored)
        return rooms[:1] if near else (LIMITS, *rooms)
