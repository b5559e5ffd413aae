"""state-observation's Kinetics Observer: stiffness and damping of the contacts.

Four vectors x, y, z: `linStiffness` [N/m], `linDamping` [N·s/m], `angStiffness` [N·m/rad], `angDamping`
[N·m·s/rad], one set for all contacts (mc_state_observation, etc/MCKineticsObserver/robots). What no
recording gave stands at the observer's own defaults: 40000, 120, 400, 12.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Axis
from plantar.exporters.comment import head
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.exporters.job import Job

# Key -> (attribute of the spring, axes in order x y z, the observer's default).
ENTRIES: dict[str, tuple[str, tuple[Axis | None, ...], float]] = {
    "linStiffness": ("stiffness", (None, None, "z"), 40000.0),
    "angStiffness": ("stiffness", ("roll", "pitch", None), 400.0),
    "linDamping": ("damping", (None, None, "z"), 120.0),
    "angDamping": ("damping", ("roll", "pitch", None), 12.0),
}


def write(job: Job) -> tuple[str, tuple[Note, ...]]:
    """The YAML's text."""
    notes = [
        Note(
            "export_mean",
            "warning",
            "the observer takes one set for all contacts: means over the feet were written",
        )
    ]
    text = "what was not identified (horizontal, yaw, z where missing) stands at the observer's defaults"
    notes.append(Note("export_default", "warning", text))
    if job.with_offset:
        notes.append(Note("export_offset", "warning", "the observer has no rest position: offsets left out"))
    body = ""
    for key, (attribute, axes, default) in ENTRIES.items():
        values = []
        for axis in axes:
            found = [spring for foot in job.feet if axis and (spring := foot.spring(axis)) is not None]
            values.append(
                float(np.mean([getattr(spring, attribute) for spring in found])) if found else default
            )
        body += f"{key}: [{', '.join(f'{value:.9g}' for value in values)}]\n"
    lines = head(job.result, job.feet, "the Kinetics Observer", (*job.remarks, *notes), with_offset=False)
    return "".join(f"# {line}\n" for line in lines) + body, tuple(notes)
