"""A motion in the files that controllers take."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.files import write_text
from plantar.logs.motion_log import MotionLog
from plantar.logs.save_trajectory import save_trajectory


def _positions(log: MotionLog) -> tuple[list[str], Array]:
    """Joints in the log's order, and their positions (N, n)."""
    joints = [column.removeprefix("joint.").removesuffix(".position") for column in log.columns]
    return joints, log.stack(log.columns)


def write_ros(log: MotionLog, path: Path) -> None:
    """`trajectory_msgs/JointTrajectory` as YAML, as `ros2 topic pub` takes it."""
    joints, positions = _positions(log)
    velocities = CubicSpline(log.time, positions, bc_type="clamped")(log.time, 1)
    lines = ["header: {frame_id: ''}", f"joint_names: [{', '.join(joints)}]", "points:"]
    for time, place, speed in zip(log.time.tolist(), positions, velocities, strict=True):
        seconds, nanoseconds = divmod(round(time * 1e9), 10**9)
        lines.append(f"- positions: [{_numbers(place)}]")
        lines.append(f"  velocities: [{_numbers(speed)}]")
        lines.append(f"  time_from_start: {{sec: {seconds}, nanosec: {nanoseconds}}}")
    write_text(path, "\n".join(lines) + "\n")


def write_mcap(log: MotionLog, path: Path) -> None:
    """One `trajectory_msgs/JointTrajectory` in a bag, on the topic `/joint_trajectory`."""
    joints, positions = _positions(log)
    velocities = CubicSpline(log.time, positions, bc_type="clamped")(log.time, 1)
    save_trajectory(path, joints, log.time, positions, np.asarray(velocities))


def write_pos(log: MotionLog, path: Path) -> None:
    """OpenHRP's sequence file: a line for each sample, time and then the joints in the URDF's order [rad]."""
    _, positions = _positions(log)
    rows = [
        f"{time:.6f} {_numbers(row, ' ')}" for time, row in zip(log.time.tolist(), positions, strict=True)
    ]
    write_text(path, "\n".join(rows) + "\n")


def _numbers(values: Array, between: str = ", ") -> str:
    return between.join(f"{value:.7f}" for value in values.tolist())


# What may be asked for: the file's ending and who writes it.
TARGETS: Final[Mapping[str, tuple[str, Callable[[MotionLog, Path], None]]]] = MappingProxyType(
    {"ros": (".yaml", write_ros), "mcap": (".mcap", write_mcap), "openhrp": (".pos", write_pos)}
)
