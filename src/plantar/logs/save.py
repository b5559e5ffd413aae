"""A recording out: CSV, Parquet, or a ROS 2 bag in MCAP that this package and ROS read back."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pa_parquet

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.files import atomic_write
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers.ros.layouts import IMU, JOINT_STATE, WRENCH, Bytes, layout_of
from plantar.logs.readers.ros.topics import Stamps
from plantar.logs.save_ros import write_mcap
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.robot.model import Placement, RobotModel

ENDINGS = (".csv", ".parquet", ".mcap")
QUANTITIES = ("position", "velocity", "effort")


def save_log(log: MotionLog, path: Path, robot: RobotModel | None = None) -> tuple[Note, ...]:
    """Write a recording in the format of the path's ending; returns notes on what the format cannot hold.

    `robot` gives a bag's messages the frames of its links; without it they carry the sensors' names.

    Raises LogError: another ending. MissingExtra: MCAP without rosbags.
    """
    ending = path.suffix.lower()
    if ending == ".mcap":
        return _save_mcap(log, path, frames_of(robot))
    if ending not in ENDINGS:
        raise LogError("has an unknown ending", path=path, valid=", ".join(ENDINGS))
    table = pa.table({"time": log.time, **log.columns})
    with atomic_write(path) as handle:
        if ending == ".csv":
            pa_csv.write_csv(table, handle)
        else:
            pa_parquet.write_table(table, handle)
    return ()


def frames_of(robot: RobotModel | None) -> dict[str, str]:
    """Frames of sensors' messages: the link, where the sensor sits at its origin and in its axes."""
    placed: list[tuple[str, Placement]] = []
    if robot is not None:
        placed += [] if robot.imu is None else [(robot.imu.name, robot.imu.placement)]
        placed += [(foot.wrench.name, foot.wrench.placement) for foot in robot.feet.values()]
    return {name: place.link for name, place in placed if not (place.xyz.any() or place.rpy.any())}


def _save_mcap(log: MotionLog, path: Path, frames: Mapping[str, str]) -> tuple[Note, ...]:
    stamps = np.rint(log.time * 1e9).astype(np.int64)
    outside = (stamps < 0) | (stamps >= 2**31 * 10**9)
    if outside.any():
        first = float(log.time[outside][0])
        raise LogError("lies outside what a ROS stamp can hold", path=log.source, time=first)
    made = _messages(log, stamps, frames)
    topics = [(topic, kind.replace("/", "/msg/"), rows) for topic, kind, rows in made]
    write_mcap(path, topics, stamps.tolist())
    lost = sum(name.startswith("joint.") and name.endswith(".acceleration") for name in log.columns)
    if not lost:
        return ()
    return (Note("columns_lost", "warning", f"JointState holds no accelerations: {lost} columns left out"),)


def _messages(log: MotionLog, stamps: Stamps, frames: Mapping[str, str]) -> Iterable[tuple[str, str, Bytes]]:
    """Topic, type and serialised messages (N, size) of every joint group, IMU and wrench of a log."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for joint in _names(log, "joint."):
        held = tuple(quantity for quantity in QUANTITIES if log.has(f"joint.{joint}.{quantity}"))
        if held:
            groups.setdefault(held, []).append(joint)
    for index, (held, joints) in enumerate(groups.items()):
        values = {quantity: log.stack(f"joint.{joint}.{quantity}" for joint in joints) for quantity in held}
        body = _sequence([_text(joint) for joint in joints])
        template = _Message("base").raw(body)
        for quantity in QUANTITIES:
            template.numbers(len(joints) if quantity in held else 0, counted=True)
        topic = "/joint_states" + (f"_{index + 1}" if index else "")
        yield topic, JOINT_STATE, _fill(JOINT_STATE, template, stamps, values)
    for imu in _names(log, "imu."):
        attitude = log.orientation(imu)
        values = {"orientation_covariance": np.zeros((len(log), 9))}
        values["orientation_covariance"][:, 0] = -1.0 if attitude is None else 0.0
        values["orientation"] = np.zeros((len(log), 4)) if attitude is None else attitude[:, [1, 2, 3, 0]]
        for quantity in ("angular_velocity", "linear_acceleration"):
            values[quantity] = _vector(log, f"imu.{imu}.{quantity}")
        template = _Message(frames.get(imu, imu))
        for size in (4, 9, 3, 9, 3, 9):
            template.numbers(size)
        yield f"/imu/{imu}", IMU, _fill(IMU, template, stamps, values)
    for sensor in _names(log, "wrench."):
        values = {quantity: _vector(log, f"wrench.{sensor}.{quantity}") for quantity in ("force", "torque")}
        template = _Message(frames.get(sensor, sensor)).numbers(3).numbers(3)
        yield f"/wrench/{sensor}", WRENCH, _fill(WRENCH, template, stamps, values)


def _names(log: MotionLog, prefix: str) -> list[str]:
    """Joints or sensors in the log's order."""
    words = 1 if prefix == "joint." else 2
    own = (name.removeprefix(prefix) for name in log.columns if name.startswith(prefix))
    return list(dict.fromkeys(name.rsplit(".", words)[0] for name in own))


def _vector(log: MotionLog, stem: str) -> Array:
    gap = np.full(len(log), np.nan)
    return np.column_stack([log.columns.get(f"{stem}.{axis}", gap) for axis in "xyz"])


class _Message:
    """One CDR message, little-endian, with zeros where numbers go."""

    def __init__(self, frame: str) -> None:
        self.data = b"\0\1\0\0" + struct.pack("<iI", 0, 0) + _text(frame)

    def raw(self, body: bytes) -> _Message:
        self._align(4)
        self.data += body
        return self

    def numbers(self, count: int, *, counted: bool = False) -> _Message:
        if counted:
            self._align(4)
            self.data += struct.pack("<I", count)
        if count:
            self._align(8)
            self.data += bytes(8 * count)
        return self

    def _align(self, size: int) -> None:
        self.data += bytes(-(len(self.data) - 4) % size)


def _text(text: str) -> bytes:
    raw = text.encode() + b"\0"
    return struct.pack("<I", len(raw)) + raw


def _sequence(texts: list[bytes]) -> bytes:
    body = struct.pack("<I", len(texts))
    for text in texts:
        body += bytes(-len(body) % 4) + text
    return body


def _fill(kind: str, template: _Message, stamps: Stamps, values: dict[str, Array]) -> Bytes:
    layout = layout_of(kind, "cdr", template.data)
    rows = np.tile(np.frombuffer(template.data, np.uint8), (len(stamps), 1))
    clock = np.column_stack([stamps // 1_000_000_000, stamps % 1_000_000_000]).astype("<u4")
    rows[:, layout.stamp : layout.stamp + 8] = np.ascontiguousarray(clock).view(np.uint8)
    for name, start, count in layout.fields:
        if name in values:
            rows[:, start : start + 8 * count] = np.ascontiguousarray(values[name], "<f8").view(np.uint8)
    return rows
