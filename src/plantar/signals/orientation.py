"""The IMU's orientation and angular velocity, each derived from the other sensors where a log lacks it."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array, cross
from plantar.errors import DataError, LogError
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import Imu
from plantar.signals.filters import differentiate
from plantar.signals.resampling import GAP_PERIODS, interpolate


def attitude(log: MotionLog, imu: Imu, notes: list[Note]) -> tuple[Array, Array]:
    """Orientation w x y z (N, 4) and angular velocity (N, 3) of the IMU, derived where one is missing."""
    name = imu.name
    orientation = log.orientation(name)
    if orientation is not None:
        if log.has_imu(name, "angular_velocity"):
            return orientation, log.angular_velocity(name)
        text = f"{log.name}: no angular velocity; rates come from differentiated orientation, damping is less sure"
        notes.append(Note("gyroscope_missing", "warning", text))
        return orientation, rates_from(orientation, log.period)
    others = [device.removeprefix("imu.") for device in log.devices("imu")]
    if name not in others:
        valid = f"imu.{name}.orientation.w, .x, .y, .z, or angular_velocity and linear_acceleration"
        valid += f"; in the robot file imu.name as the log has it: {', '.join(others)}" if others else ""
        message = f"columns 'imu.{name}.*' are missing"
        raise LogError(message, path=log.source, valid=valid)
    rates, acceleration = log.angular_velocity(name), log.linear_acceleration(name)
    whole = np.isfinite(np.column_stack([rates, acceleration])).all(axis=1)
    if not whole.any():
        raise DataError(f"imu '{name}' has no sample with all values", path=log.source)
    filled = [
        interpolate(log.time, log.time[whole], column[whole], np.inf)
        for column in (*rates.T, *acceleration.T)
    ]
    bridged = np.nan_to_num(np.column_stack(filled))
    from plantar.signals.attitude import (
        attitude_from_inertial,  # its rotations cost start-up, and few logs need them
    )

    # Across a gap nobody knows how it has turned.
    breaks = np.flatnonzero(np.diff(log.time) > GAP_PERIODS * log.period) + 1
    pieces = [attitude_from_inertial(one[:, :3], one[:, 3:], log.period) for one in np.split(bridged, breaks)]
    orientation = np.concatenate(pieces)
    orientation[~whole] = np.nan
    text = f"{log.name}: no IMU orientation; gravity's direction blended from gyroscope and accelerometer"
    notes.append(Note("attitude_derived", "warning", text))
    return orientation, rates


def unit_quaternions(orientation: Array) -> Array:
    """Quaternions (N, 4) of length 1; NaN for those of none."""
    length = np.linalg.norm(orientation, axis=1, keepdims=True)
    return np.asarray(orientation / np.where(length > 0, length, np.nan))


def rates_from(orientation: Array, period: float) -> Array:
    """Angular velocity in the body frame, (N, 3), from quaternions w x y z by central differences."""
    norm = np.linalg.norm(orientation, axis=1, keepdims=True)
    unit = orientation / np.where(norm > 0, norm, np.nan)
    flips = np.where(np.sum(unit[1:] * unit[:-1], axis=1) < 0, -1.0, 1.0)
    unit = unit * np.concatenate([[1.0], np.cumprod(flips)])[:, None]
    slope = differentiate(unit, period)
    w, vector, dw, dvector = unit[:, :1], unit[:, 1:], slope[:, :1], slope[:, 1:]
    return np.asarray(2 * (w * dvector - dw * vector - cross(vector, dvector)))
