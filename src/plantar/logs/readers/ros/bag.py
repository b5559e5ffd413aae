"""ROS 2 bags (MCAP, sqlite3, a directory) and ROS 1 bags: JointState, Imu and WrenchStamped by topic."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.files import sha256
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import motion_name
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.ros.joint_topics import Messages, joint_columns
from plantar.logs.readers.ros.layouts import JOINT_STATE
from plantar.logs.readers.ros.mcap_file import read_mcap
from plantar.logs.readers.ros.ros1_file import read_ros1
from plantar.logs.readers.ros.sensor_topics import assign
from plantar.logs.readers.ros.sqlite_bag import read_sqlite
from plantar.logs.readers.ros.topics import Series, Stamps, Topic
from plantar.logs.readers.streams import Stream, merge
from plantar.notes import Note, listing

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

FILES = (".mcap", ".db3", ".bag", ".active")  # .bag.active: a ROS 1 bag that was never closed
METADATA = "metadata.yaml"  # that ROS 2 writes beside the parts of one bag
CLOCKS_APART = 0.1  # s: messages within a robot are received sooner
NO_ORIENTATION = -1.0
"""`orientation_covariance[0]` of an IMU that has none."""


def read(path: Path, robot: RobotModel | None, limit: ReadLimit) -> MotionLog:
    """Read a bag; `robot` says which topics its sensors are. LogError: broken, or nothing of use in it."""
    notes: list[Note] = []
    topics = _topics(path, limit, notes)
    _check(topics, path, notes)
    columns_by_topic = assign(topics.values(), robot, path, notes)
    streams = _streams(columns_by_topic, path, notes)
    time, columns = merge(streams, limit, notes)
    del streams, columns_by_topic
    for column in (time, *columns.values()):
        column.setflags(write=False)  # handed over, not copied
    return MotionLog(motion_name(path), time, columns, path, sha256(bag_files(path)[0]), tuple(notes))


def bag_topics(path: Path) -> dict[str, list[Topic]]:
    """What a bag's topics are taken for: keys `joints`, `imu.<name>`, `wrench.<name>`. LogError: broken."""
    notes: list[Note] = []
    return assign(_topics(path, ReadLimit(path), notes).values(), None, path, notes)


def _topics(path: Path, limit: ReadLimit, notes: list[Note]) -> dict[str, Topic]:
    topics: dict[str, Topic] = {}
    files = bag_files(path)
    if len(files) > 1 and not (path / METADATA).exists():
        names = listing([file.name for file in files])
        text = f"{path.name}: a folder without {METADATA}; its {len(files)} files are read as one recording: {names}"
        notes.append(Note("bags_joined", "warning", f"{text} (valid: one by one, if each is its own)"))
    for file in files:
        reader = {".mcap": read_mcap, ".db3": read_sqlite}.get(file.suffix.lower(), read_ros1)
        reader(file, topics, limit, notes)
    return topics


def bag_files(path: Path) -> list[Path]:
    """The files of a bag: itself, or the parts in a ROS 2 bag's directory in their order."""
    if not path.is_dir():
        return [path]
    parts = sorted(part for part in path.iterdir() if part.suffix.lower() in FILES)
    if not parts:
        raise LogError("is a directory without bag files", path=path, valid=", ".join(FILES))
    return sorted(parts, key=lambda part: (len(part.name), part.name))


def _check(topics: dict[str, Topic], path: Path, notes: list[Note]) -> None:
    if not any(topic.series for topic in topics.values()):
        valid = "sensor_msgs/JointState, sensor_msgs/Imu, geometry_msgs/WrenchStamped"
        raise LogError("holds no message that plantar reads", path=path, valid=valid)
    for topic in topics.values():
        if topic.broken:
            text = f"{topic.broken} of {topic.count} messages cannot be decoded and are left out"
            notes.append(Note("messages_broken", "warning", f"{path.name}: {topic.name}: {text}"))


def _streams(chosen: dict[str, list[Topic]], path: Path, notes: list[Note]) -> list[Stream]:
    """Every sensor's columns on its own clock, the clocks on one origin."""
    sources = [
        (topic, series) for topics in chosen.values() for topic in topics for series in topic.series.values()
    ]
    headers = [series.clock(received=False) for _, series in sources]
    reason = _unusable(headers, [topic.name for topic, _ in sources])
    if received := reason is not None:
        text = f"{path.name}: {reason}; times of receipt are used instead"
        notes.append(Note("receive_time", "warning", text))
    elif (apart := _clocks_apart(sources)) is not None:
        notes.append(Note("clocks_apart", "warning", f"{path.name}: {apart}"))
    first = min(int(series.clock(received).min()) for _, series in sources)
    zero = first // 1_000_000_000 * 1_000_000_000 if first > 10**15 else 0
    if zero:
        text = f"{path.name}: time counts from {zero // 1_000_000_000} s of the bag's clock"
        notes.append(Note("time_origin", "info", text))
    streams = []
    seen: set[str] = set()
    owners: dict[str, str] = {}
    for key, topics in chosen.items():
        for topic in topics:
            for messages, columns in (
                joint_columns(topic, owners, notes, path)
                if topic.kind == JOINT_STATE
                else _sensor(key, topic, seen)
            ):
                time = (messages.clock(received) - zero).astype(np.float64) * 1e-9
                streams.append(Stream(topic.name, time, columns))
            topic.series.clear()
    return streams


def _unusable(headers: list[Stamps], names: list[str]) -> str | None:
    """Why the header stamps cannot be used: not set, or clocks that never meet."""
    for stamps, name in zip(headers, names, strict=True):
        if stamps.size > 1 and np.count_nonzero(stamps == stamps[0]) > stamps.size // 2:
            return f"{name} has no header stamps"
    latest_start, first_end = max(int(s.min()) for s in headers), min(int(s.max()) for s in headers)
    if latest_start > first_end:
        late = names[int(np.argmax([int(s.min()) for s in headers]))]
        return f"the header stamps of {late} do not overlap the others'"
    return None


def _clocks_apart(sources: list[tuple[Topic, Series]]) -> str | None:
    """What to say of header stamps of which some are much older when they are received than others."""
    age = {
        topic.name: 1e-9 * float(np.median(series.clock(received=True) - series.clock(received=False)))
        for topic, series in sources
    }
    old, new = max(age, key=age.__getitem__), min(age, key=age.__getitem__)
    if age[old] - age[new] < CLOCKS_APART:
        return None
    return (
        f"the header stamps of {old} are {age[old] - age[new]:.3g} s older at their receipt than those of {new}: "
        "clocks that differ make the sensors late by as much (valid: all computers on one clock)"
    )


def _sensor(key: str, topic: Topic, seen: set[str]) -> Iterator[tuple[Messages, dict[str, Array]]]:
    """A sensor's columns; what an earlier topic gave is not taken again."""
    for series in topic.series.values():
        columns = {}
        for name, axes in (("orientation", "xyzw"), ("angular_velocity", "xyz"), ("linear_acceleration", "xyz"),
                           ("force", "xyz"), ("torque", "xyz")):  # fmt: skip
            if name not in series.values or (name == "orientation" and _without_orientation(series)):
                continue
            for index, axis in enumerate(axes):
                if (column := f"{key}.{name}.{axis}") not in seen:
                    columns[column] = series.column(name, index)
        seen |= set(columns)
        if columns:
            yield Messages((series,)), columns


def _without_orientation(series: Series) -> bool:
    covariances = series.values["orientation_covariance"]
    unknown = np.mean([np.mean(chunk[:, 0] == NO_ORIENTATION) for chunk in covariances])
    empty = all(not chunk.any() for chunk in series.values["orientation"])
    return bool(unknown > 0.5 or empty)
