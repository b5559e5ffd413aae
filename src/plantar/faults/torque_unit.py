"""Torques in another unit than N·m: they must balance the moments of the feet's forces about the centre of mass."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.faults.stance import StanceSides
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import RobotModel

TORQUE_UNIT = "torque_unit"
# Correlation of both moments, and of each third of the log: of real robots whose masses or legs are otherwise it is
# near zero, but for a part of a log by chance.
FOLLOWS, IN_PARTS = 0.75, 0.4
SHORTEST = 3.0  # s of a log: a shorter one is part of a motion
ROUNDING = 1e-9  # m, rms: forces that move their moments about the centre of mass less do not move
STILL = 0.03  # of the squares: a third of the log that moves less tells nothing
ANOTHER_UNIT = 3.0  # times too large or too small: no gain is as wrong
BETTER = 0.99  # share of what all torques leave: below it those of one foot alone are in another unit
LIKE = 1.4  # times: what moves makes moments, too
UNITS = {0.001: "N·mm", 0.01: "N·cm", 9.80665: "kgf·m", 0.0980665: "kgf·cm", 1000.0: "kN·m"}


class _Scale(NamedTuple):
    """By how much torques of `columns` must be larger to balance the rest of the moments, how these correlate, the
    `squares` of the rest and what is then left of them [m²]."""

    left: float
    squares: float
    correlation: float
    scale: float
    columns: str
    feet: tuple[int, ...]


def torque_unit(robot: RobotModel, log: MotionLog, sides: StanceSides) -> Iterator[Finding]:
    """A fatal finding where the torques of all feet, or of one, follow the other moments at another scale.

    Without an accelerometer, where soles do not stand still either, nothing else would tell: another unit looks like
    other rubber. They must do so also beside what follows the robot's acceleration: in a sway its angular momentum is
    as large as one foot's torques.
    """
    if log.duration < SHORTEST:
        return
    moment_arms = sides.moment_arms
    sensors = [foot.wrench.name for foot in robot.feet.values()]
    found = _scale(moment_arms, tuple(range(len(sensors))), "columns 'wrench.*.torque.*'")
    for place, sensor in enumerate(sensors):
        alone = _scale(moment_arms, (place,), f"columns 'wrench.{sensor}.torque.*'")
        found = alone if alone.left < BETTER * found.left else found
    whole, torques = moment_arms.sum(axis=(1, 2)), moment_arms[:, :, 3:].sum(axis=2)
    # Beside one foot's that are reversed the other's look three times too small.
    turned = min(float(np.sum(_moving(whole - 2 * one) ** 2)) for one in torques.transpose(1, 0, 2))
    stands = found.squares < len(moment_arms) * ROUNDING**2
    if stands or found.correlation < FOLLOWS or turned < found.left:
        return
    beside = _scale(_beside_acceleration(sides), found.feet, found.columns)
    if any(1 / ANOTHER_UNIT < one.scale < ANOTHER_UNIT for one in (found, beside)):
        return
    parts = [_scale(part, found.feet, found.columns) for part in np.array_split(moment_arms, 3)]
    moved = [part for part in parts if part.squares > STILL * found.squares]
    if len(moved) < 2 or min(part.correlation for part in moved) < IN_PARTS:
        return
    nearest = min(UNITS, key=lambda unit: abs(np.log(unit / found.scale)))
    like = f"; these look like {UNITS[nearest]}" if 1 / LIKE < nearest / found.scale < LIKE else ""
    times = f"{float(f'{found.scale:.2g}'):g} times"
    text = f"{found.columns}: torques {times} as large would balance the moments of the forces"
    yield Finding(TORQUE_UNIT, f"{text} (valid: torques in N·m{like})", True)


def _scale(moment_arms: Array, feet: tuple[int, ...], columns: str) -> _Scale:
    torques = _moving(moment_arms[:, [*feet], 3:].sum(axis=(1, 2)))
    rest = _moving(moment_arms.sum(axis=(1, 2))) - torques
    together, squares = -float(np.sum(rest * torques)), (float(np.sum(torques**2)), float(np.sum(rest**2)))
    if not together > 0:
        return _Scale(squares[1], squares[1], 0.0, 1.0, columns, feet)
    correlation = together / np.sqrt(squares[0] * squares[1])
    return _Scale(
        squares[1] * (1 - correlation**2), squares[1], correlation, together / squares[0], columns, feet
    )


def _beside_acceleration(sides: StanceSides) -> Array:
    """Changes of the moment arms (n, feet, 6, 3) [m] but for what follows the robot's acceleration about each axis."""
    arms, pulled = sides.moment_arms - sides.moment_arms.mean(axis=0), _moving(np.cross(sides.up, sides.push))
    power = np.sum(pulled**2, axis=0)
    share = np.einsum("nfkx,nx->fkx", arms, pulled) / np.where(power > 0, power, np.inf)
    return np.asarray(arms - share * pulled[:, None, None])


def _moving(moments: Array) -> Array:
    """Moments (n, 3) without their mean, as zeros and masses in another place make it."""
    return np.asarray(moments - moments.mean(axis=0))
