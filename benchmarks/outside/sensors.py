"""What a lab's sensors make of a motion: zeros, gains, crosstalk, delays, filters, noise, an attitude that wanders."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import butter, lfilter, lfilter_zi, sosfiltfilt
from scipy.spatial.transform import Rotation

from outside.physics import Motion
from plantar.conventions import Array
from plantar.robot.model import RobotModel

SECOND_ORDER = np.sqrt(2) / (2 * np.pi)  # delay of a Butterworth filter of second order, times its cutoff
SAMPLED = 0.4  # of a log's rate: quicker than that a sensor passes nothing on
RATES = (100.0, 200.0, 250.0, 500.0, 1000.0)  # Hz


@dataclass(frozen=True)
class Lab:
    """Standard deviations where not said otherwise; forces are shares of the weight, torques of weight and metre."""

    encoder_zero: float = 0.001  # rad
    encoder_step: float = 4e-5  # rad
    gain: float = 0.01
    crosstalk: float = 0.004  # N·m/N, and between channels of a kind
    force_zero: float = 0.004
    torque_zero: float = 0.0008
    force_noise: float = 0.001
    torque_noise: float = 0.0001
    wrench_delay: tuple[float, float] = (0.0, 0.010)  # s, from and to
    apart: float = 0.0005  # s, of one foot behind the other
    imu_delay: tuple[float, float] = (0.0, 0.002)
    wrench_cutoff: float = 80.0  # Hz; 0: none
    gyroscope_noise: float = 0.001  # rad/s
    gyroscope_bias: float = 0.001
    accelerometer_noise: float = 0.01  # m/s²
    accelerometer_bias: float = 0.05
    attitude_noise: float = 1e-4  # rad
    attitude_bias: float = 0.003
    attitude_wander: float = 5e-4  # rad, within `wander_time`
    wander_time: tuple[float, float] = (8.0, 40.0)  # s


EXACT = Lab(0, 0, 0, 0, 0, 0, 0, 0, (0, 0), 0, (0, 0), 0, 0, 0, 0, 0, 0, 0, 0)


@dataclass(frozen=True)
class Drawn:
    """One robot's sensors. `late` of each force sensor behind the IMU [s], filters counted; `rate` of its logs [Hz]."""

    rate: float
    zeros: Array
    matrices: Mapping[str, Array]
    transport: Mapping[str, float]
    imu_delay: float
    late: Mapping[str, float]
    wander_time: float


def draw_sensors(robot: RobotModel, lab: Lab, seed: int, rate: float | None = None) -> Drawn:
    """The errors that stay the same in all logs of a robot."""
    random = np.random.default_rng([seed, zlib.crc32(robot.name.encode()), 3])
    common, imu = random.uniform(*lab.wrench_delay), random.uniform(*lab.imu_delay)
    matrices, transport = {}, {}
    for name in robot.feet:
        matrix = np.zeros((6, 6))
        for rows in (slice(0, 3), slice(3, 6)):
            matrix[rows, rows] = lab.crosstalk * random.standard_normal((3, 3))
        matrix[3:, :3] = lab.crosstalk * random.standard_normal((3, 3))
        matrix[range(6), range(6)] = 1 + lab.gain * random.standard_normal(6)
        matrices[name] = matrix
        transport[name] = common + lab.apart * random.standard_normal()
    filtered = SECOND_ORDER / lab.wrench_cutoff if lab.wrench_cutoff else 0.0
    return Drawn(
        rate or float(random.choice(RATES)),
        lab.encoder_zero * random.standard_normal(len(robot.joint_names)),
        matrices,
        transport,
        imu,
        {name: value + filtered - imu for name, value in transport.items()},
        random.uniform(*lab.wander_time),
    )


def record(
    robot: RobotModel, motion: Motion, lab: Lab, drawn: Drawn, seed: int, name: str
) -> dict[str, Array]:
    """The log's columns, `time` first."""
    assert robot.imu is not None
    random = np.random.default_rng([seed, zlib.crc32(robot.name.encode()), zlib.crc32(name.encode())])
    time = np.arange(0.05, motion.time[-1], 1 / drawn.rate)
    noise, motion = random.standard_normal, _sampled(motion, drawn.rate)
    joints = _late(motion, motion.joints, 0.0, time) + drawn.zeros
    if lab.encoder_step:
        joints = lab.encoder_step * np.round(joints / lab.encoder_step)
    columns = {"time": time - time[0]}
    columns |= {f"joint.{joint}.position": joints[:, i] for i, joint in enumerate(robot.joint_names)}
    seen = Rotation.from_quat(_late(motion, motion.orientation, drawn.imu_delay, time), scalar_first=True)
    lean = lab.attitude_bias * noise(3) + lab.attitude_wander * _wander(time, drawn.wander_time, random)
    seen = Rotation.from_rotvec(lean + lab.attitude_noise * noise((len(time), 3))) * seen
    turning = _late(motion, motion.turning, drawn.imu_delay, time) + lab.gyroscope_bias * noise(3)
    turning += lab.gyroscope_noise * noise((len(time), 3))
    pull = _late(motion, motion.pull, drawn.imu_delay, time) + lab.accelerometer_bias * noise(3)
    pull += lab.accelerometer_noise * noise((len(time), 3))
    imu = f"imu.{robot.imu.name}"
    for kind, axes, values in (
        ("orientation", "wxyz", seen.as_quat(scalar_first=True)),
        ("angular_velocity", "xyz", turning),
        ("linear_acceleration", "xyz", pull),
    ):
        columns |= {f"{imu}.{kind}.{axis}": values[:, i] for i, axis in enumerate(axes)}
    weight = robot.mass * 9.81
    for foot, wrench in motion.wrenches.items():
        read = _filtered(wrench @ drawn.matrices[foot].T, lab.wrench_cutoff)
        read = _late(motion, read, drawn.transport[foot], time)
        sizes = (
            np.repeat([lab.force_zero, lab.torque_zero], 3),
            np.repeat([lab.force_noise, lab.torque_noise], 3),
        )
        read = read + weight * (sizes[0] * noise(6) + sizes[1] * noise((len(time), 6)))
        sensor = f"wrench.{robot.feet[foot].wrench.name}"
        for start, kind in ((0, "force"), (3, "torque")):
            columns |= {f"{sensor}.{kind}.{axis}": read[:, start + i] for i, axis in enumerate("xyz")}
    return columns


def write(columns: Mapping[str, Array], path: str) -> None:
    """As CSV, with the digits that such files have."""
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, fmt="%.7g", delimiter=",", header=",".join(columns), comments="")


def _sampled(motion: Motion, rate: float) -> Motion:
    """Without what a log of this rate cannot hold: feet strike the floor faster than that."""
    if rate >= 1000.0:
        return motion
    filtered = butter(4, SAMPLED * rate, fs=1000.0, output="sos")

    def slowed(values: Array) -> Array:
        return np.asarray(sosfiltfilt(filtered, values, axis=0))

    wrenches = {foot: slowed(wrench) for foot, wrench in motion.wrenches.items()}
    return replace(
        motion, joints=slowed(motion.joints), turning=slowed(motion.turning), pull=slowed(motion.pull),
        wrenches=wrenches,
    )  # fmt: skip


def _late(motion: Motion, values: Array, delay: float, time: Array) -> Array:
    return np.column_stack([np.interp(time - delay, motion.time, column) for column in values.T])


def _filtered(values: Array, cutoff: float) -> Array:
    if not cutoff:
        return values
    b, a = butter(2, cutoff, fs=1000.0)
    start = lfilter_zi(b, a)[:, None] * values[0]
    return np.asarray(lfilter(b, a, values, axis=0, zi=start)[0])


def _wander(time: Array, length: float, random: np.random.Generator) -> Array:
    """A Gauss-Markov process of deviation 1 about each axis (n, 3)."""
    keep = np.exp(-np.diff(time, prepend=time[0] - 1.0)[1] / length) if len(time) > 1 else 0.0
    pushes = np.sqrt(1 - keep**2) * random.standard_normal((len(time), 3))
    pushes[0] = random.standard_normal(3)
    return np.asarray(lfilter([1.0], [1.0, -keep], pushes, axis=0))
