"""What a bag's topics hold, gathered batch by batch, and which of them a robot's sensors are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.logs.readers.ros.layouts import (
    IMU,
    JOINT_STATE,
    WRENCH,
    BrokenMessage,
    Bytes,
    Encoding,
    Layout,
    layout_of,
    rows_of,
)
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

LAYOUT_LIMIT = 200  # layouts of one topic: frames and joint lists change rarely
GENERIC = {
    "",
    "imu",
    "data",
    "data_raw",
    "wrench",
    "ft",
    "ft_sensor",
    "force_torque",
    "force_torque_sensor",
    "raw",
}
Stamps = NDArray[np.int64]


@dataclass
class Series:
    """One kind of message of one topic with the same joint names: chunks of stamps and numbers."""

    names: tuple[str, ...]
    header: list[Stamps] = field(default_factory=list)
    received: list[Stamps] = field(default_factory=list)
    values: dict[str, list[Array]] = field(default_factory=dict)

    def column(self, name: str, index: int) -> Array:
        """One number over time, (n,); NaN where a message did not hold it."""
        parts = [chunk[:, index] for chunk in self.values[name]]
        return np.concatenate(parts)


@dataclass
class Topic:
    """One topic of a bag: its type, encoding, frame, and what was decoded so far."""

    name: str
    kind: str
    encoding: Encoding
    frames: list[str] = field(default_factory=list)
    layouts: list[Layout] = field(default_factory=list)
    series: dict[tuple[str, ...], Series] = field(default_factory=dict)
    count: int = 0
    broken: int = 0

    def add(self, buffer: Bytes, starts: list[int], ends: list[int], received: list[int]) -> None:
        """Decode the messages that lie in `buffer` from `starts` to `ends`."""
        self.count += len(starts)
        first, sizes = np.array(starts, np.int64), np.array(ends, np.int64) - np.array(starts, np.int64)
        clock = np.array(received, np.uint64).astype(np.int64)
        for size in np.unique(sizes):
            rows = np.flatnonzero(sizes == size)
            if size < 8:
                self.broken += rows.size
                continue
            self._decode(rows_of(buffer, first[rows], int(size)), clock[rows])

    def _decode(self, rows: Bytes, clock: Stamps) -> None:
        left = np.arange(len(rows))
        for layout in [known for known in self.layouts if known.size == rows.shape[1]]:
            left = self._take(layout, rows, clock, left)
        while left.size:
            try:
                layout = layout_of(self.kind, self.encoding, rows[left[0]].tobytes())
            except BrokenMessage:
                self.broken += 1
                left = left[1:]
                continue
            if len(self.layouts) >= LAYOUT_LIMIT:
                self.broken += left.size
                return
            self.layouts.append(layout)
            if layout.frame not in self.frames:
                self.frames.append(layout.frame)
            left = self._take(layout, rows, clock, left)

    def _take(self, layout: Layout, rows: Bytes, clock: Stamps, left: NDArray[np.intp]) -> NDArray[np.intp]:
        if left.size == 0:
            return left
        candidates = rows if left.size == len(rows) else rows[left]
        mine = layout.matches(candidates)
        if not mine.any():
            return left
        taken = candidates if mine.all() else candidates[mine]
        series = self.series.setdefault(layout.names, Series(layout.names))
        series.header.append(layout.stamps(taken))
        series.received.append(clock[left[mine]])
        expected = len(layout.names)
        present = {
            entry[0]: entry for entry in layout.fields if self.kind != JOINT_STATE or entry[2] == expected
        }
        done = sum(len(chunk) for chunk in series.header) - len(taken)
        for name, entry in present.items():
            if name not in series.values:
                series.values[name] = [np.full((done, entry[2]), np.nan)] if done else []
            series.values[name].append(layout.values(taken, entry))
        for name, chunks in series.values.items():
            if name not in present:
                chunks.append(np.full((len(taken), chunks[0].shape[1]), np.nan))
        return left[~mine]


def assign(
    topics: Iterable[Topic], robot: RobotModel | None, path: Path, notes: list[Note]
) -> dict[str, list[Topic]]:
    """Which topic is which sensor: keys `joints`, and `imu.<name>`, `wrench.<name>`.

    The robot file's `topics:` (joints, or a sensor's name, to a topic) goes first; then a topic called like
    the sensor, the frame of its link, its name in a topic's. Without a robot topics keep their own names.
    Raises LogError when `topics:` names one that the bag has not.
    """
    known = {topic.name: topic for topic in topics}
    wanted = {} if robot is None else dict(robot.topics)
    for name in wanted.values():
        if name not in known:
            raise LogError(
                f"has no topic '{name}' (topics in the robot file)",
                path=path,
                valid=", ".join(sorted(known)[:8]),
            )
    joints = [t for t in known.values() if t.kind == JOINT_STATE]
    if "joints" in wanted:
        joints = [known[wanted["joints"]]]
    chosen: dict[str, list[Topic]] = (
        {"joints": sorted(joints, key=lambda t: _joint_rank(t, robot))} if joints else {}
    )
    for kind, prefix, sensors in ((IMU, "imu", _imus(robot)), (WRENCH, "wrench", _wrenches(robot))):
        free = [topic for topic in known.values() if topic.kind == kind]
        for sensor, link in sensors.items():
            topic = (
                known[wanted[sensor]]
                if sensor in wanted
                else _guess(sensor, link, free, only=len(sensors) == 1)
            )
            if topic is None and free:
                names = ", ".join(other.name for other in free[:6])
                message = f"which topic is the {prefix} '{sensor}'?"
                raise LogError(message, path=path, valid=f"topics in the robot file, one of {names}")
            if topic is None:
                continue
            if sensor not in wanted:
                text = f"{prefix} '{sensor}' is taken from {topic.name}"
                notes.append(Note("topic_guessed", "info", f"{path.name}: {text}"))
            chosen[f"{prefix}.{sensor}"] = [topic]
            free = [other for other in free if other is not topic]
        if robot is None:
            for topic in free:
                chosen.setdefault(f"{prefix}.{_own_name(topic, prefix)}", []).append(topic)
        elif free:
            text = f"topics of no sensor in the robot file, not used: {', '.join(topic.name for topic in free[:8])}"
            notes.append(Note("topics_ignored", "info", f"{path.name}: {text}"))
    return chosen


def _joint_rank(topic: Topic, robot: RobotModel | None) -> tuple[int, int, str]:
    """Best first: the topic with most of the robot's joints, then one that is called joint_states."""
    names = {name for series in topic.series.values() for name in series.names}
    held = len(names & set(robot.joint_names)) if robot is not None else len(names)
    return -held, not topic.name.endswith("joint_states"), topic.name


def _imus(robot: RobotModel | None) -> Mapping[str, str]:
    return {} if robot is None or robot.imu is None else {robot.imu.name: robot.imu.placement.link}


def _wrenches(robot: RobotModel | None) -> Mapping[str, str]:
    return {} if robot is None else {f.wrench.name: f.wrench.placement.link for f in robot.feet.values()}


def _guess(sensor: str, link: str, free: list[Topic], *, only: bool) -> Topic | None:
    rules: tuple[Callable[[Topic], bool], ...] = (
        lambda topic: _own_name(topic, "imu" if topic.kind == IMU else "wrench") == sensor,
        lambda topic: link in topic.frames,
        lambda topic: sensor.lower() in topic.name.lower(),
        lambda topic: any(sensor.lower() in frame.lower() for frame in topic.frames),
    )
    for rule in rules:
        found = [topic for topic in free if rule(topic)]
        if len(found) == 1:
            return found[0]
    return free[0] if only and len(free) == 1 else None


def _own_name(topic: Topic, prefix: str) -> str:
    """A sensor's name from its topic: `/imu/chest` is chest, `/left_foot/wrench` is left_foot."""
    parts = [part for part in topic.name.split("/") if part.lower() not in GENERIC]
    return "_".join(parts) or (topic.frames[0] if topic.frames and topic.frames[0] else prefix)
