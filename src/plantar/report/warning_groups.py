"""Warnings as they stand above a verdict: those of one kind together, the first of them in full."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from plantar.notes import Note


@dataclass(frozen=True)
class WarningGroup:
    """Warnings with one code: the first one's text, and those of the others."""

    code: str
    text: str
    others: tuple[str, ...]


def warning_groups(notes: Sequence[Note]) -> tuple[WarningGroup, ...]:
    """The warnings among `notes` by their codes; kinds with fewer notes, which say more each, come first."""
    texts: dict[str, list[str]] = {}
    for note in notes:
        if note.severity == "warning":
            texts.setdefault(note.code, []).append(note.text)
    ordered = sorted(texts.items(), key=lambda entry: len(entry[1]))
    return tuple(WarningGroup(code, first, tuple(others)) for code, (first, *others) in ordered)
