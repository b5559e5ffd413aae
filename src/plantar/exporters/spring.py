"""One axis of a bush as a simulator gets it: which numbers of a result are written, and what is said of the others."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from plantar.conventions import DAMPING_UNIT, OFFSET_UNIT, STIFFNESS_UNIT, Axis
from plantar.errors import ExportError
from plantar.notes import Notes
from plantar.results.numbers import unit

DAMPING_TIME = 0.002  # s: C/K written where none was identified, that of published bush models (5e5, 1e3)
ASSUMED = f"K x {1e3 * DAMPING_TIME:g} ms"
KNOWN_TERMS = ("stiffness", "damping", "offset")
# rad/s: half a hertz, as a standing robot sways; slip loses the same at any rate, a damper does not.
SWAY = 3.0
SLIP_TERMS = ("slip_torque", "slip_angle")


@dataclass(frozen=True)
class Slip:
    """An elastoplastic (Jenkins) element beside spring and damper: it yields at `torque` [N·m] after `angle` [rad]."""

    torque: float
    angle: float

    @property
    def stiffness(self) -> float:
        """Before it yields [N·m/rad]."""
        return self.torque / self.angle

    def stiffness_at(self, swing: float) -> float:
        """Stiffness in phase with swings of this amplitude [rad]: the describing function of an element that slips.

        With cos β = 1 - 2·angle/swing it is (torque/angle)·(β - sin 2β/2)/π, and torque/angle before it slips.
        """
        if swing <= self.angle:
            return self.stiffness
        beta = math.acos(1 - 2 * self.angle / swing)
        return self.stiffness * (beta - math.sin(2 * beta) / 2) / math.pi

    def damping_at(self, swing: float) -> float:
        """The damper that loses as much as the slip in swings of this amplitude [rad] at `SWAY` [N·m·s/rad]."""
        lost = 4 * self.torque * max(swing - self.angle, 0.0)  # J a cycle, the loop's area
        return lost / (math.pi * SWAY * swing**2)


@dataclass(frozen=True)
class Spring:
    """One axis: stiffness, damping and offset, in N, m, rad and s; `assumed`: the logs do not show the damping; `slip`
    only for targets that hold a hysteresis."""

    axis: Axis
    stiffness: float
    damping: float
    offset: float
    assumed: bool = False
    slip: Slip | None = None

    @property
    def rest(self) -> float:
        """Where the spring pushes with nothing [rad, or m for z]."""
        return -self.offset / self.stiffness

    @property
    def units(self) -> tuple[str, str, str]:
        return STIFFNESS_UNIT[self.axis], DAMPING_UNIT[self.axis], OFFSET_UNIT[self.axis]


def spring_of(
    result: Mapping[str, Any],
    rows: list[Mapping[str, Any]],
    foot: str,
    axis: Axis,
    with_offset: bool,
    notes: Notes,
    *,
    hysteresis: bool = False,
    swing: float | None = None,
) -> Spring | None:
    """The spring of one axis, or None where it is rigid; `notes` gets what nobody should miss.

    hysteresis: whether the target can hold an element that slips. swing: amplitude [rad] at which a slip that the
    target cannot hold becomes spring and damper; None: the middle of the identified motions', or where a result does
    not have these the spring and damper nearest to all of them.

    Raises ExportError where the stiffness is not positive or a number is none.
    """
    mine = {str(row["name"]): row for row in rows if row.get("foot") == foot and row.get("axis") == axis}
    where = f"{foot} {axis}"
    found = {name: row["value"] for name, row in mine.items() if row.get("value") is not None}
    if "stiffness" not in found or (axis == "z" and _may_be_rigid(mine["stiffness"])):
        return None
    values = {name: _number(value, f"{where} {name}") for name, value in found.items()}
    stiffness = values["stiffness"]
    if stiffness <= 0:
        message = f"{where}: the stiffness is not positive; no simulator can stand on it"
        raise ExportError(message, value=stiffness, valid="a result whose stiffness is usable")
    extra = [name for name in values if name not in KNOWN_TERMS]
    slip = swung = None
    if set(extra) == set(SLIP_TERMS) and all(values[name] > 0 for name in SLIP_TERMS):
        element = Slip(*(values[name] for name in SLIP_TERMS))
        if hysteresis:
            slip, extra = element, []
        elif (at := swing or _usual_swing(result, foot, axis)) is not None:
            swung = element.stiffness_at(at), element.damping_at(at)
            text = f"{where}: the slip is written as the spring and damper of swings of {at:.3g} rad at {SWAY:g} rad/s"
            if not swing:
                text += ", the middle of the identified motions; for others give --swing"
            notes.warning("export_swing", text)
    nearest = _linear_equivalent(result, foot, axis) if extra and swung is None else None
    if extra and swung is None:
        text = f"{where}: the target holds a linear spring and damper; left out: {', '.join(extra)}"
        if nearest is not None:
            text += "; K and C are those of the spring and damper nearest to the identified motions"
        notes.warning("export_terms", text)
    _doubt(mine["stiffness"], where, notes)
    if nearest is not None:
        stiffness, damping, assumed = *nearest, False
        _doubt(mine.get("damping", {}), where, notes)
    else:
        damping, assumed = _damping(mine.get("damping", {}), stiffness, where, notes)
    if swung is not None:
        stiffness, damping = stiffness + swung[0], damping + swung[1]
    offsets = [
        _number(row.get("value"), f"{where} offset")
        for row in (*result.get("offsets", ()), *(row for name, row in mine.items() if name == "offset"))
        if row.get("foot") == foot and row.get("axis") == axis
    ]
    offset = float(np.mean(offsets)) if offsets else 0.0
    if with_offset and len(offsets) > 1:
        text = f"{where}: offset {offset:.4g}, the mean of {len(offsets)} motions"
        text += f" from {min(offsets):.4g} to {max(offsets):.4g}"
        notes.info("export_offset", text)
    return Spring(axis, stiffness, damping, offset if with_offset else 0.0, assumed, slip)


def _may_be_rigid(row: Mapping[str, Any]) -> bool:
    """Whether a z called unidentifiable stays rigid: what hardly gives looks like any large number. An interval with
    ends says that it gives, though not how much, and the value is nearer to that than a foot that does not."""
    interval = row.get("interval95")
    return row.get("verdict") == "unidentifiable" and (interval is None or not np.isfinite(interval).all())


def _damping(row: Mapping[str, Any], stiffness: float, where: str, notes: Notes) -> tuple[float, bool]:
    """The damping to write, and whether it is assumed because the logs do not show it.

    Assumed is K·2 ms; where the interval lies above or below that, its nearer end, which the logs do not exclude.
    """
    verdict = row.get("verdict", "usable")
    value = row.get("value")
    if value is None:
        text = f"{where}: no damping identified; exported as {ASSUMED}, for stable simulators"
        notes.warning("export_damping", text)
        return DAMPING_TIME * stiffness, True
    if verdict == "unidentifiable":
        damping, said = DAMPING_TIME * stiffness, ASSUMED
        low, high = row.get("interval95") or (damping, damping)
        if low > damping:
            damping, said = float(low), "the low end"
        elif 0 < high < damping:
            damping, said = float(high), "the high end"
        text = f"{where}: the damping is unidentifiable{_known(row)}; exported as {said} = {damping:.4g}"
        notes.warning("export_damping", text)
        return damping, True
    _doubt(row, where, notes)
    if value <= 0:
        text = f"{where}: the identified damping {value:.4g} is not positive, and a foot would never come to rest; "
        notes.warning("export_damping", f"{text}exported as {ASSUMED}")
        return DAMPING_TIME * stiffness, True
    return float(value), False


def _doubt(row: Mapping[str, Any], where: str, notes: Notes) -> None:
    verdict = row.get("verdict", "usable")
    if verdict != "usable":
        notes.warning("export_verdict", f"{where}: the {row['name']} is {verdict}{_known(row)}")


def _known(row: Mapping[str, Any]) -> str:
    """What a row knows of its number, in brackets: the value and its 95 % interval."""
    if not row.get("interval95"):
        return ""
    low, high = row["interval95"]
    return f" ({row['value']:.4g}, 95 % from {low:.4g} to {high:.4g} {unit(str(row.get('unit', '')))})"


def _linear_equivalent(result: Mapping[str, Any], foot: str, axis: Axis) -> tuple[float, float] | None:
    """K and C of the spring and damper that fits the motions of a richer law best, where the result has usable ones."""
    for row in result.get("laws", ()):
        if (row.get("foot"), row.get("axis")) == (foot, axis):
            nearest = row.get("linear_equivalent") or {}
            stiffness, damping = (float(nearest.get(name) or math.nan) for name in ("stiffness", "damping"))
            if 0 < stiffness < math.inf and 0 < damping < math.inf:
                return stiffness, damping
    return None


def _usual_swing(result: Mapping[str, Any], foot: str, axis: Axis) -> float | None:
    """The amplitude in the middle of the identified motions [rad]; None where their scores do not show it.

    The nearest spring and damper to all motions are ruled by the largest, which may be an operator's pushes. A swing of
    amplitude a has a mean of 2·a/π: that of its torque is what the offset alone misses by.
    """
    nearest = _linear_equivalent(result, foot, axis)
    torques = [
        float(row["zero_mean_abs"])
        for row in result.get("validation", ())
        if (row.get("kind"), row.get("foot"), row.get("axis")) == ("direct", foot, axis)
        and isinstance(row.get("zero_mean_abs"), int | float)
    ]
    if nearest is None or not torques:
        return None
    swing = math.pi / 2 * float(np.median(torques)) / nearest[0]
    return swing if 0 < swing < 1 else None


def _number(value: object, what: str) -> float:
    if not isinstance(value, int | float) or not math.isfinite(value):
        raise ExportError(f"{what} is not a number", value=str(value), valid="a finite value")
    return float(value)
