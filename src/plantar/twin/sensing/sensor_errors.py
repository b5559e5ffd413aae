"""What the sensors of one robot get wrong in all of its recordings: gains, crosstalk, zeros of encoders, delays."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from plantar.conventions import Array
from plantar.logs.motion_log import wrench_columns
from plantar.robot.model import RobotModel
from plantar.twin.sensing.exact import Columns
from plantar.twin.sensing.sensors import delayed


@dataclass(frozen=True)
class SensorSpread:
    """Standard deviations of what a robot's sensors are off by.

    `gain`: share of each channel of a force sensor; `crosstalk`: between channels of a kind (share), and of forces in
    torques [N·m/N]; `encoder_zero` [rad]. Delays [s] are drawn as the size of a normal number, no sensor is early: the
    force sensors' common one, each foot's beside it, the IMU's and the encoders'.
    """

    gain: float = 0.01
    crosstalk: float = 0.004
    encoder_zero: float = 0.001
    wrench_delay: float = 0.0075
    foot_delay: float = 0.0005
    imu_delay: float = 0.001
    encoder_delay: float = 0.001


def with_sensor_errors(
    exact: Columns, time: Array, robot: RobotModel, spread: SensorSpread, seed: int
) -> tuple[Columns, dict[str, Any]]:
    """The columns (N,) with one robot's own errors, and what was drawn; the same seed gives the same robot."""
    random = np.random.default_rng([seed, zlib.crc32(b"sensors")])
    columns, drawn = dict(exact), dict[str, Any]()
    zeros = {joint: spread.encoder_zero * random.standard_normal() for joint in robot.joint_names}
    late = {"joint": spread.encoder_delay, "imu": spread.imu_delay, "wrench": spread.wrench_delay}
    late = {kind: abs(size * random.standard_normal()) for kind, size in late.items()}
    for foot in robot.feet.values():
        own = late["wrench"] + abs(spread.foot_delay * random.standard_normal())
        gains = np.eye(6) + np.diag(spread.gain * random.standard_normal(6))
        cross = spread.crosstalk * random.standard_normal((6, 6))
        cross[:3, 3:] = 0.0  # torques hardly reach the forces
        gains += cross - np.diag(np.diag(cross))
        kinds = wrench_columns(foot.wrench.name)
        read = np.column_stack([delayed(columns[name], time, own) for name in kinds]) @ gains.T
        columns |= dict(zip(kinds, read.T, strict=True))
        drawn |= {f"wrench.{foot.wrench.name}.gains": gains.tolist(), f"wrench.{foot.wrench.name}.delay": own}
    for name, values in columns.items():
        kind, rest = name.split(".", 1)
        if kind == "wrench":
            continue
        columns[name] = delayed(values, time, late[kind])
        if name.endswith(".position"):
            columns[name] = columns[name] + zeros[rest.removesuffix(".position")]
    return columns, drawn | {"joint.delay": late["joint"], "imu.delay": late["imu"], "joint.zeros": zeros}
