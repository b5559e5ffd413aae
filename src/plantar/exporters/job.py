"""What one export has to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from plantar.errors import ExportError, located
from plantar.exporters.bush import FootBush
from plantar.notes import Note

PIVOTS: Final = ("ground", "bush")  # what a foot on points turns about


@dataclass(frozen=True)
class Job:
    """What a target is given: the feet, the result, the model to extend and where the file will stand; `pivot`:
    of `PIVOTS`."""

    result: Mapping[str, Any]
    feet: tuple[FootBush, ...]
    model: Path | None
    out: Path
    with_offset: bool
    remarks: tuple[Note, ...]  # what holds for every target, for the comment at the file's head
    pivot: str = "ground"


def asked(module: object, target: str, hysteresis: bool, swing: float | None, pivot: str) -> bool:
    """Whether the feet of a target keep their slip. Raises ExportError where it is asked for what it does not take.

    Args:
        module: of the target; `HYSTERESIS`: it holds a slip, `HYSTERESIS_IN_LOOP`: if asked, for `FootHysteresis`,
            `PIVOT`: its feet may turn about the bush.
        hysteresis, swing, pivot: as of `plantar.export`.
    """
    if pivot not in PIVOTS:
        raise ExportError(located("unknown pivot", value=pivot, valid=", ".join(PIVOTS)))
    if pivot != "ground" and not getattr(module, "PIVOT", False):
        raise ExportError(located("this target takes no pivot", value=target, valid="mujoco-contact"))
    holds = bool(getattr(module, "HYSTERESIS", False))
    if hysteresis and not (holds or getattr(module, "HYSTERESIS_IN_LOOP", False)):
        raise ExportError(
            located("this target holds no hysteresis", value=target, valid="mjcf, mujoco-contact, or a swing")
        )
    if hysteresis and swing is not None and not holds:
        message = "a swing makes spring and damper of the slip that the hysteresis would keep"
        raise ExportError(located(message, valid="one of the two"))
    return holds or hysteresis
