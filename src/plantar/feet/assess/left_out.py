"""Why nothing of a foot, or of a whole log, could be used: the reason that took most of its samples."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.contact.reasons import Reason
from plantar.feet.recording import Recording
from plantar.notes import Note
from plantar.pages import REASONS

UNUSED = "log_unused"


def most_left_out(recordings: Sequence[Recording], foot: str) -> tuple[Reason, str] | None:
    """The reason that leaves out most of a foot, and that in words with its seconds; None where nothing is left out."""
    seconds: dict[tuple[Reason, str], float] = {}
    for recording in recordings:
        contact = recording.contacts[foot]
        counts = np.bincount(contact.code, minlength=len(contact.reasons) + 1)[1:]
        for why, count in zip(contact.reasons, counts, strict=True):
            key = (why.reason, why.text)
            seconds[key] = seconds.get(key, 0.0) + float(count) * recording.period
    if not seconds:
        return None
    reason, text = most = max(seconds, key=lambda why: seconds[why])
    return reason, f"{text} ({seconds[most]:.1f} s)"


def why_unseen(recordings: Sequence[Recording], foot: str) -> tuple[str, str]:
    """Reason and advice for a foot of which no log has a sample that can be used."""
    none = f"the {foot} foot has no samples in these logs that can be used"
    found = most_left_out(recordings, foot)
    if found is None or found[0] is Reason.IN_THE_AIR:
        return none, f"record motions in which the {foot} foot stands"
    return f"{none}: {found[1]}", f"see that reason in “{REASONS}” of the documentation"


def unused_logs(recordings: Sequence[Recording]) -> list[Note]:
    """A warning for each of several logs that says nothing of any foot, although feet stand in it.

    Of a single log the feet's own rows say so.
    """
    if len(recordings) < 2:
        return []
    notes = []
    for one in recordings:
        standing = [foot for foot, contact in one.contacts.items() if contact.standing.any()]
        if not standing or any(one.used(foot).any() for foot in one.contacts):
            continue
        why = {foot: most_left_out([one], foot) for foot in standing}
        told = "; ".join(f"{foot} foot: {found[1]}" for foot, found in why.items() if found is not None)
        notes.append(Note(UNUSED, "warning", f"{one.name}: nothing of this log can be used. {told}"))
    return notes
