"""A log as a robot's middleware writes it: few samples, devices on clocks of their own, the base's attitude alone.

Public recordings of walking humanoids look like this: no gyroscope and no accelerometer, the attitude of the root link
from somebody's estimator, and force sensors that were never zeroed in the air.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import yaml
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.files import write_text
from plantar.logs.motion_log import device_of
from plantar.robot.model import Imu, Placement, RobotModel
from plantar.twin.sensing.exact import Columns, labelled
from plantar.twin.simulation.rollout import Rollout

BASE: Final = "base"  # the name of the root link's attitude in a log


@dataclass(frozen=True)
class Logger:
    """`rate` [Hz] of the log. Each device's samples are taken `clock` [s] away from the log's time, the same in a
    recording, and `jitter` [s] beside, otherwise at each sample: standard deviations. Of the joints, only positions and
    velocities are written.

    `air` (3, 2) [N]: between which numbers the force sensor of a lifted foot reads on each axis, drawn by recording.
    """

    rate: float = 50.0
    clock: float = 0.003
    jitter: float = 0.002
    air: tuple[tuple[float, float], ...] = ((-25.0, -15.0), (-25.0, -15.0), (-80.0, -25.0))

    def logged(
        self, exact: Columns, rollout: Rollout, robot: RobotModel, random: np.random.Generator
    ) -> tuple[Array, Columns, dict[str, float]]:
        """Time (N,), the columns that are written, without noise, and what was drawn.

        They are those of `with_base_attitude(robot)`.
        """
        kept = {
            name: values
            for name, values in exact.items()
            if not name.startswith("imu.") and "effort" not in name
        }
        kept |= labelled(f"imu.{BASE}.orientation", "wxyz", rollout.base[:, 3:])
        time = np.arange(rollout.time[0], rollout.time[-1] + 1e-9, 1 / self.rate)
        drawn, taken = {}, {}
        for device in dict.fromkeys(map(_device, kept)):
            offset = drawn[f"{device}.clock"] = float(random.normal(0, self.clock))
            moments = time + offset + random.normal(0, self.jitter, time.size)
            taken[device] = np.clip(moments, rollout.time[0], rollout.time[-1])
        columns = {
            name: np.asarray(CubicSpline(rollout.time, values)(taken[_device(name)]))
            for name, values in kept.items()
        }
        for foot in robot.feet.values():
            for axis, (low, high) in zip("xyz", self.air, strict=True):
                name = f"wrench.{foot.wrench.name}.force.{axis}"
                drawn[f"{name}.air"] = float(random.uniform(low, high))
                columns[name] = columns[name] + drawn[f"{name}.air"]
        return time, columns, drawn


def with_base_attitude(robot: RobotModel) -> RobotModel:
    """The robot with its IMU on the root link."""
    root = robot.model.frames[1].name
    return replace(robot, imu=Imu(BASE, Placement(root, np.zeros(3), np.zeros(3))))


def write_robot(robot: RobotModel, path: Path, attitude_of_base: bool) -> Path:
    """Write a robot's file, its URDF beside it; with `attitude_of_base`, that of `with_base_attitude(robot)`."""
    file: dict[str, object] = yaml.safe_load(robot.path.read_text())  # `load_robot` has found it in order
    file["urdf"] = robot.urdf_path.name
    if attitude_of_base:
        file["imu"] = {"name": BASE, "link": robot.model.frames[1].name}
    write_text(path.with_name(robot.urdf_path.name), robot.urdf)
    write_text(path, yaml.safe_dump(file, sort_keys=False, default_flow_style=None))
    return path


def _device(column: str) -> str:
    """What samples a column: all joints together, the attitude, or one foot's sensor."""
    return "joint" if column.startswith("joint.") else device_of(column)
