"""Choreonoid: the `bush` entry of a body customizer's YAML (springT, dampingT, springR, dampingR).

One value for all slides [N/m, N/(m/s)] and one for all hinges [N·m/rad, N·m/(rad/s)], as the customizers of
rtmros_choreonoid (hrpsys_choreonoid/config) read them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from plantar.exporters.comment import head
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.exporters.job import Job


def write(job: Job) -> tuple[str, tuple[Note, ...]]:
    """The YAML's text."""
    text = "one value for all hinges and one for all slides: means over feet and axes were written"
    notes = [Note("export_mean", "warning", f"choreonoid's customizer takes {text}")]
    if job.with_offset:
        notes.append(
            Note("export_offset", "warning", "the customizer has no rest position: offsets left out")
        )
    body = "bush:\n"
    for letter, slide in (("T", True), ("R", False)):
        springs = [s for foot in job.feet for s in foot.springs if (s.axis == "z") == slide]
        if springs:
            body += f"  spring{letter}: {np.mean([s.stiffness for s in springs]):.9g}\n"
            body += f"  damping{letter}: {np.mean([s.damping for s in springs]):.9g}\n"
        else:
            notes.append(
                Note(
                    "export_rigid",
                    "info",
                    "z is not identified: springT and dampingT are left to the customizer",
                )
            )
    lines = head(job.result, job.feet, "Choreonoid", (*job.remarks, *notes), with_offset=False)
    return "".join(f"# {line}\n" for line in lines) + body, tuple(notes)
