"""JointState, Imu and WrenchStamped decoded by the batch: one look at the first message, NumPy for the rest.

A layout says where in a serialised message the stamp and the numbers lie and which bytes must not change;
every message with the same fixed bytes is then decoded by slicing, without a Python object per message.
CDR as in OMG DDS-XTypes 7.4 (numbers aligned to their size after the 4-byte encapsulation header), ROS 1 as
in wiki.ros.org/msg (packed, little-endian).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.logs.readers.read_limit import COLUMNS

Bytes = NDArray[np.uint8]
Encoding = Literal["cdr", "ros1"]

JOINT_STATE, IMU, WRENCH = "sensor_msgs/JointState", "sensor_msgs/Imu", "geometry_msgs/WrenchStamped"


class BrokenMessage(ValueError):
    """A message whose bytes do not hold what its type says."""


@dataclass(frozen=True)
class Layout:
    """Where things lie in a message: byte order, stamp, fields (name, offset, float64s), fixed bytes."""

    size: int
    order: str
    stamp: int
    frame: str
    names: tuple[str, ...]
    fields: tuple[tuple[str, int, int], ...]
    fixed: tuple[tuple[int, bytes], ...]

    def matches(self, rows: Bytes) -> NDArray[np.bool_]:
        """Which rows (n, size) have this layout's fixed bytes, (n,)."""
        same = np.ones(len(rows), dtype=bool)
        for start, content in self.fixed:
            wanted = np.frombuffer(content, np.uint8)
            same &= (rows[:, start : start + len(content)] == wanted).all(axis=1)
        return same

    def stamps(self, rows: Bytes) -> NDArray[np.int64]:
        """Header stamps (n,) [ns]."""
        parts = np.ascontiguousarray(rows[:, self.stamp : self.stamp + 8]).view(f"{self.order}u4")
        seconds = parts[:, 0].astype(np.uint32).view(np.int32).astype(np.int64)
        return seconds * 1_000_000_000 + parts[:, 1].astype(np.int64)

    def values(self, rows: Bytes, field: tuple[str, int, int]) -> Array:
        """One field's numbers, (n, count)."""
        _, start, count = field
        raw = np.ascontiguousarray(rows[:, start : start + 8 * count]).view(f"{self.order}f8")
        return raw.astype(np.float64, copy=False)


class _Cursor:
    """Walks through one message and remembers which bytes are structure."""

    def __init__(self, data: bytes, encoding: Encoding) -> None:
        self.data, self.at, self.origin, self.widest = data, 0, 0, 1
        self.order = "<"
        self.fixed: list[tuple[int, bytes]] = []
        if encoding == "cdr":
            kind = data[:2]
            if kind not in (b"\0\0", b"\0\1", b"\0\6", b"\0\7"):
                raise BrokenMessage("unknown CDR encapsulation")
            self.order = "<" if kind[1] & 1 else ">"
            self.widest = 8 if kind[1] < 2 else 4
            self.at = self.origin = 4
            self.fixed.append((0, kind))

    def _align(self, size: int) -> None:
        step = min(size, self.widest)
        self.at += -(self.at - self.origin) % step

    def skip(self, size: int) -> int:
        start = self.at
        self.at += size
        if self.at > len(self.data):
            raise BrokenMessage("ends before its last field")
        return start

    def count(self) -> int:
        """A length, which is structure."""
        self._align(4)
        start = self.skip(4)
        self.fixed.append((start, self.data[start : start + 4]))
        return int.from_bytes(self.data[start : start + 4], "little" if self.order == "<" else "big")

    def text(self, terminated: bool) -> str:
        size = self.count()
        start = self.skip(size)
        raw = self.data[start : start + size]
        self.fixed.append((start, raw))
        return raw[: -1 if terminated and raw.endswith(b"\0") else None].decode("utf-8", "replace")

    def stamp(self) -> int:
        self._align(4)
        return self.skip(8)

    def numbers(self, count: int) -> tuple[int, int]:
        if count:
            self._align(8)
        return self.skip(8 * count), count


def layout_of(kind: str, encoding: Encoding, data: bytes) -> Layout:
    """The layout of one message. BrokenMessage when its lengths lie."""
    cursor = _Cursor(data, encoding)
    ros1 = encoding == "ros1"
    if ros1:
        cursor.skip(4)  # the header's sequence number
    stamp = cursor.stamp()
    frame = cursor.text(not ros1)
    names: tuple[str, ...] = ()
    fields: list[tuple[str, int, int]] = []
    if kind == JOINT_STATE:
        count = cursor.count()
        if count > COLUMNS:
            raise BrokenMessage("names more joints than any robot has")
        names = tuple(cursor.text(not ros1) for _ in range(count))
        for field in ("position", "velocity", "effort"):
            fields.append((field, *cursor.numbers(cursor.count())))
    elif kind == IMU:
        for field, size in (("orientation", 4), ("orientation_covariance", 9), ("angular_velocity", 3),
                            ("", 9), ("linear_acceleration", 3), ("", 9)):  # fmt: skip
            fields.append((field, *cursor.numbers(size)))
    elif kind == WRENCH:
        fields += [(field, *cursor.numbers(3)) for field in ("force", "torque")]
    kept = tuple(field for field in fields if field[0] and field[2])
    return Layout(len(data), cursor.order, stamp, frame, names, kept, tuple(_joined(cursor.fixed)))


def _joined(parts: list[tuple[int, bytes]]) -> Iterator[tuple[int, bytes]]:
    """Neighbouring fixed bytes as one run, so that matching is a few wide comparisons."""
    start, content = 0, b""
    for at, raw in parts:
        if content and at == start + len(content):
            content += raw
            continue
        if content:
            yield start, content
        start, content = at, raw
    if content:
        yield start, content


def rows_of(buffer: Bytes, starts: NDArray[np.int64], size: int) -> Bytes:
    """Messages of one size that lie in a buffer, as rows (n, size)."""
    windows = np.lib.stride_tricks.sliding_window_view(buffer, size)
    return windows[starts]
