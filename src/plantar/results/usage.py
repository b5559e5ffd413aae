"""How much of each log was used, and why the rest was not."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from plantar.contact.phases import Phase

LEAST = 0.05  # s: of less nobody needs a reason


@dataclass(frozen=True)
class UsedShare:
    """Seconds of one foot in one motion, those of them that were used, and those left out by the kind of their reason:
    what stands before the colon in `in the air: no load on this foot`."""

    motion: str
    foot: str
    seconds: float
    used: float
    left_out: Mapping[str, float]

    @property
    def reasons(self) -> str:
        """What was left out, in one line: `tips (2.0 s); in the air (4.0 s)`."""
        told = (f"{reason} ({spent:.1f} s)" for reason, spent in self.left_out.items() if spent >= LEAST)
        return "; ".join(told)

    def to_dict(self) -> dict[str, Any]:
        """As `plantar diagnose --json` prints it."""
        head = {"motion": self.motion, "foot": self.foot, "seconds": self.seconds}
        return head | {"served": self.used, "reasons": self.reasons}


def used_shares(phases: Iterable[Phase]) -> list[UsedShare]:
    """A share for each motion and foot of a result's phases."""
    seconds: dict[tuple[str, str], float] = defaultdict(float)
    used: dict[tuple[str, str], float] = defaultdict(float)
    left_out: dict[tuple[str, str], dict[str, float]] = defaultdict(lambda: defaultdict(float))
    for phase in phases:
        key, duration = (phase.motion, phase.foot), phase.end - phase.start
        seconds[key] += duration
        if phase.used:
            used[key] += duration
        elif duration > 0:
            left_out[key][(phase.reason or phase.support).partition(":")[0]] += duration
    return [UsedShare(*key, total, used[key], left_out[key]) for key, total in seconds.items()]
