"""Choreonoid: the `bush` entry of a body customizer's YAML (springT, dampingT, springR, dampingR).

One value for all slides [N/m, N/(m/s)] and one for all hinges [N·m/rad, N·m/(rad/s)], as the customizers of
rtmros_choreonoid (hrpsys_choreonoid/config) read them.
"""

from __future__ import annotations

import numpy as np

from plantar.exporters.job import Job
from plantar.notes import Notes


def write(job: Job, notes: Notes) -> str:
    """The YAML's text."""
    text = "one value for all hinges and one for all slides: means over feet and axes were written"
    notes.warning("export_mean", f"choreonoid's customizer takes {text}")
    if job.with_offset:
        notes.warning("export_offset", "the customizer has no rest position: offsets left out")
    body = "bush:\n"
    for letter, slide in (("T", True), ("R", False)):
        springs = [s for foot in job.feet for s in foot.springs if (s.axis == "z") == slide]
        if springs:
            body += f"  spring{letter}: {np.mean([s.stiffness for s in springs]):.9g}\n"
            body += f"  damping{letter}: {np.mean([s.damping for s in springs]):.9g}\n"
        else:
            notes.info("export_rigid", "z is not identified: springT and dampingT are left to the customizer")
    return "".join(f"# {line}\n" for line in job.head("Choreonoid", notes, rests=False, joints=False)) + body
