"""OpenHRP and hrpsys: the configuration file of the bush customizer (BUSH_CUSTOMIZER_CONFIG_PATH).

Two properties, `robot_model_name` and `bush_config`, the second a list of joint,spring,damping with N/m,
N/(m/s) for slides and N·m/rad, N·m/(rad/s) for hinges (openhrp3, sample/example/customizer).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from plantar.exporters.comment import head
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.exporters.job import Job


def write(job: Job) -> tuple[str, tuple[Note, ...]]:
    """The configuration's text."""
    entries = [
        f"{foot.joint(s.axis)},{s.stiffness:.9g},{s.damping:.9g}"
        for foot in job.feet
        for s in sorted(foot.springs, key=lambda s: ("z", "roll", "pitch").index(s.axis))
    ]
    notes = [Note("export_openhrp", "info", "the joints named must be in the robot's VRML or body file")]
    if job.with_offset:
        notes.append(
            Note("export_offset", "warning", "the bush customizer has no rest position: offsets left out")
        )
    lines = head(job.result, job.feet, "the bush customizer", (*job.remarks, *notes), with_offset=False)
    name = str(job.result.get("robot", "robot"))
    comment = "".join(f"# {line}\n" for line in lines)
    return f"{comment}robot_model_name: {name}\nbush_config: {' '.join(entries)}\n", tuple(notes)
