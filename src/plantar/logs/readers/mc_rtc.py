"""mc_rtc's binary logs: MessagePack entries behind their lengths, keys that may change in mid-file.

The file starts with ANNE (its last byte plus the version); each entry is a uint64 length and an array of two:
names of the keys where they changed (else nil), then type and value of every key (mc_rtc, mc_rtc/log and
internals/LogEntry.h). From version 1 on the first part lists events instead (0: key added with its type, 1:
key removed) and the second the values alone. A wrench (type 19) is couple first, then force; a body sensor's
orientation turns world into body, so it is conjugated here.
"""

from __future__ import annotations

import re
import struct
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from plantar.conventions import Array
from plantar.errors import LogError, needs
from plantar.files import sha256
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import motion_name
from plantar.logs.readers.column_map import Port, ports
from plantar.logs.readers.ports import port_columns
from plantar.logs.readers.read_limit import COLUMNS, NUMBER, ReadLimit
from plantar.logs.readers.streams import Stream, merge
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

MAGIC = b"ANN"
NEWEST = 10  # versions that may be tried
ENTRY_LIMIT = 4 * 2**20  # bytes of one entry: a sample of a humanoid takes some ten thousand
KEY_LIMIT = 100_000  # signals that may come and go in one file
BATCH = 512  # entries turned into arrays at a time, or fewer where they are long
FORCE_VECTOR = 19

JOINT_KEYS = {"qIn": "joints.position", "alphaIn": "joints.velocity", "tauIn": "joints.effort"}
IMU_KEYS = (
    (re.compile(r"(?:(.+)_)?rpyIn|(.+)_orientation"), "orientation.wxyz"),
    (re.compile(r"(?:(.+)_)?rateIn|(.+)_angularVelocity"), "angular_velocity"),
    (re.compile(r"(?:(.+)_)?accIn|(.+)_linearAcceleration"), "linear_acceleration"),
)


def read(path: Path, robot: RobotModel | None, limit: ReadLimit) -> MotionLog:
    """Read a log. LogError: another kind of file, no time, nothing of use. MissingExtra: no msgpack."""
    with needs("msgpack", "logs", "reading mc_rtc logs"):
        import msgpack  # noqa: F401
    notes: list[Note] = []
    entries = _Entries(path, robot, limit)
    with open(path, "rb") as handle:
        magic = handle.read(4)
        version = magic[3] - 0x45 if len(magic) == 4 and magic[:3] == MAGIC else -1
        if not 0 <= version <= NEWEST:
            raise LogError("is not an mc_rtc binary log", path=path, valid="a file that starts with ANNE")
        entries.read(handle, notes)
    values = entries.columns()
    if "t" not in values or not np.isfinite(values["t"]).any():
        raise LogError("holds no time key 't'", path=path)
    time = values.pop("t")[:, 0]
    columns: dict[str, Array] = {}
    for key, role in entries.roles.items():
        if key in values and values[key].shape[1]:
            data = values[key] * [1, -1, -1, -1] if role.role.endswith("orientation.wxyz") else values[key]
            columns |= port_columns(role, data, robot, path, notes)
    if not columns:
        raise LogError(
            "holds no joints, body sensors or force sensors", path=path, valid="qIn, rateIn, ...ForceSensor"
        )
    time, columns = merge([Stream("t", time, columns)], limit, notes)
    return MotionLog(motion_name(path), time, columns, path, sha256(path), tuple(notes))


class _Entries:
    """The entries of one file: current keys, and the numbers of those that have a role."""

    def __init__(self, path: Path, robot: RobotModel | None, limit: ReadLimit) -> None:
        self.path, self.robot, self.limit = path, robot, limit
        self.roles: dict[str, Port] = {}
        self._given = ports(robot)
        self._keys: list[str] = []
        self._types: dict[str, int] = {}
        self._wanted: list[tuple[int, str]] = []
        self._pending: list[dict[str, Any]] = []
        self._pending_size = 0
        self._chunks: list[dict[str, Array]] = []
        self._widths: dict[str, int] = {}

    def read(self, handle: IO[bytes], notes: list[Note]) -> None:
        import msgpack

        left = self.path.stat().st_size - 4
        broken, cut = 0, False
        while left >= 8:
            (size,) = struct.unpack("<Q", handle.read(8))
            left -= 8
            if size > left:
                cut = True
                break
            if size > ENTRY_LIMIT:
                raise LogError(f"an entry of {size} bytes", path=self.path, valid=f"at most {ENTRY_LIMIT}")
            left -= size
            self._pending_size += size
            content = handle.read(size)
            try:
                self._entry(
                    msgpack.unpackb(content, raw=False, strict_map_key=False, max_map_len=0, max_ext_len=0)
                )
            except (ValueError, TypeError, msgpack.UnpackException, RecursionError):
                broken += 1
        if cut or 0 < left < 8:
            notes.append(Note("file_cut", "warning", f"{self.path.name} is cut; its whole entries were read"))
        self._gather()
        if broken:
            text = f"{self.path.name}: {broken} entries cannot be decoded, left out"
            notes.append(Note("messages_broken", "warning", text))

    def _entry(self, entry: Any) -> None:
        if not isinstance(entry, list) or len(entry) != 2 or not isinstance(entry[1], list):
            raise ValueError("not an entry")
        changes, values = entry
        if changes:
            self._change(changes)
        if len(values) == 2 * len(self._keys):
            types, values = values[0::2], values[1::2]
            if changes:
                self._types = dict(zip(self._keys, types, strict=True))
                self._choose()
        if len(values) != len(self._keys):
            raise ValueError("values and keys do not agree")
        self._pending.append({key: values[index] for index, key in self._wanted})
        if len(self._pending) >= BATCH or self._pending_size > ENTRY_LIMIT:
            self._gather()

    def _change(self, changes: list[Any]) -> None:
        if all(isinstance(key, str) for key in changes):
            self._keys = list(changes)
        else:
            for event in changes:
                code = event[0] if isinstance(event, list) and event else None
                names = [part for part in event[1:] if isinstance(part, str)] if code in (0, 1) else []
                if code == 0 and names and names[-1] not in self._keys:
                    self._keys.append(names[-1])
                    self._types[names[-1]] = next((part for part in event[1:] if isinstance(part, int)), 0)
                elif code == 1 and names and names[0] in self._keys:
                    self._keys.remove(names[0])
        if len(self._keys) > KEY_LIMIT:
            raise ValueError("too many keys")
        self._choose()

    def _choose(self) -> None:
        """Which of the current keys have a role."""
        self._wanted = []
        for index, key in enumerate(self._keys):
            if key != "t" and key not in self.roles:
                role = self._given.get(key) or self._role(key)
                if not role:
                    continue
                self.roles[key] = role[0]
            self._wanted.append((index, key))

    def _role(self, key: str) -> tuple[Port, ...]:
        if key in JOINT_KEYS:
            return (Port(JOINT_KEYS[key]),)
        for pattern, quantity in IMU_KEYS:
            if found := pattern.fullmatch(key):
                own = self.robot.imu.name if self.robot is not None and self.robot.imu is not None else "imu"
                return (Port(f"imu.{found[1] or found[2] or own}.{quantity}"),)
        if self._types.get(key) == FORCE_VECTOR:
            sensors = [] if self.robot is None else [foot.wrench.name for foot in self.robot.feet.values()]
            if key in sensors or key.endswith("ForceSensor"):
                feet = {f"{sensor.lower()}footforcesensor": sensor for sensor in sensors}
                name = key if key in sensors else feet.get(key.lower(), key)
                return (Port(f"wrench.{name}.torque_first"),)
        return ()

    def _gather(self) -> None:
        """Pending entries to arrays; a value that is no vector of the usual length becomes NaN."""
        if not self._pending:
            return
        chunk: dict[str, Array] = {}
        keys = dict.fromkeys(key for entry in self._pending for key in entry)
        for key in keys:
            rows = [entry.get(key) for entry in self._pending]
            width = self._widths.setdefault(key, next((_width(row) for row in rows if _width(row)), 0)) or 0
            self.limit.hold(NUMBER * width * len(rows))
            gap = [np.nan] * width
            numbers = [_numbers(row, width) or gap for row in rows]
            chunk[key] = np.array(numbers, dtype=np.float64).reshape(len(rows), width)
        chunk["\0size"] = np.zeros((len(self._pending), 0))
        self._chunks.append(chunk)
        self._pending, self._pending_size = [], 0

    def columns(self) -> dict[str, Array]:
        """By key the values (n, k), NaN where the key was absent."""
        sizes = [len(chunk["\0size"]) for chunk in self._chunks]
        self.limit.columns(sum(self._widths.values()))
        self.limit.numbers(sum(sizes), sum(self._widths.values()))
        found = {}
        for key, width in self._widths.items():
            parts = [chunk.get(key, np.empty((0, 0))) for chunk in self._chunks]
            found[key] = np.concatenate([
                part if part.shape == (size, width) else np.full((size, width), np.nan)
                for part, size in zip(parts, sizes, strict=True)
            ])  # fmt: skip
        return found


def _width(value: Any) -> int:
    if isinstance(value, list):
        return len(value) if len(value) <= COLUMNS else 0
    return int(isinstance(value, int | float))


def _numbers(value: Any, width: int) -> list[float] | None:
    row = value if isinstance(value, list) else [value]
    fits = len(row) == width and all(isinstance(number, int | float) for number in row)
    return [float(number) for number in row] if fits else None
