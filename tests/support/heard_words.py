"""What a test hears: every note, finding and error that comes up in it, beside those that somebody has read.

They are kept for each folder of tests, in its `kept/words.txt`. A text that is not among them fails the test that hears
it; one that is meant is added with `PLANTAR_KEEP=1 pytest FOLDER`. Those that nobody says any more go with the file,
before it is kept anew.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from kept_texts import NUMBER
from plantar.errors import PlantarError
from plantar.notes import Finding, Note

SHARE = 0.05  # of numbers in words, and one of their last digit: other processors round otherwise
KEPT: dict[Path, dict[str, list[str]]] = {}  # lines of each file, by their words


class Heard:
    """The texts of one test, from its first fixture to its last."""

    def __init__(self, folder: Path, temporary: Path) -> None:
        self.kept, self.temporary = folder / "kept" / "words.txt", temporary
        self.texts, self.patch = dict[str, None](), pytest.MonkeyPatch()

    def begin(self) -> None:
        """Listen, in this process alone: what copies of it say would not be heard."""
        self.patch.setattr("plantar.cores.usable_cores", lambda: 1)
        self._listen(Note, lambda one: one.text)
        self._listen(Finding, lambda one: one.text)
        self._listen(PlantarError, str)

    def _listen(self, kind: type, text: Callable[[Any], str]) -> None:
        made = kind.__init__  # type: ignore[misc]

        def heard(one: Any, *given: Any, **named: Any) -> None:
            made(one, *given, **named)
            self.texts[self._anywhere(text(one))] = None

        self.patch.setattr(kind, "__init__", heard)

    def _anywhere(self, text: str) -> str:
        """The text on one line, wherever this test and the packages have their folders."""
        text = " ".join(text.split())
        for folder in (str(self.temporary), tempfile.gettempdir()):
            text = re.sub(re.escape(folder) + r"/[^/\s,:;'\")]+", "FOLDER", text)
        return re.sub(r"/\S*/site-packages/\S*/", "", text)

    def end(self) -> None:
        """AssertionError: a text that is not kept."""
        self.patch.undo()
        if self.kept not in KEPT:
            KEPT[self.kept] = {}
            for line in self.kept.read_text(encoding="utf-8").splitlines() if self.kept.exists() else ():
                KEPT[self.kept].setdefault(words_of(line), []).append(line)
        known = KEPT[self.kept]
        new = [
            text for text in self.texts if not any(near(text, line) for line in known.get(words_of(text), ()))
        ]
        if new and os.environ.get("PLANTAR_KEEP"):
            self._keep(new)
        else:
            assert not new, f"not among {self.kept}: {new[0]}"

    def _keep(self, new: list[str]) -> None:
        for text in new:
            KEPT[self.kept].setdefault(words_of(text), []).append(text)
        lines = sorted(line for own in KEPT[self.kept].values() for line in own)
        self.kept.parent.mkdir(exist_ok=True)
        self.kept.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")


def words_of(text: str) -> str:
    return NUMBER.sub("0", text)


def near(text: str, line: str) -> bool:
    """Whether the numbers of two texts with the same words are nearly the same."""
    pairs = zip(NUMBER.findall(text), NUMBER.findall(line), strict=True)
    return all(
        abs(number(one) - number(other)) <= SHARE * abs(number(other)) + last_digit(other)
        for one, other in pairs
    )


def number(text: str) -> float:
    return float(text.replace("−", "-"))


def last_digit(text: str) -> float:
    """What one more in its last digit is: 1e3 of `12.345e6`."""
    mantissa, _, power = text.lower().partition("e")
    return 1.001 * 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))
