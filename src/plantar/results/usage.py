"""How much of each log was used, and why the rest was not."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

from plantar.contact.phases import Phase

LEAST = 0.05  # s: of less nobody needs a reason


def used_shares(phases: Iterable[Phase]) -> list[dict[str, Any]]:
    """Seconds, seconds that were used and the reasons for the others, by motion and foot, from a result's phases."""
    seconds: dict[tuple[str, str], float] = defaultdict(float)
    used: dict[tuple[str, str], float] = defaultdict(float)
    reasons: dict[tuple[str, str], dict[str, float]] = defaultdict(lambda: defaultdict(float))
    for phase in phases:
        key, duration = (phase.motion, phase.foot), phase.end - phase.start
        seconds[key] += duration
        if phase.used:
            used[key] += duration
        else:
            reasons[key][phase.reason or ""] += duration
    return [
        {
            "motion": motion,
            "foot": foot,
            "seconds": total,
            "served": used[motion, foot],
            "reasons": "; ".join(
                f"{reason} ({spent:.1f} s)"
                for reason, spent in reasons[motion, foot].items()
                if spent >= LEAST
            ),
        }
        for (motion, foot), total in seconds.items()
    ]
