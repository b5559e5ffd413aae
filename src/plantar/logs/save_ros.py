"""Messages out as a ROS 2 bag in one MCAP file; among them a planned motion, as one `JointTrajectory`."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from plantar.conventions import Array
from plantar.errors import needs
from plantar.files import atomic_write
from plantar.logs.readers.read_limit import BLOCK

TOPIC = "/joint_trajectory"
KIND = "trajectory_msgs/msg/JointTrajectory"
Topic = tuple[str, str, Any]  # name, type, and its serialised messages: bytes, or rows of bytes


def ros_types() -> Any:
    """The message types of ROS 2 as rosbags has them. Raises MissingExtra without rosbags."""
    with needs("rosbags", "logs", "writing MCAP"):
        from rosbags.typesys import Stores, get_typestore
    return get_typestore(Stores.ROS2_HUMBLE)


def write_mcap(path: Path, topics: Sequence[Topic], stamps: Sequence[int]) -> None:
    """Write the bag, whole or not at all, in time's order, so that one that is cut is a shorter one.

    topics: each with one message for each of `stamps` [ns]. Raises MissingExtra without rosbags.
    """
    store = ros_types()
    from rosbags.rosbag2 import StoragePlugin, Writer

    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "bag"
        with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            connections = [writer.add_connection(topic, kind, typestore=store) for topic, kind, _ in topics]
            for row, stamp in enumerate(stamps):
                for connection, (_, _, messages) in zip(connections, topics, strict=True):
                    writer.write(connection, stamp, bytes(messages[row]))
        with atomic_write(path) as handle, open(next(bag.glob("*.mcap")), "rb") as source:
            while block := source.read(BLOCK):
                handle.write(block)


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
