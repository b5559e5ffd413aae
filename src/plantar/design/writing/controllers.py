"""A motion in the files that controllers take."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.design.trajectory import Trajectory
from plantar.errors import SettingsError
from plantar.files import write_text
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers.column_map import joint_order
from plantar.logs.save_mc_rtc import save_mc_rtc
from plantar.logs.save_ros import save_trajectory
from plantar.robot.model import RobotModel


def ordered_joints(robot: RobotModel) -> tuple[str, ...]:
    """Joints in the controller's order where the robot file tells it, `columns.joints`, else in the URDF's.

    Raises SettingsError where it names one that the URDF lacks.
    """
    order = joint_order(robot) or robot.joint_names
    unknown = next((name for name in order if name not in robot.joint_names), None)
    if unknown is not None:
        message = f"columns.joints names '{unknown}', which the URDF lacks"
        raise SettingsError(message, path=robot.path, valid="joints of the URDF, in the controller's order")
    return order


def _positions(log: MotionLog) -> tuple[list[str], Array]:
    """Joints in the log's order, and their positions (N, n)."""
    joints = [column.removeprefix("joint.").removesuffix(".position") for column in log.columns]
    return joints, log.stack(log.columns)


def _of_controller(motion: Trajectory, log: MotionLog) -> Array:
    """Positions (N, n) in the controller's order."""
    return log.stack([f"joint.{name}.position" for name in ordered_joints(motion.legs.body.robot)])


def write_ros(motion: Trajectory, rate: float, path: Path) -> None:
    """`trajectory_msgs/JointTrajectory` as YAML, as `ros2 topic pub` takes it."""
    log = motion.log(rate)
    joints, positions = _positions(log)
    velocities = CubicSpline(log.time, positions, bc_type="clamped")(log.time, 1)
    lines = ["header: {frame_id: ''}", f"joint_names: [{', '.join(joints)}]", "points:"]
    for time, place, speed in zip(log.time.tolist(), positions, velocities, strict=True):
        seconds, nanoseconds = divmod(round(time * 1e9), 10**9)
        lines.append(f"- positions: [{_numbers(place)}]")
        lines.append(f"  velocities: [{_numbers(speed)}]")
        lines.append(f"  time_from_start: {{sec: {seconds}, nanosec: {nanoseconds}}}")
    write_text(path, "\n".join(lines) + "\n")


def write_mcap(motion: Trajectory, rate: float, path: Path) -> None:
    """One `trajectory_msgs/JointTrajectory` in a bag, on the topic `/joint_trajectory`."""
    log = motion.log(rate)
    joints, positions = _positions(log)
    velocities = CubicSpline(log.time, positions, bc_type="clamped")(log.time, 1)
    save_trajectory(path, joints, log.time, positions, np.asarray(velocities))


def write_pos(motion: Trajectory, rate: float, path: Path) -> None:
    """OpenHRP's sequence file: a line for each sample, time and then the joints in the controller's order [rad]."""
    log = motion.log(rate)
    positions = _of_controller(motion, log)
    rows = [
        f"{time:.6f} {_numbers(row, ' ')}" for time, row in zip(log.time.tolist(), positions, strict=True)
    ]
    write_text(path, "\n".join(rows) + "\n")


def write_mc_rtc(motion: Trajectory, rate: float, path: Path) -> None:
    """mc_rtc's binary log, which its Replay plugin plays `with-outputs`."""
    log = motion.log(rate)
    save_mc_rtc(path, log.time, _of_controller(motion, log), motion.base(rate))


def _numbers(values: Array, between: str = ", ") -> str:
    return between.join(f"{value:.7f}" for value in values.tolist())


# What may be asked for: the file's ending and who writes it.
TARGETS: Final[Mapping[str, tuple[str, Callable[[Trajectory, float, Path], None]]]] = MappingProxyType(
    {
        "ros": (".yaml", write_ros),
        "mcap": (".mcap", write_mcap),
        "openhrp": (".pos", write_pos),
        "mc_rtc": (".bin", write_mc_rtc),
    }
)
