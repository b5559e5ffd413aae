"""Foot stiffness as published or as configured in robots' software, for a result to stand among."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from plantar.results.feet_rows import Parameter

Origin = Literal["measured", "configured"]


@dataclass(frozen=True)
class Reference:
    """One foot's numbers: `pitch` and `roll` [N·m/rad], `z` [N/m], damping of rotation [N·m·s/rad]; None: not given.

    `source`: the publication or the software that has them in its configuration.
    """

    robot: str
    pitch: float
    roll: float
    z: float | None
    damping: float | None
    origin: Origin
    source: str

    @property
    def rotation(self) -> float:
        """Mean of pitch and roll [N·m/rad]: what the list is ordered by."""
        return (self.pitch + self.roll) / 2


PAPER: Final = "table 1 of the paper (see the citation)"
REFERENCES: Final = (
    Reference("HRP-2, right foot", 434, 323, None, 16.7, "measured", PAPER),
    Reference("HRP-2, left foot", 480, 352, None, 26.2, "measured", PAPER),
    Reference("HRP-2", 502, 707, 239018, None, "configured", "simple-biped, sot-torque-control"),
    Reference("HRP-2", 600, 600, 40000, 60, "configured", "sot-state-observation, sot-stabilizer"),
    Reference("any, Kinetics Observer's default", 400, 400, 40000, 12, "configured", "state-observation"),
    # The middle of 1650 to 1850 and of 1300 to 1650, over feet and fits.
    Reference(
        "REEM-C, foot and leg in series",
        1750,
        1475,
        None,
        None,
        "measured",
        "regression on eurobench/eb_hum_bench",
    ),
    Reference("JAXON", 2500, 2500, 1.1e6, 2.5, "configured", "hrpsys, bush customizer"),
    Reference("JVRC-1", 3000, 3000, 1.3e6, 2.5, "configured", "hrpsys, bush customizer"),
    Reference("OpenHRP's sample robot", 1000, 1000, 5e5, 25, "configured", "openhrp3, bush customizer"),
    Reference("TALOS", 1e8, 1e8, 1e8, None, "configured", "sot-talos-balance: rigid"),
)


@dataclass(frozen=True)
class Neighbour:
    """A line of the list: a reference, or a foot of the result (`own`)."""

    reference: Reference
    own: bool


def neighbours(parameters: Sequence[Parameter] = ()) -> tuple[Neighbour, ...]:
    """References and the feet of a result, softest first; a foot without K of both axes is left out.

    What is unidentifiable counts as not there, and a damping is given where both axes have one.
    """
    values: dict[tuple[str, str, str], float] = {
        (row.foot, row.axis, row.name): row.value
        for row in parameters
        if row.value is not None and row.verdict != "unidentifiable"
    }
    own = []
    for foot in dict.fromkeys(row.foot for row in parameters):
        pitch, roll = (values.get((foot, axis, "stiffness")) for axis in ("pitch", "roll"))
        dampers = [values[key] for axis in ("pitch", "roll") if (key := (foot, axis, "damping")) in values]
        if pitch is not None and roll is not None:
            damping = sum(dampers) / 2 if len(dampers) == 2 else None
            z = values.get((foot, "z", "stiffness"))
            own.append(Reference(f"this result, {foot}", pitch, roll, z, damping, "measured", "these logs"))
    lines = [Neighbour(row, False) for row in REFERENCES] + [Neighbour(row, True) for row in own]
    return tuple(sorted(lines, key=lambda line: line.reference.rotation))
