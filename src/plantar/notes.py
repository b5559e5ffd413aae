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


@dataclass(frozen=True)
class Finding:
    """Something odd in a log; `fatal` where no fit could be trusted."""

    code: str
    text: str
    fatal: bool = False
    severity: Severity = "warning"


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
