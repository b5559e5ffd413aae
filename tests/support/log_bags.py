"""One recording as ROS bags, by rosbags' own serialisers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from log_tables import FEET, IMU, Written, joints, moving, vector
from plantar.logs.motion_log import MotionLog


def ros_messages(log: MotionLog, store: Any, ros1: bool):  # type: ignore[no-untyped-def]
    """(topic, type, stamp, message) of a log, built as rosbags' objects."""
    types = store.types
    clock, header = types["builtin_interfaces/msg/Time"], types["std_msgs/msg/Header"]
    state, imu, wrench = (types[f"{t}"] for t in ("sensor_msgs/msg/JointState", "sensor_msgs/msg/Imu",
                                                    "geometry_msgs/msg/WrenchStamped"))  # fmt: skip
    three, four, inner = (types[f"geometry_msgs/msg/{t}"] for t in ("Vector3", "Quaternion", "Wrench"))
    names, fast = joints(log), moving(log)
    slow = [name for name in names if name not in fast]
    q = {name: log.column(f"joint.{name}.position") for name in names}
    v = {name: log.column(f"joint.{name}.velocity") for name in fast}
    attitude, rate = vector(log, f"imu.{IMU}.orientation", "xyzw"), vector(log, f"imu.{IMU}.angular_velocity")
    proper, none = vector(log, f"imu.{IMU}.linear_acceleration"), np.zeros(9)
    forces = {
        foot: (vector(log, f"wrench.{foot}.force"), vector(log, f"wrench.{foot}.torque")) for foot in FEET
    }
    empty = np.zeros(0)
    for row, stamp in enumerate(np.rint(log.time * 1e9).astype(np.int64).tolist()):

        def top(frame: str, stamp: int = stamp, row: int = row) -> Any:
            time = clock(sec=stamp // 10**9, nanosec=stamp % 10**9)
            return header(seq=row, stamp=time, frame_id=frame) if ros1 else header(stamp=time, frame_id=frame)

        for topic, group in (("/joint_states", fast), ("/neck/joint_states", slow)):
            position = np.array([q[name][row] for name in group])
            velocity = np.array([v[name][row] for name in group if name in v]) if group is fast else empty
            yield topic, "sensor_msgs/msg/JointState", stamp, state(
                header=top("base_link"), name=group, position=position, velocity=velocity, effort=empty)  # fmt: skip
        yield "/sensors/torso/imu", "sensor_msgs/msg/Imu", stamp, imu(
            header=top("torso"), orientation=four(*attitude[row].tolist()), orientation_covariance=none,
            angular_velocity=three(*rate[row].tolist()), angular_velocity_covariance=none,
            linear_acceleration=three(*proper[row].tolist()), linear_acceleration_covariance=none)  # fmt: skip
        for foot in FEET:
            force, torque = (three(*values[row].tolist()) for values in forces[foot])
            yield f"/ft/{foot}", "geometry_msgs/msg/WrenchStamped", stamp, wrench(
                header=top(f"{foot}_foot"), wrench=inner(force=force, torque=torque))  # fmt: skip


def write_ros2(log: MotionLog, folder: Path, plugin: str, compressed: bool = False) -> Written:
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    bag = folder / "bag"
    writer = Writer(bag, version=9, storage_plugin=StoragePlugin[plugin])
    if compressed:
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        open_topics: dict[str, Any] = {}
        for topic, kind, stamp, message in ros_messages(log, store, ros1=False):
            if topic not in open_topics:
                open_topics[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(open_topics[topic], stamp, store.serialize_cdr(message, kind))
    return bag, {}


def write_mcap(log: MotionLog, folder: Path) -> Written:
    bag, _ = write_ros2(log, folder, "MCAP", compressed=True)
    return next(bag.glob("*.mcap")), {}


def write_sqlite(log: MotionLog, folder: Path) -> Written:
    return write_ros2(log, folder, "SQLITE3")


def write_ros1(log: MotionLog, folder: Path, compression: str | None = None) -> Written:
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    writer = Writer(folder / "log.bag")
    if compression:
        writer.set_compression(Writer.CompressionFormat[compression])
    with writer:
        open_topics: dict[str, Any] = {}
        for topic, kind, stamp, message in ros_messages(log, store, ros1=True):
            if topic not in open_topics:
                open_topics[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(open_topics[topic], stamp, store.serialize_ros1(message, kind))
    return folder / "log.bag", {}
