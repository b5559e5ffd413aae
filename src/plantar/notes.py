"""Notes: what was assumed, left out or found odd while work went on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Literal

Severity = Literal["info", "warning"]


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
