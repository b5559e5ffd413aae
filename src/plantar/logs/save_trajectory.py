"""A planned motion out: one `trajectory_msgs/JointTrajectory` in a ROS 2 bag (MCAP)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from plantar.conventions import Array
from plantar.logs.write_mcap import ros_types, write_mcap

TOPIC = "/joint_trajectory"
KIND = "trajectory_msgs/msg/JointTrajectory"


def save_trajectory(
    path: Path, joints: Sequence[str], time: Array, positions: Array, velocities: Array
) -> None:
    """Positions and velocities (N, n) [rad, rad/s] of `joints` at `time` (N,) [s from the start].

    Raises MissingExtra without rosbags.
    """
    store = ros_types()
    types = store.types
    moment, duration = types["builtin_interfaces/msg/Time"], types["builtin_interfaces/msg/Duration"]
    header = types["std_msgs/msg/Header"](stamp=moment(sec=0, nanosec=0), frame_id="")
    point = types["trajectory_msgs/msg/JointTrajectoryPoint"]
    none = positions[0, :0]
    points = [
        point(positions=q, velocities=v, accelerations=none, effort=none,
              time_from_start=duration(*divmod(round(t * 1e9), 10**9)))
        for t, q, v in zip(time.tolist(), positions, velocities, strict=True)
    ]  # fmt: skip
    message = types[KIND](header=header, joint_names=list(joints), points=points)
    write_mcap(path, [(TOPIC, KIND, [store.serialize_cdr(message, KIND)])], [0])
