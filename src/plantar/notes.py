"""Notes: what was assumed, left out or found odd while work went on."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Literal

Severity = Literal["info", "warning"]
NAMED = 3  # logs of a note that is about many


@dataclass(frozen=True)
class Note:
    """One remark in a result: a stable code for scripts, a severity, and a sentence for people."""

    code: str
    severity: Severity
    text: str

    def to_dict(self) -> dict[str, str]:
        return asdict(self)


class Notes(list[Note]):
    """Notes as they come, while work goes on."""

    def info(self, code: str, text: str) -> None:
        self.append(Note(code, "info", text))

    def warning(self, code: str, text: str) -> None:
        self.append(Note(code, "warning", text))


@dataclass(frozen=True)
class Finding:
    """Something odd in a log; `fatal` where no fit could be trusted."""

    code: str
    text: str
    fatal: bool = False
    severity: Severity = "warning"


def listing(names: Sequence[str], most: int = 8) -> str:
    """Names in a message: `a, b and 3 more` beyond so many."""
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def listed(names: Sequence[str]) -> str:
    """`a`, `a and b`, `a, b and c`."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


@dataclass(frozen=True)
class NoteKind:
    """Notes with one code and severity: the first one's text, and those of the others."""

    code: str
    severity: Severity
    text: str
    others: tuple[str, ...]


def unique(notes: Iterable[Note]) -> tuple[Note, ...]:
    """The notes in their order, each once."""
    return tuple(dict.fromkeys(notes))


def joined(notes: Iterable[Note], logs: Sequence[str]) -> tuple[Note, ...]:
    """The notes, each once; what is said alike of several `logs`, as "log: ...", is one note that names them."""
    said: dict[Note, list[str]] = {}
    for note in notes:
        name, colon, rest = note.text.partition(": ")
        of_a_log = bool(colon) and name in logs
        found = said.setdefault(Note(note.code, note.severity, rest if of_a_log else note.text), [])
        if of_a_log and name not in found:
            found.append(name)
    return tuple(Note(note.code, note.severity, _of_logs(names) + note.text) for note, names in said.items())


def _of_logs(names: Sequence[str]) -> str:
    """How a note begins that is about these logs."""
    if len(names) < 2:
        return "".join(f"{name}: " for name in names)
    some = ", ".join(names[:NAMED]) + (", ..." if len(names) > NAMED else "")
    return f"{len(names)} logs ({some}): "


def kinds(notes: Iterable[Note], severity: Severity) -> tuple[NoteKind, ...]:
    """The notes of one severity by their codes; kinds with fewer notes, which say more each, come first."""
    texts: dict[str, list[str]] = {}
    for note in notes:
        if note.severity == severity:
            texts.setdefault(note.code, []).append(note.text)
    ordered = sorted(texts.items(), key=lambda entry: len(entry[1]))
    return tuple(NoteKind(code, severity, first, tuple(others)) for code, (first, *others) in ordered)
