"""Where a reader finds out more about a number that is not usable: pages of the documentation, by their titles."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

REASONS: Final = "Why did my fit fail?"
IDENTIFIABLE: Final = "Which parameters can be identified at all?"
STRUCTURE: Final = "Is it the foot, or the leg, or the hip?"
ONLINE: Final = "Feet in the control loop"
JOINTS: Final = "Friction and rotor inertia of joints"
NOT_USABLE: Final = ("weak", "unidentifiable")


def on_feet(verdicts: Iterable[str]) -> str:
    """One sentence on the pages to read, for the verdicts of feet; nothing where all are usable."""
    found = set(verdicts).intersection(NOT_USABLE)
    if not found:
        return ""
    pages = f"“{REASONS}” explains each reason"
    if "unidentifiable" in found:
        pages += f", “{IDENTIFIABLE}” what logs can show, “{STRUCTURE}” what else bends"
    causes = "`plantar diagnose RESULT.json` splits each interval into its causes"
    return f"Read on in plantar's documentation: {pages}; {causes}."


def on_joints(verdicts: Iterable[str]) -> str:
    """The same for the parameters of joints."""
    if not set(verdicts).intersection(NOT_USABLE):
        return ""
    return f"Read on in plantar's documentation: “{JOINTS}” and “{IDENTIFIABLE}”."
