"""What one export has to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from plantar.errors import ExportError
from plantar.exporters.bush import FootBush
from plantar.exporters.comment import head
from plantar.notes import Note, Notes

PIVOTS: Final = ("ground", "bush")
LEAST_LOAD: Final = 0.42  # of the weight: a little below the half that a foot carries on two feet
LEAST_LOADS: Final = (0.05, 0.5)  # of the weight: a foot that stands with the other carries half


@dataclass(frozen=True)
class Stance:
    """How a foot on points stands: what it turns about, one of `PIVOTS`, and the share of the robot's weight below
    which it is soft along z."""

    pivot: str = "ground"
    least_load: float = LEAST_LOAD


USUAL: Final = Stance()


@dataclass(frozen=True)
class Job:
    """What a target is given: the feet, the result, the model to extend, where the file will stand, and for feet on
    points their `stance` and whether the loop is to have their law (`hysteresis`)."""

    result: Mapping[str, Any]
    feet: tuple[FootBush, ...]
    model: Path | None
    out: Path
    with_offset: bool
    remarks: tuple[Note, ...]  # what holds for every target, for the comment at the file's head
    stance: Stance
    hysteresis: bool

    def head(self, target: str, notes: Notes, *, rests: bool = True, joints: bool = True) -> list[str]:
        """`comment.head` of this export; not `rests`: of a target whose springs have no rest position."""
        offset, said = self.with_offset and rests, (*self.remarks, *notes)
        return head(self.result, self.feet, target, said, with_offset=offset, joints=joints)


def asked(module: object, target: str, hysteresis: bool, swing: float | None, stance: Stance) -> bool:
    """Whether the feet of a target keep their slip. Raises ExportError where it is asked for what it does not take.

    Args:
        module: of the target; `HYSTERESIS`: it holds a slip, `HYSTERESIS_IN_LOOP`: if asked, for `FootHysteresis`,
            `STANCE`: its feet take a stance.
        hysteresis, swing: as of `plantar.export`. stance: of feet on points.
    """
    low, high = LEAST_LOADS
    if stance.pivot not in PIVOTS:
        raise ExportError("unknown pivot", value=stance.pivot, valid=", ".join(PIVOTS))
    if not low <= stance.least_load <= high:
        valid = f"{low:g} to {high:g} of the weight"
        raise ExportError("the least load is out of range", value=stance.least_load, valid=valid)
    if stance != USUAL and not getattr(module, "STANCE", False):
        message = "this target takes no pivot and no least load"
        raise ExportError(message, value=target, valid="mujoco-contact")
    holds = bool(getattr(module, "HYSTERESIS", False))
    if hysteresis and not (holds or getattr(module, "HYSTERESIS_IN_LOOP", False)):
        valid = "mjcf, mujoco-contact, or a swing"
        raise ExportError("this target holds no hysteresis", value=target, valid=valid)
    if hysteresis and swing is not None and not holds:
        message = "a swing makes spring and damper of the slip that the hysteresis would keep"
        raise ExportError(message, valid="one of the two")
    return holds or hysteresis
