"""mc_rtc: the `flexibilities` of a robot module.

mc_rbdyn::Flexibility (jointName, K, C, O) stands for torque = -K q - C q̇ - O in the flexible joint, and RobotModule's
JSON reads a list of them under `flexibilities` (mc_rtc, mc_rbdyn/Flexibility.h and configuration_io.cpp). The joint
pushes back what the ground puts on the sole, so K, C and O are the identified ones.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from plantar.exporters.comment import head
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.exporters.job import Job


def write(job: Job) -> tuple[str, tuple[Note, ...]]:
    """The JSON to merge into a robot module; the key `plantar`, which no reader asks for, stands for comments."""
    flexibilities = [
        {"jointName": foot.joint(s.axis), "K": s.stiffness, "C": s.damping, "O": s.offset}
        for foot in job.feet
        for s in foot.springs
    ]
    text = "the joints named must be in the module's URDF: export --to urdf writes them"
    notes = (Note("export_mc_rtc", "info", text),)
    lines = head(job.result, job.feet, "mc_rtc", (*job.remarks, *notes), with_offset=job.with_offset)
    return json.dumps(
        {"plantar": lines, "flexibilities": flexibilities}, indent=2, ensure_ascii=False
    ) + "\n", notes
