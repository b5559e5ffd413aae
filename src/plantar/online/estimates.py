"""What the estimator says of a foot at one tick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum, IntFlag

from plantar.conventions import Array


class Contact(IntEnum):
    """Whether a foot is in the air, has landed and is not settled yet, or stands."""

    AIR = 0
    LANDING = 1
    STANCE = 2


class Flag(IntFlag):
    """Why something may not be trusted now; the C++ header says more."""

    INPUT_MISSING = 1
    FROZEN = 2
    TIME_FAULT = 4
    NOT_STANDING = 8
    EDGE = 16
    SLIP = 32
    IMPACT = 64
    NEVER_LOADED = 128
    PITCH_UNKNOWN = 256
    ROLL_UNKNOWN = 512
    GROUND_CHANGED = 1024
    PITCH_MEMORY = 2048
    ROLL_MEMORY = 4096
    PITCH_UNTESTED = 8192
    ROLL_UNTESTED = 16384
    CONTRADICTION = 32768
    LATE_WRENCH = 65536
    LATE_IMU = 131072


@dataclass(frozen=True)
class Estimated:
    """A parameter with its standard deviation and half of its 95 % interval, in its unit."""

    value: float
    std: float
    half_width: float


@dataclass(frozen=True)
class AxisEstimate:
    """Pitch or roll of one foot.

    deflection [rad], rate [rad/s] and torque [N·m] are this tick's; stiffness [N·m/rad], damping [N·m·s/rad] and
    slip_torque [N·m] what was learnt so far; offset [N·m] is this stance's. identified: whether the stiffness is known
    within a tenth, and a memory of the rubber is excluded, or the one that is modelled was tested.
    """

    deflection: float
    rate: float
    torque: float
    stiffness: Estimated
    damping: Estimated
    slip_torque: Estimated
    offset: float
    identified: bool


@dataclass(frozen=True)
class FootEstimate:
    """One foot.

    load along the vertical [N], centre of pressure in the sole's frame [m], `flags`; compression of the slide along the
    ankle's z [m] by its compliance [m/N]; both axes.
    """

    contact: Contact
    load: float
    centre_of_pressure: tuple[float, float]
    flags: Flag
    compression: float
    compliance: Estimated
    pitch: AxisEstimate
    roll: AxisEstimate


LEARNT = ("stiffness", "damping", "slip_torque")
AXIS_FIELDS = (
    "deflection", "rate", "torque",
    *(f"{name}{part}" for name in LEARNT for part in ("", ".std", ".half_width")),
    "offset", "identified",
)  # fmt: skip
# One row of the core, in its order.
FIELDS = (
    "contact", "load", "centre_of_pressure.x", "centre_of_pressure.y", "flags",
    "compression", "compliance", "compliance.std", "compliance.half_width",
    *(f"{axis}.{name}" for axis in ("pitch", "roll") for name in AXIS_FIELDS),
)  # fmt: skip


def foot_estimate(row: Array) -> FootEstimate:
    """A row of the core, (len(FIELDS),), as an estimate."""
    values = dict(zip(FIELDS, row.tolist(), strict=True))
    return FootEstimate(
        contact=Contact(int(values["contact"])),
        load=values["load"],
        centre_of_pressure=(values["centre_of_pressure.x"], values["centre_of_pressure.y"]),
        flags=Flag(int(values["flags"])),
        compression=values["compression"],
        compliance=Estimated(*(values[f"compliance{part}"] for part in ("", ".std", ".half_width"))),
        pitch=_axis(values, "pitch"),
        roll=_axis(values, "roll"),
    )


def _axis(values: Mapping[str, float], axis: str) -> AxisEstimate:
    stiffness, damping, slip_torque = (
        Estimated(*(values[f"{axis}.{name}{part}"] for part in ("", ".std", ".half_width")))
        for name in LEARNT
    )
    return AxisEstimate(
        deflection=values[f"{axis}.deflection"],
        rate=values[f"{axis}.rate"],
        torque=values[f"{axis}.torque"],
        stiffness=stiffness,
        damping=damping,
        slip_torque=slip_torque,
        offset=values[f"{axis}.offset"],
        identified=bool(values[f"{axis}.identified"]),
    )
