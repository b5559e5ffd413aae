"""One recording written in every format that plantar reads, by other software or by the format's own words.

Each writer takes a log and a folder and returns what to open and the `columns:` that the robot file then needs.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pa_parquet
from scipy.spatial.transform import Rotation

from plantar.log import MotionLog

Written = tuple[Path, dict[str, Any]]
IMU, FEET = "chest", ("left", "right")


def joints(log: MotionLog) -> list[str]:
    return [
        name.split(".")[1] for name in log.columns if name.startswith("joint.") and name.endswith(".position")
    ]


def moving(log: MotionLog) -> list[str]:
    """Joints with a velocity; the neck has none."""
    return [joint for joint in joints(log) if log.has(f"joint.{joint}.velocity")]


def vector(log: MotionLog, stem: str, axes: str = "xyz") -> np.ndarray:
    return log.stack(f"{stem}.{axis}" for axis in axes)


def positions(log: MotionLog) -> np.ndarray:
    return log.stack(f"joint.{joint}.position" for joint in joints(log))


def velocities(log: MotionLog) -> np.ndarray:
    return log.stack(f"joint.{joint}.velocity" for joint in moving(log))


def table(log: MotionLog) -> pa.Table:
    return pa.table({"time": log.time, **log.columns})


def write_csv(log: MotionLog, folder: Path) -> Written:
    pa_csv.write_csv(table(log), folder / "log.csv")
    return folder / "log.csv", {}


def write_parquet(log: MotionLog, folder: Path) -> Written:
    pa_parquet.write_table(table(log), folder / "log.parquet")
    return folder / "log.parquet", {}


def write_npz(log: MotionLog, folder: Path) -> Written:
    np.savez_compressed(folder / "log.npz", time=log.time, **log.columns)
    return folder / "log.npz", {}


def foreign(log: MotionLog) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Other names and units: ms, degrees, g, N·mm, a sensor of the other sign, quaternion x y z w."""
    data = {"stamp": log.time * 1e3}
    columns: dict[str, Any] = {"time": {"from": "stamp", "unit": "ms"}}
    for joint in joints(log):
        data[f"q_{joint}"] = np.degrees(log.column(f"joint.{joint}.position"))
        columns[f"joint.{joint}.position"] = {"from": f"q_{joint}", "unit": "deg"}
    for joint in moving(log):
        data[f"dq_{joint}"] = np.degrees(log.column(f"joint.{joint}.velocity"))
        columns[f"joint.{joint}.velocity"] = {"from": f"dq_{joint}", "unit": "deg/s"}
    for word, stem, scale, unit, sign in (
        ("w", f"imu.{IMU}.angular_velocity", 180 / np.pi, "deg/s", 1),
        ("a", f"imu.{IMU}.linear_acceleration", 1 / 9.80665, "g", 1),
        *((f"f{foot}", f"wrench.{foot}.force", -1e-3, "kN", -1) for foot in FEET),
        *((f"m{foot}", f"wrench.{foot}.torque", -1e3, "N·mm", -1) for foot in FEET),
    ):
        data |= {f"{word}{axis}": scale * log.column(f"{stem}.{axis}") for axis in "xyz"}
        columns[stem] = {"from": [f"{word}{axis}" for axis in "xyz"], "unit": unit, "sign": sign}
    data |= {f"q{axis}": log.column(f"imu.{IMU}.orientation.{axis}") for axis in "xyzw"}
    columns[f"imu.{IMU}.orientation"] = {"from": ["qx", "qy", "qz", "qw"], "order": "xyzw"}
    return data, columns


def write_mapped_csv(log: MotionLog, folder: Path) -> Written:
    data, columns = foreign(log)
    pa_csv.write_csv(pa.table(data), folder / "foreign.csv")
    return folder / "foreign.csv", columns


def write_mapped_npz(log: MotionLog, folder: Path) -> Written:
    data, columns = foreign(log)
    np.savez(folder / "foreign.npz", **data)
    return folder / "foreign.npz", columns


def write_astate(log: MotionLog, folder: Path) -> Written:
    """OpenHRP's astate.log: numbers without a header, found by their place."""
    data, columns = foreign(log)
    places = {name: index for index, name in enumerate(data)}
    np.savetxt(folder / "astate.log", np.column_stack(list(data.values())), fmt="%.17g")
    for entry in columns.values():
        entry["from"] = (
            [places[name] for name in entry["from"]]
            if isinstance(entry["from"], list)
            else places[entry["from"]]
        )
    return folder / "astate.log", columns


# --- ROS, by rosbags' own serialisers ---------------------------------------------------------------------


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


# --- the robots' own loggers ------------------------------------------------------------------------------


def write_mc_rtc(log: MotionLog, folder: Path, version: int = 0) -> Written:
    """Entries as mc_rtc's Logger writes them; a key that comes and goes stands in the middle."""
    import msgpack

    # The body sensor's orientation turns world into body.
    attitude = vector(log, f"imu.{IMU}.orientation", "wxyz") * [1, -1, -1, -1]
    wrenches = {
        foot: np.hstack([vector(log, f"wrench.{foot}.torque"), vector(log, f"wrench.{foot}.force")])
        for foot in FEET
    }
    parts: list[tuple[str, int, np.ndarray]] = [
        ("t", 11, log.time), ("qIn", 21, positions(log)), ("alphaIn", 21, velocities(log)),
        ("rpyIn", 17, attitude), ("rateIn", 14, vector(log, f"imu.{IMU}.angular_velocity")),
        ("accIn", 14, vector(log, f"imu.{IMU}.linear_acceleration")),
        *((f"{foot.title()}FootForceSensor", 19, wrenches[foot]) for foot in FEET),
    ]  # fmt: skip
    with open(folder / "mc_rtc.bin", "wb") as handle:
        handle.write(bytes([0x41, 0x4E, 0x4E, 0x45 + version]))
        for row in range(len(log)):
            extra = [("perf", 10, np.float32(row))] if 50 <= row < 80 else []
            now = extra + [(key, kind, values[row]) for key, kind, values in parts]
            changed = row in (0, 50, 80)
            values = [value.tolist() for _, _, value in now]
            if version == 0:
                head = [key for key, _, _ in now] if changed else None
                body = [
                    part for (_, kind, _), value in zip(now, values, strict=True) for part in (kind, value)
                ]
            else:
                added = [[0, kind, key] for key, kind, _ in now]
                head = (
                    added
                    if row == 0
                    else [[0, 10, "perf"]]
                    if row == 50
                    else [[1, "perf"]]
                    if row == 80
                    else None
                )
                body = values if not extra else [*values[1:], values[0]]
            entry = msgpack.packb([head, body])
            handle.write(struct.pack("<Q", len(entry)) + entry)
    ports = {"alphaIn": {"role": "joints.velocity", "joints": moving(log)}}
    return folder / "mc_rtc.bin", {"joints": joints(log), "ports": ports}


def write_hrpsys(log: MotionLog, folder: Path) -> Written:
    """One file a port, at the logger's highest precision; the attitude as roll, pitch, yaw."""
    rpy = Rotation.from_quat(vector(log, f"imu.{IMU}.orientation", "xyzw")).as_euler("xyz")
    ports = {
        "RobotHardware0_q": positions(log), "RobotHardware0_dq": velocities(log), "kf_rpy": rpy,
        "RobotHardware0_gyrometer": vector(log, f"imu.{IMU}.angular_velocity"),
        "RobotHardware0_gsensor": vector(log, f"imu.{IMU}.linear_acceleration"),
        "RobotHardware0_lfsensor": np.hstack([vector(log, f"wrench.left.{k}") for k in ("force", "torque")]),
        "RobotHardware0_rfsensor": np.hstack([vector(log, f"wrench.right.{k}") for k in ("force", "torque")]),
    }  # fmt: skip
    for port, values in ports.items():
        with open(folder / f"walk.{port}", "w") as handle:
            for time, row in zip(log.time, values, strict=True):
                handle.write(f"{time:.6f} " + "".join(f"{value:.16e} " for value in row) + "\n")
    roles = {"RobotHardware0_dq": {"role": "joints.velocity", "joints": moving(log)}}
    return folder / "walk.RobotHardware0_q", {"joints": joints(log), "ports": roles}


def write_yarp(log: MotionLog, folder: Path) -> Written:
    """Dumps of ports in YARP's own units; the IMU's port holds roll, pitch, yaw, acceleration and rate."""
    rpy = Rotation.from_quat(vector(log, f"imu.{IMU}.orientation", "xyzw")).as_euler("xyz", degrees=True)
    inertial = np.hstack([rpy, vector(log, f"imu.{IMU}.linear_acceleration"),
                          np.degrees(vector(log, f"imu.{IMU}.angular_velocity"))])  # fmt: skip
    ports = {
        "body/state": np.degrees(positions(log)),
        "body/speed": np.degrees(velocities(log)),
        "inertial": inertial,
    }
    ports |= {
        f"{foot}_foot": np.hstack([vector(log, f"wrench.{foot}.{k}") for k in ("force", "torque")])
        for foot in FEET
    }
    for port, values in ports.items():
        (folder / "dump" / port).mkdir(parents=True)
        both = port == "inertial"
        (folder / "dump" / port / "info.log").write_text(
            f"Type: Bottle;\nStamp: {'tx;rx;' if both else 'rx;'}\n[1] /a [connected]\n"
        )
        with open(folder / "dump" / port / "data.log", "w") as handle:
            for row, (time, line) in enumerate(zip(log.time, values, strict=True)):
                stamps = f"{time:.9f} {time + 0.5:.9f}" if both else f"{time:.9f}"
                body = " ".join(f"{value:.17g}" for value in line)
                handle.write(f"{row} {stamps} " + (f"({body})" if port == "body/state" else body) + "\n")
    roles = {
        "body/state": {"role": "joints.position", "unit": "deg"},
        "body/speed": {"role": "joints.velocity", "unit": "deg/s", "joints": moving(log)},
        "inertial": [{"role": f"imu.{IMU}.orientation.rpy", "unit": "deg", "take": [0, 3]},
                     {"role": f"imu.{IMU}.linear_acceleration", "take": [3, 6]},
                     {"role": f"imu.{IMU}.angular_velocity", "unit": "deg/s", "take": [6, 9]}],
        **{f"{foot}_foot": f"wrench.{foot}" for foot in FEET},
    }  # fmt: skip
    return folder / "dump", {"joints": joints(log), "ports": roles}


def write_mat(log: MotionLog, folder: Path) -> Written:
    """A robot logger's file: MATLAB's (k, 1, n) stored as HDF5's (n, 1, k), names as references to char arrays."""
    import h5py

    rpy = Rotation.from_quat(vector(log, f"imu.{IMU}.orientation", "xyzw")).as_euler("xyz")
    signals = {
        "joints_state/positions": (positions(log), joints(log)),
        "joints_state/velocities": (velocities(log), moving(log)),
        f"orientations/{IMU}": (rpy, None), f"gyros/{IMU}": (vector(log, f"imu.{IMU}.angular_velocity"), None),
        f"accelerometers/{IMU}": (vector(log, f"imu.{IMU}.linear_acceleration"), None),
        **{
            f"FTs/{foot}": (np.hstack([vector(log, f"wrench.{foot}.{k}") for k in ("force", "torque")]), None)
            for foot in FEET
        },
    }  # fmt: skip
    with h5py.File(folder / "robot_logger_device.mat", "w", userblock_size=512) as file:
        for name, (values, names) in signals.items():
            group = file.create_group(f"robot_logger_device/{name}")
            group["data"] = values[:, None, :]
            group["timestamps"] = log.time[:, None]
            if names is not None:
                cells = []
                for number, text in enumerate(names):
                    codes = np.frombuffer(text.encode("utf-16-le"), np.uint16)[:, None]
                    cells.append(
                        file.create_dataset(f"#refs#/{name.replace('/', '_')}_{number}", data=codes).ref
                    )
                group.create_dataset("elements_names", data=np.array(cells, dtype=h5py.ref_dtype)[None, :])
    return folder / "robot_logger_device.mat", {}


WRITERS: dict[str, Callable[[MotionLog, Path], Written]] = {
    "csv": write_csv,
    "parquet": write_parquet,
    "npz": write_npz,
    "mapped_csv": write_mapped_csv,
    "mapped_npz": write_mapped_npz,
    "astate": write_astate,
    "mcap": write_mcap,
    "mcap_plain": lambda log, folder: write_ros2(log, folder, "MCAP"),
    "sqlite3": write_sqlite,
    "ros1": write_ros1,
    "ros1_bz2": lambda log, folder: write_ros1(log, folder, "BZ2"),
    "ros1_lz4": lambda log, folder: write_ros1(log, folder, "LZ4"),
    "mc_rtc": write_mc_rtc,
    "mc_rtc_1": lambda log, folder: write_mc_rtc(log, folder, 1),
    "hrpsys": write_hrpsys,
    "yarp": write_yarp,
    "robot_logger": write_mat,
}
