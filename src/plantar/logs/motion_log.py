"""One recording in memory: immutable, labelled, on one time base."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Array, Mask
from plantar.errors import LogError
from plantar.notes import NAMED, Note, listing

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

COLUMN = re.compile(
    r"joint\..+\.(position|velocity|acceleration|effort)"
    r"|imu\..+\.(orientation\.[wxyz]|(angular_velocity|linear_acceleration)\.[xyz])"
    r"|wrench\..+\.(force|torque)\.[xyz]"
)

IMU_AXES = {"orientation": "wxyz", "angular_velocity": "xyz", "linear_acceleration": "xyz"}
LARGEST = 1e12  # in any unit: what no sensor reads


def imu_columns(imu: str, *kinds: str) -> tuple[str, ...]:
    """Names of an IMU's columns; kinds: orientation, angular_velocity, linear_acceleration."""
    return tuple(f"imu.{imu}.{kind}.{axis}" for kind in kinds for axis in IMU_AXES[kind])


def wrench_columns(sensor: str) -> tuple[str, ...]:
    """Names of a force sensor's columns, forces then torques."""
    return tuple(f"wrench.{sensor}.{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz")


def device_of(column: str) -> str:
    """The IMU or force sensor that a column is of, with its kind: `wrench.left` of `wrench.left.force.x`; names may
    hold dots."""
    return column.rsplit(".", 2)[0]


@dataclass(frozen=True, repr=False)
class MotionLog:
    """One recording: a time base and labelled columns. Made by `open_log`, or from arrays.

    Args:
        name: what results call the motion.
        time: (N,) [s], increasing; evenly spaced or not.
        columns: (N,) each, in SI units, named as in `docs/log_columns.md`, such as `joint.<joint>.position` [rad]. They
            become read-only float64; NaN marks a value that was not recorded, and stands for infinite ones.
        path, sha256: the file that it was read from. notes: what was assumed while reading.
        left_out: spans of a longer recording (from, to) [s] whose rows are not here, since others tell more.

    Raises:
        LogError: a column holds no numbers, lengths differ, time does not increase, there are fewer than two samples.

    Example:
        >>> import numpy as np, plantar
        >>> time = np.arange(0.0, 2.0, 0.01)
        >>> log = plantar.MotionLog("still", time, {"joint.knee.position": np.zeros(200)})
        >>> log
        <MotionLog still: 2.0 s, 200 samples, 1 columns>
        >>> log.column("joint.knee.position").shape, f"{log.duration:.2f} s"
        ((200,), '1.99 s')
    """

    name: str
    time: Array
    columns: Mapping[str, Array] = field(repr=False)
    path: Path | None = None
    sha256: str | None = None
    notes: tuple[Note, ...] = ()
    left_out: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        time = self._numbers("time", self.time)
        columns = {name: self._numbers(name, values) for name, values in self.columns.items()}
        absurd = [name for name, values in columns.items() if (np.abs(values) > LARGEST).any()]
        for name in absurd:
            columns[name] = _frozen(np.where(np.abs(columns[name]) > LARGEST, np.nan, columns[name]))
        if absurd:
            text = (
                f"{self.name}: infinite or impossible values are treated as not recorded: {listing(absurd)}"
            )
            object.__setattr__(self, "notes", (*self.notes, Note("absurd_values", "warning", text)))
        for name, values in columns.items():
            if values.shape != time.shape:
                message = f"has {values.size} values where time has {time.size}"
                raise LogError(message, path=self.source, column=name)
        if time.size < 2:
            raise LogError("holds fewer than two samples", path=self.source, column="time")
        bad = np.flatnonzero(~(np.diff(time) > 0))
        if bad.size:
            at, value = time[bad[0]], time[bad[0] + 1]
            message = "does not increase"
            raise LogError(message, path=self.source, column="time", time=float(at), value=float(value))
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "columns", MappingProxyType(columns))

    def _numbers(self, name: str, values: Array) -> Array:
        try:
            return _frozen(values)
        except (TypeError, ValueError) as error:
            raise LogError(f"holds no numbers: {error}", path=self.source, column=name) from error

    @property
    def source(self) -> str:
        """What to call this log in a message: its file where it has one."""
        return str(self.path or self.name)

    def __len__(self) -> int:
        return int(self.time.size)

    def __repr__(self) -> str:
        sampled = f"{self.duration:.1f} s, {len(self)} samples, {len(self.columns)} columns"
        return f"<{type(self).__name__} {self.name}: {sampled}>"

    @property
    def size(self) -> int:
        """Bytes of its numbers."""
        return self.time.nbytes + sum(values.nbytes for values in self.columns.values())

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @cached_property
    def period(self) -> float:
        """The usual time between samples [s]: the median, which gaps do not move."""
        return float(np.median(np.diff(self.time)))

    def has(self, *names: str) -> bool:
        return all(name in self.columns for name in names)

    def has_imu(self, imu: str, *kinds: str) -> bool:
        """Whether all columns of an IMU of these `kinds` are there; kinds as in `imu_columns`."""
        return self.has(*imu_columns(imu, *kinds))

    def devices(self, kind: str) -> list[str]:
        """The sensors of a kind, "imu" or "wrench", that the log has columns of: `wrench.left`."""
        return list(dict.fromkeys(device_of(name) for name in self.columns if name.startswith(f"{kind}.")))

    def column(self, name: str) -> Array:
        """One column, (N,); LogError names it when it is missing, and the nearest that is there."""
        try:
            return self.columns[name]
        except KeyError:
            kind, near = name.partition(".")[0], difflib.get_close_matches(name, self.columns, n=2)
            valid = f"the log has {', '.join(near)}" if near else None
            if (
                kind in ("imu", "wrench")
                and (devices := self.devices(kind))
                and device_of(name) not in devices
            ):
                names = ", ".join(device.partition(".")[2] for device in devices)
                valid = f"in the robot file {kind}.name as the log has it: {names}"
                valid += "; and no foot without a force sensor" * (kind == "wrench")
            raise LogError("is missing", path=self.source, column=name, valid=valid) from None

    def stack(self, names: Iterable[str]) -> Array:
        """Several columns side by side, (N, k)."""
        return np.column_stack([self.column(name) for name in names])

    def wrench(self, sensor: str) -> Array:
        """Force then torque as recorded, in the sensor's frame, (N, 6) [N, N·m]."""
        return self.stack(wrench_columns(sensor))

    def vertical_only(self, sensor: str) -> bool:
        """Whether a force sensor is one of single-axis cells: no horizontal force and no moment about the vertical."""
        if not self.has(*wrench_columns(sensor)):
            return False
        wrench = self.wrench(sensor)
        return bool(not wrench[:, [0, 1, 5]].any() and wrench[:, 2].any())

    def orientation(self, imu: str) -> Array | None:
        """Quaternion w x y z, body to world, (N, 4); None where the log has no such columns."""
        names = imu_columns(imu, "orientation")
        return self.stack(names) if any(self.has(name) for name in names) else None

    def angular_velocity(self, imu: str) -> Array:
        """Gyroscope in the IMU's frame, (N, 3) [rad/s]."""
        return self.stack(imu_columns(imu, "angular_velocity"))

    def linear_acceleration(self, imu: str) -> Array:
        """Proper acceleration in the IMU's frame, (N, 3) [m/s²]: +9.81 along up at rest."""
        return self.stack(imu_columns(imu, "linear_acceleration"))

    def joint(self, joint: str, quantity: str) -> Array | None:
        """A joint's position, velocity, acceleration or effort, (N,), or None where not recorded."""
        return self.columns.get(f"joint.{joint}.{quantity}")

    def positions(self, robot: RobotModel) -> Array:
        """Joint positions in the robot's order, (N, n_joints); a joint that is not recorded stands at 0."""
        zero = np.zeros(len(self))
        columns = [self.columns.get(f"joint.{name}.position", zero) for name in robot.joint_names]
        return np.column_stack(columns) if columns else np.zeros((len(self), 0))

    def joint_notes(self, robot: RobotModel) -> tuple[Note, ...]:
        """What the log's joints and the URDF's do not have in common."""
        joints = (name for name in self.columns if name.startswith("joint."))
        recorded = {name.split(".", 1)[1].rsplit(".", 1)[0] for name in joints}
        with_position = {name for name in recorded if self.has(f"joint.{name}.position")}
        missing = [name for name in robot.joint_names if name not in with_position]
        unknown = sorted(recorded - set(robot.joint_names))
        return tuple(
            note
            for names, note in (
                (missing, Note("joint_missing", "info", f"{self.name}: not recorded, held at the neutral position: "
                               + _missing(robot, missing))),
                (unknown, Note("joint_unknown", "info", f"{self.name}: recorded, but not in the URDF, not used: "
                               + listing(unknown))),
            )
            if names
        )  # fmt: skip

    def without_empty_joints(self) -> MotionLog:
        """The same without positions of joints that never hold a value: these were not recorded, and would empty every
        row of what follows from all joints."""
        joints = (name for name in self.columns if name.startswith("joint."))
        positions = [name for name in joints if name.endswith(".position")]
        empty = [name for name in positions if np.isnan(self.columns[name]).all()]
        if not empty:
            return self
        text = f"{self.name}: never hold a value, taken as not recorded: {listing(empty, NAMED)}"
        return self.without(empty, Note("joint_empty", "info", text))

    def without(self, names: Iterable[str], *notes: Note) -> MotionLog:
        """The same recording without these columns, and with notes added."""
        left_out = set(names)
        columns = {name: values for name, values in self.columns.items() if name not in left_out}
        return replace(self, columns=columns, notes=self.notes + notes)

    def select(self, rows: slice | Mask) -> MotionLog:
        """The same recording with only some of its rows."""
        columns = {name: values[rows] for name, values in self.columns.items()}
        return replace(self, time=self.time[rows], columns=columns)

    def with_columns(self, columns: Mapping[str, Array], *notes: Note) -> MotionLog:
        """The same recording with columns added or replaced, and notes added."""
        other = replace(self, columns=columns, notes=self.notes + notes)  # checks those that are new
        object.__setattr__(other, "columns", MappingProxyType({**self.columns, **other.columns}))
        other.__dict__["period"] = self.period  # the time is the same
        return other


def _missing(robot: RobotModel, names: list[str]) -> str:
    """The names; in short where no foot's angles need them."""
    if robot.imu is None or not robot.feet:
        return listing(names)
    if robot.path_joints & set(names):
        return listing(names)
    return f"{listing(names, NAMED)}; none lies between IMU and feet"


def _frozen(values: Array) -> Array:
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array is values and array.flags.writeable:
        array = array.copy()
    array.setflags(write=False)
    return array
