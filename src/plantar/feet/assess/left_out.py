"""Why most or all of a foot, or of a whole log, could not be used: the reason that took most of its samples."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.contact.polygon import edge_distances, edge_normals
from plantar.contact.reasons import EDGES, Reason
from plantar.feet.recording import Recording
from plantar.notes import Note
from plantar.pages import REASONS
from plantar.robot.model import Foot

UNUSED = "log_unused"
ON_AN_EDGE = "on_an_edge"
MOSTLY = 0.5  # of the time in which a foot stands


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


def mostly_on_an_edge(name: str, foot: Foot, recordings: Sequence[Recording]) -> list[Note]:
    """A warning that most of what a foot stands was left out at an edge of its sole, and at which."""
    stands = left = 0.0
    depths = []
    for one in recordings:
        contact = one.contacts[name]
        tips = contact.standing & contact.left_out_for(EDGES)
        stands += float(contact.standing.sum()) * one.period
        left += float(tips.sum()) * one.period
        depths.append(edge_distances(one.bushes[name].cop[tips], foot.sole.polygon))
    if left <= MOSTLY * stands:
        return []
    depth = np.concatenate(depths)
    edge = int(np.bincount(depth.argmin(axis=1)).argmax())
    outwards = -edge_normals(foot.sole.polygon)[edge]
    along = int(np.argmax(np.abs(outwards)))
    side = (("front", "back"), ("left", "right"))[along][int(outwards[along] < 0)]
    inside = 1e3 * float(np.median(depth[:, edge]))
    text = (
        f"{name} foot: {left:.0f} of the {stands:.0f} s in which it stands are left out, since a sole that tips turns "
        f"further than its bush: its centre of pressure is usually {abs(inside):.0f} mm "
        f"{'inside' if inside > 0 else 'outside'} of the {side} edge of feet.{name}.sole.polygon. Measure the sole; if "
        "the outline is right, the foot stands on that edge, and its weight belongs further inwards"
    )
    return [Note(ON_AN_EDGE, "warning", text)]
