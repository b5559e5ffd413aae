"""Imperfect sensors: quantised, noisy, biased, drifting and late, each recording drawn from a seed."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfilt, sosfilt_zi

from plantar.conventions import Array
from plantar.robot.model import RobotModel
from plantar.twin.sensing.attitude_filter import filtered_attitude
from plantar.twin.sensing.exact import Columns

RATE: Final = 1000.0  # Hz, of the devices' own samples
ORDER: Final = 2  # of their low-pass filters (Butterworth)
DEGREE: Final = np.pi / 180


@dataclass(frozen=True)
class Sensors:
    """Sizes of imperfections; white noise and what is drawn per recording are standard deviations.

    Encoders: quanta [rad, rad/s]; joint torque noise [N·m]. IMU: white noise of gyroscope [rad/s] and accelerometer
    [m/s²] per axis; gyroscope bias; attitude noise, bias of roll and pitch and their drift over the recording [rad],
    and bias and drift of yaw; `attitude_walk` [rad]: how far roll and pitch wander, a random walk's deviation at the
    recording's end. Wrench: white noise and zero [N, N·m]. `*_delay` [s]: how late a sensor is.
    `filtered_attitude`: the attitude comes from a filter on the gyroscope and accelerometer. `wrench_cutoff`,
    `gyroscope_cutoff` [Hz] and `wrench_hold` [s]: of the devices, as in `device_reading`; 0 turns them off.
    """

    encoder: float = 0.0
    encoder_rate: float = 0.0
    effort: float = 0.0
    gyroscope: tuple[float, float, float] = (0.0, 0.0, 0.0)
    accelerometer: tuple[float, float, float] = (0.0, 0.0, 0.0)
    gyroscope_bias: float = 0.0
    attitude: float = 0.0
    attitude_bias: float = 0.0
    attitude_drift: float = 0.0
    yaw_bias: float = 0.0
    yaw_drift: float = 0.0
    force: float = 0.0
    torque: float = 0.0
    force_zero: float = 0.0
    torque_zero: float = 0.0
    joint_delay: float = 0.0
    imu_delay: float = 0.0
    wrench_delay: float = 0.0
    filtered_attitude: bool = False
    attitude_walk: float = 0.0
    wrench_cutoff: float = 0.0
    gyroscope_cutoff: float = 0.0
    wrench_hold: float = 0.0


def sense(
    exact: Columns, time: Array, robot: RobotModel, sensors: Sensors, seed: int, name: str
) -> tuple[Columns, dict[str, float]]:
    """The columns as the sensors record them, and what was drawn for this recording (biases, zeros, drifts).

    The same seed and name give the same recording.
    """
    random = np.random.default_rng([seed, zlib.crc32(name.encode())])
    drawn: dict[str, float] = {}
    columns = {column: _late(column, values, time, sensors) for column, values in exact.items()}
    for column in columns:
        if column.startswith("joint."):
            columns[column] = _joint(column, columns[column], sensors, random)
    if robot.imu is not None:
        prefix = f"imu.{robot.imu.name}"
        for quantity, white, bias, cutoff in (
            ("angular_velocity", sensors.gyroscope, sensors.gyroscope_bias, sensors.gyroscope_cutoff),
            ("linear_acceleration", sensors.accelerometer, 0.0, 0.0),
        ):
            for place, axis in enumerate("xyz"):
                column = f"{prefix}.{quantity}.{axis}"
                if column not in columns:
                    continue
                zero = drawn[f"{column}.bias"] = random.normal(0, bias) if bias else 0.0
                columns[column] = zero + device_reading(
                    columns[column], time, white[place], cutoff, 0.0, random
                )
        names = [f"{prefix}.orientation.{axis}" for axis in "wxyz"]
        believed = np.column_stack([columns[n] for n in names])
        if sensors.filtered_attitude:
            rates, proper = (
                np.column_stack([columns[f"{prefix}.{quantity}.{axis}"] for axis in "xyz"])
                for quantity in ("angular_velocity", "linear_acceleration")
            )
            believed = filtered_attitude(believed[0], rates, proper, float(np.median(np.diff(time))))
        quaternions, errors = _attitude(believed, time, sensors, random)
        columns |= dict(zip(names, quaternions.T, strict=True))
        drawn |= {f"{prefix}.orientation.{key}": value for key, value in errors.items()}
    for foot in robot.feet.values():
        for kind, white_size, zero_size in (
            ("force", sensors.force, sensors.force_zero),
            ("torque", sensors.torque, sensors.torque_zero),
        ):
            for axis in "xyz":
                column = f"wrench.{foot.wrench.name}.{kind}.{axis}"
                zero = drawn[f"{column}.zero"] = random.normal(0, zero_size) if zero_size else 0.0
                columns[column] = zero + device_reading(
                    columns[column], time, white_size, sensors.wrench_cutoff, sensors.wrench_hold, random
                )
    return columns, drawn


def delayed(values: Array, time: Array, delay: float) -> Array:
    """What a sensor that is `delay` [s] late reads; before the first sample it reads the first."""
    if delay == 0.0:
        return values
    return np.asarray(CubicSpline(time, values)(np.maximum(time - delay, time[0])))


def _late(column: str, values: Array, time: Array, sensors: Sensors) -> Array:
    delays = {"joint": sensors.joint_delay, "imu": sensors.imu_delay, "wrench": sensors.wrench_delay}
    return delayed(values, time, delays[column.split(".", 1)[0]])


def _joint(column: str, values: Array, sensors: Sensors, random: np.random.Generator) -> Array:
    if column.endswith(".effort"):
        return values + _white(sensors.effort, values, random)
    quantum = sensors.encoder if column.endswith(".position") else sensors.encoder_rate
    return np.round(values / quantum) * quantum if quantum else values


def _white(size: float, like: Array, random: np.random.Generator) -> Array:
    return random.normal(0, size, like.shape) if size else np.zeros(like.shape)


def _attitude(
    exact: Array, time: Array, sensors: Sensors, random: np.random.Generator
) -> tuple[Array, dict[str, float]]:
    """Attitude with a small rotation about the world's axes in front: bias, drift and noise of roll, pitch, yaw."""
    share = (time - time[0]) / (time[-1] - time[0])
    tilt, drift = sensors.attitude_bias, sensors.attitude_drift
    sizes = {"x": (tilt, drift), "y": (tilt, drift), "z": (sensors.yaw_bias, sensors.yaw_drift)}
    angles, drawn = np.empty((time.size, 3)), {}
    for place, (axis, (bias, slope)) in enumerate(sizes.items()):
        drawn[f"bias.{axis}"] = random.normal(0, bias) if bias else 0.0
        drawn[f"drift.{axis}"] = random.normal(0, slope) if slope else 0.0
        angles[:, place] = drawn[f"bias.{axis}"] + drawn[f"drift.{axis}"] * share
        angles[:, place] += _white(sensors.attitude, time, random)
        if sensors.attitude_walk and axis != "z":
            steps = random.normal(0, sensors.attitude_walk / np.sqrt(time.size), time.size)
            angles[:, place] += np.cumsum(steps)
    half = np.column_stack([np.ones(time.size), angles / 2])
    return _multiply(half / np.linalg.norm(half, axis=1, keepdims=True), exact), drawn


def _multiply(a: Array, b: Array) -> Array:
    """Product of quaternions w x y z, (N, 4)."""
    (aw, ax, ay, az), (bw, bx, by, bz) = a.T, b.T
    return np.column_stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ]
    )


def device_reading(
    values: Array, time: Array, white: float, cutoff: float, hold: float, random: np.random.Generator
) -> Array:
    """What a log holds at `time` (N,) of a signal `values` (N,) that a device read.

    The device adds white noise of deviation `white` to each of its samples and filters them causally at `cutoff` [Hz]
    (0: not); its bus passes a new value every `hold` [s] (0: each), which the log repeats.
    """
    if not cutoff and not hold:
        return values + (random.normal(0, white, values.shape) if white else 0.0)
    count = round((time[-1] - time[0]) * RATE) + 1
    own = time[0] + np.arange(count) / RATE
    read = CubicSpline(time, values)(own) + (random.normal(0, white, count) if white else 0.0)
    if cutoff:
        sections = butter(ORDER, cutoff, fs=RATE, output="sos")
        read = sosfilt(sections, read, zi=sosfilt_zi(sections) * values[0])[0]
    place = np.clip(np.round((time - time[0]) * RATE).astype(np.intp), 0, count - 1)
    step = max(1, round(hold * RATE))
    return np.asarray(read[place - place % step])
