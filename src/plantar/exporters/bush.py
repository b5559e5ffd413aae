"""The bush of each foot as a result gives it: springs, dampers, rest positions, and where they sit.

The identified model is torque = K·deflection + C·rate + offset, with the torque that the ground puts on the
sole. A simulator's joint from ankle to sole pushes back with exactly that, so K and C go over unchanged, and
the joint's rest position is -offset/K.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from plantar.conventions import AXES, Array, Axis, rotation_from_rpy
from plantar.errors import ExportError
from plantar.exporters.source import robot_model, robot_urdf
from plantar.exporters.spring import Spring, spring_of
from plantar.exporters.urdf.tree import UrdfTree
from plantar.notes import Note, Notes

CHAIN: tuple[Axis, ...] = ("z", "pitch", "roll")  # from the ankle to the sole
SIDES = {"left": "LLEG", "right": "RLEG"}


@dataclass(frozen=True)
class FootBush:
    """One foot: its springs in the chain's order (z, pitch, roll) and its geometry in the ankle's frame.

    `centre` (3,) [m] and `rotation` (3, 3) place the bush in the ankle; `sole` (n, 3) is the sole's outline.
    """

    name: str
    ankle: str
    springs: tuple[Spring, ...]
    centre: Array
    rotation: Array
    sole: Array

    def spring(self, axis: Axis) -> Spring | None:
        return next((spring for spring in self.springs if spring.axis == axis), None)

    def joint(self, axis: Axis) -> str:
        """The bush joint's name: as in OpenHRP's models for left and right, else by the foot's name."""
        return f"{SIDES[self.name]}_BUSH_{axis.upper()}" if self.name in SIDES else f"{self.name}_bush_{axis}"

    def link(self, axis: Axis) -> str:
        """The light link that the axis moves; the last one in the chain is the sole."""
        last = self.springs[-1].axis
        return f"{self.name}_bush_sole" if axis == last else f"{self.name}_bush_{axis}_link"

    @property
    def sole_link(self) -> str:
        return self.link(self.springs[-1].axis)

    def direction(self, axis: Axis) -> Array:
        """The axis as a unit vector in the ankle's frame, (3,): pitch about y, roll about x, z along z."""
        return self.rotation[:, {"roll": 0, "pitch": 1, "z": 2}[axis]]

    @property
    def turn_at_rest(self) -> Array:
        """R_ankle_sole where no spring pushes, in the bush's axes, (3, 3): Ry(pitch) Rx(roll)."""
        rest = {spring.axis: spring.rest for spring in self.springs}
        return rotation_from_rpy(np.array([rest.get("roll", 0.0), rest.get("pitch", 0.0), 0.0]))

    def depth(self, point: Array) -> float:
        """How far a point of the ankle's frame lies below the bush centre, along the bush's z [m]."""
        return float(-(self.rotation[:, 2] @ (np.asarray(point) - self.centre)))

    def below(self, point: Array) -> bool:
        """Whether a frame of the ankle goes with the sole: under the bush centre, or in the sole's plane."""
        return self.depth(point) > min(1e-4, self.sole_depth - 1e-3)

    @property
    def sole_depth(self) -> float:
        """How far the sole's plane lies below the bush centre [m]."""
        return float(np.mean([self.depth(corner) for corner in self.sole]))


def earlier_joints(
    foot: FootBush, joints: Mapping[str, ET.Element], path: Path
) -> list[tuple[Spring, ET.Element]]:
    """The foot's bush joints in a model that has them, each with its spring now; empty where it has none.

    Raises ExportError where it has some but not all: the others would stand beside them.
    """
    found = [(spring, joints[name]) for spring in foot.springs if (name := foot.joint(spring.axis)) in joints]
    missing = [foot.joint(spring.axis) for spring in foot.springs if foot.joint(spring.axis) not in joints]
    if found and missing:
        message = f"has the bush of '{foot.name}' without {', '.join(missing)}, which the result has"
        raise ExportError(message, path=path, valid="a model without bushes")
    return found


def raised(foot: FootBush) -> FootBush:
    """The same foot with its sole in the plane of the bush centre."""
    return replace(foot, sole=foot.sole + foot.sole_depth * foot.rotation[:, 2])


def check_swing(swing: float | None) -> None:
    """Raise ExportError where an amplitude is no angle of a foot."""
    if swing is not None and not 0 < swing < 1:
        raise ExportError("the swing is no angle of a foot", value=swing, valid="above 0, below 1 rad")


def feet_of_result(
    result: Mapping[str, Any],
    base: Path,
    *,
    with_offset: bool,
    hysteresis: bool,
    swing: float | None,
) -> tuple[tuple[FootBush, ...], tuple[Note, ...]]:
    """Every foot of a plantar.feet/1 result, and notes on what no target will hold.

    With `hysteresis`, for a target that holds one, an elastoplastic axis keeps it; else its slip becomes spring
    and damper (`spring_of`).

    Raises ExportError: no foot, a foot without stiffness, a stiffness that is not positive, no geometry.
    """
    rows = [row for row in result.get("parameters", ()) if isinstance(row, Mapping)]
    names = list(dict.fromkeys(str(row.get("foot")) for row in rows))
    if not names:
        raise ExportError("the result holds no parameters", valid="a result of identify feet")
    entries = robot_model(result).get("feet", {})
    notes = Notes(
        Note("export_guess", "warning", str(note.get("text")))
        for note in result.get("notes", ())
        if isinstance(note, Mapping) and note.get("code") == "guessed_geometry"
    )
    feet = []
    for name in names:
        found = (
            spring_of(result, rows, name, axis, with_offset, notes, hysteresis=hysteresis, swing=swing)
            for axis in CHAIN
        )
        springs = tuple(spring for spring in found if spring is not None)
        if not {"pitch", "roll"} & {spring.axis for spring in springs}:
            message = f"foot '{name}' has no stiffness in pitch or roll"
            raise ExportError(message, valid="a result of identify feet")
        for axis in AXES:
            if axis not in {spring.axis for spring in springs}:
                notes.info("export_rigid", f"{name} {axis}: not identified, so rigid in the export")
        if name not in entries:
            raise ExportError(f"the result's robot_model has no foot '{name}'", valid=", ".join(entries))
        centre, rotation, sole = _geometry(entries[name], result, base)
        feet.append(FootBush(name, str(entries[name]["ankle"]), springs, centre, rotation, sole))
    return tuple(feet), tuple(notes)


def _geometry(entry: Mapping[str, Any], result: Mapping[str, Any], base: Path) -> tuple[Array, Array, Array]:
    """Bush centre, bush axes and sole outline in the ankle link's frame."""
    try:
        ankle = entry["ankle"]
        frames = []
        for part in (entry["bush"], entry["sole"]):
            rotation = rotation_from_rpy(np.array(part.get("rpy", (0, 0, 0)), float))
            origin = np.array(part["xyz"], float)
            if part.get("link", ankle) != ankle:
                above = UrdfTree.load(robot_urdf(result, base)).fixed_pose(ankle, part["link"])
                rotation, origin = above[:3, :3] @ rotation, above[:3, :3] @ origin + above[:3, 3]
            frames.append((rotation, origin))
        outline = np.array(entry["sole"]["polygon"], float)
        corners = np.column_stack([outline, np.zeros(len(outline))]) @ frames[1][0].T + frames[1][1]
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
        message = f"robot_model: a foot's entry is broken: {error}"
        raise ExportError(message, valid="ankle, bush, sole") from error
    return frames[0][1], frames[0][0], corners
