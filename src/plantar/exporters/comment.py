"""The comment at an export's head: what was written, in which units, and what the target could not hold."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import Any, Final

from plantar.conventions import AXES, Axis
from plantar.exporters.bush import FootBush
from plantar.notes import Note

# What a bush's joint does, and which way is positive: signs are those of the identified deflection.
MOTION: Final[Mapping[Axis, str]] = {
    "z": "slide along z, compressed > 0",
    "pitch": "pitch about y, toes down > 0",
    "roll": "roll about x, left edge up > 0",
}


def head(
    result: Mapping[str, Any],
    feet: Iterable[FootBush],
    target: str,
    notes: Iterable[Note],
    *,
    with_offset: bool,
    joints: bool = True,
) -> list[str]:
    """Lines of plain text, without comment marks; `joints`: the target has a joint for each axis, which is named."""
    lines = [
        f"Feet of '{result.get('robot', 'robot')}', identified by plantar {result.get('plantar', '')},",
        f"for {target}.",
    ]
    for foot in feet:
        for spring in foot.springs:
            k, c, o = spring.units
            axis = f"{foot.name} foot, {MOTION[spring.axis]}"
            line = f"{foot.joint(spring.axis)} ({axis}): " if joints else f"{axis}: "
            line += f"K = {spring.stiffness:.6g} {k}, C = {spring.damping:.6g} {c}"
            if spring.slip is not None:
                line += f", slips at {spring.slip.torque:.4g} {o} after {spring.slip.angle:.4g} rad"
            line += " (assumed)" if spring.assumed else ""
            lines.append(line + (f", offset = {spring.offset:.4g} {o}" if with_offset else ""))
    if with_offset:
        lines.append("Each spring rests at -offset/K.")
    else:
        lines.append("Each spring rests at 0: the identified offset is mostly the sensors' zero.")
    lines += [f"{note.severity}: {note.text}" for note in notes]
    return [" ".join(line.split()) for line in lines]


def joints_note(feet: Iterable[FootBush]) -> Note:
    """Which joints of the written model are the bushes."""
    feet = list(feet)
    joints = {foot.name: [foot.joint(spring.axis) for spring in foot.springs] for foot in feet}
    told = [f"{name} foot {', '.join(own)}" for name, own in joints.items()]
    axes = dict.fromkeys(spring.axis for foot in feet for spring in foot.springs)
    signs = ", ".join(MOTION[axis] for axis in axes)
    return Note("export_joints", "info", f"the bushes are these joints: {'; '.join(told)} ({signs})")


def moved_note(foot: FootBush, moved: Iterable[str]) -> Note:
    text = f"{foot.name}: moved from '{foot.ankle}' to the sole: {', '.join(moved)}"
    return Note("export_moved", "info", text)


def updated_note(foot: FootBush, joints: Container[str]) -> Note:
    """joints: the model's names of them."""
    kept = [name for axis in AXES if not foot.spring(axis) and (name := foot.joint(axis)) in joints]
    text = f"{foot.name}: the model has the bush joints; their values are updated"
    if not kept:
        return Note("export_updated", "info", text)
    text += f", but not those of {', '.join(kept)}, of which the result knows nothing: they stay as they were"
    return Note("export_updated", "warning", text)


def plate_note(foot: FootBush) -> Note:
    corners = (foot.sole - foot.centre) @ foot.rotation
    long, wide = 1e3 * (corners.max(axis=0) - corners.min(axis=0))[:2]
    text = "the model has no collision shape under the bush; added was a plate of the sole's size in the robot file, "
    text += f"{long:.0f} x {wide:.0f} mm"
    return Note("export_plate", "info", f"{foot.name}: {text}")


def mesh_note(foot: FootBush) -> Note:
    text = f"a collision mesh of '{foot.ankle}' cannot be read; taken for the foot and moved to the sole"
    return Note("export_mesh", "warning", f"{foot.name}: {text}")
