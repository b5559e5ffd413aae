"""An IMU that reads something impossible: units, the quaternion's order and sense, dead channels, a wrong sign."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from plantar.conventions import GRAVITY, Array, rotation_from_quaternion
from plantar.faults.gyroscope import Turns, check_gyroscope, rows_to_compare
from plantar.faults.quaternions import misread, readings
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Finding
from plantar.signals.held import coarse
from plantar.signals.segments import complete

ACCELEROMETER_UNIT = "accelerometer_unit"
WRONG_ANGLE = np.radians(25)  # between the accelerometer's up and the quaternion's: more is not noise
FREE = 2.0  # m/s²: a robot that stands or walks accelerates by less, usually
RIGHT_ANGLE = np.radians(8)  # likewise: less is a mount or an estimator


def check_imu(name: str, log: MotionLog) -> Iterator[Finding]:
    """Findings about one IMU's columns."""
    orientation, turning = log.orientation(name), log.has_imu(name, "angular_velocity")
    if turning:
        yield from _dead_channels(log, imu_columns(name, "angular_velocity"), orientation)
    accelerometer = log.has_imu(name, "linear_acceleration")
    problem = _accelerometer_size(name, log) if accelerometer else None
    if problem is not None:
        yield problem
    if orientation is None:
        return
    norm = np.linalg.norm(orientation, axis=1)
    columns = f"columns 'imu.{name}.orientation.*'"
    if not np.isfinite(norm).any():
        yield Finding("dead_channel", f"{columns}: hold no value (valid: leave the columns out)", True)
        return
    usual = float(np.nanmedian(norm))
    if not 0.9 < usual < 1.1:
        yield Finding("quaternion_norm", f"{columns}: the quaternion's norm is {usual:.3g} (valid: 1)", True)
        return
    orientation = np.where(norm[:, None] > 0.5, orientation, np.nan)
    turns = Turns.of(log, name, orientation) if turning else None
    if turns is not None:
        yield from check_gyroscope(name, log, orientation, turns)
    if accelerometer and problem is None:
        yield from _accelerometer_agrees(name, log, orientation, turns is not None and turns.agree)


def _dead_channels(log: MotionLog, columns: Sequence[str], orientation: Array | None) -> Iterator[Finding]:
    # What hardly turns a coarse sensor stays within one of its steps.
    moves = _moves(orientation) and not any(coarse(log.column(column)) for column in columns)
    for column in columns:
        values = log.column(column)
        finite = values[np.isfinite(values)]
        if finite.size == 0 or (moves and np.ptp(finite) == 0):
            yield Finding("dead_channel", f"column '{column}': never changes; is the channel dead?", True)


def _moves(orientation: Array | None) -> bool:
    """Whether the IMU surely turns."""
    whole = orientation[complete(orientation)] if orientation is not None else np.zeros((0, 4))
    return len(whole) > 0 and bool(np.max(np.std(whole, axis=0)) > 1e-3)


def without_odd_accelerometer(name: str, log: MotionLog) -> MotionLog:
    """The log without an accelerometer whose size is told by `check_imu`: Newton's law would refute all else by it."""
    columns = imu_columns(name, "linear_acceleration")
    odd = log.has(*columns) and _accelerometer_size(name, log) is not None
    return log.without(columns) if odd else log


def _accelerometer_size(name: str, log: MotionLog) -> Finding | None:
    """Whether the accelerometer's usual norm is gravity's, and its reading no constant beside an IMU that turns.

    Fatal where it is a unit that the user can name, or the sensor is dead and nothing else shows gravity.
    """
    acceleration = log.linear_acceleration(name)
    norm = np.linalg.norm(acceleration, axis=1)
    where = f"columns 'imu.{name}.linear_acceleration.*'"
    valid, alone = f"valid: m/s², about {GRAVITY:.2f} at rest", log.orientation(name) is None
    known = acceleration[np.isfinite(norm)]
    if known.any() and _moves(log.orientation(name)) and not np.ptp(known, axis=0).any():
        return Finding("dead_channel", f"{where}: never change; is the sensor dead? Not used ({valid})")
    if not np.isfinite(norm).any() or np.nanmax(norm) == 0:
        return Finding("dead_channel", f"{where}: hold no value; not used ({valid})", alone)
    size = float(np.nanmedian(norm))
    if 0.8 < size < 1.2:
        return Finding(
            ACCELEROMETER_UNIT,
            f"{where}: its norm is {size:.3g}, which looks like g, or like an acceleration without gravity ({valid})",
            True,
        )
    if not 0.6 * GRAVITY < size < 1.6 * GRAVITY:
        like = ", as of an acceleration without gravity" if size < FREE else ""
        text = f"{where}: its usual norm is {size:.3g}{like}; not used ({valid})"
        return Finding(ACCELEROMETER_UNIT, text)
    return None


def _accelerometer_agrees(name: str, log: MotionLog, orientation: Array, turns: bool) -> Iterator[Finding]:
    """The accelerometer's up against the quaternion's, which is as the columns say where the gyroscope `turns` so."""
    acceleration = log.linear_acceleration(name)
    rows = rows_to_compare(orientation, acceleration)
    if rows is None:
        return
    up = acceleration[rows] / np.linalg.norm(acceleration[rows], axis=1, keepdims=True)
    apart = {
        reading: float(
            np.median(
                np.arccos(np.clip(np.einsum("ni,ni->n", rotation_from_quaternion(read)[:, 2], up), -1, 1))
            )
        )
        for reading, read in readings(orientation[rows]).items()
    }
    best = min(apart, key=apart.__getitem__)
    if apart["as it is"] < WRONG_ANGLE:
        return
    text = f"up differs from the accelerometer's by {np.degrees(apart['as it is']):.0f} deg"
    if np.pi - apart["as it is"] < RIGHT_ANGLE:
        where = f"columns 'imu.{name}.linear_acceleration.*'"
        told = f"{where}: points down at rest, reversed, or the orientation's world has z down"
        if turns:
            told += "; the gyroscope turns as the orientation does"
        elif apart[best] < RIGHT_ANGLE:
            told += f"; or its quaternion is no w x y z: {best} it agrees"
        valid = f"valid: proper acceleration, +{GRAVITY:.2f} m/s² upwards at rest; orientation body to world, z up"
        yield Finding("sign", f"{told} ({valid})", True)
    elif apart[best] < RIGHT_ANGLE:
        yield misread(name, text, best)
    else:
        full = f"columns 'imu.{name}.orientation.*': {text} (valid: w x y z, body to world, z up)"
        yield Finding("attitude_mismatch", full, True)
