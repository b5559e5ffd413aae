"""`columns:` of the robot file: which of a log's own columns is which of plantar's, in which unit and order.

    columns:
      time: {from: stamp, unit: ms}
      joint.hip.position: {from: hip_angle, unit: deg}
      joint.<joint>.velocity: {from: <joint>_speed, unit: deg/s}       # every column of such a name, one a joint
      imu.chest.orientation: {from: [qx, qy, qz, qw], order: xyzw}     # or [roll, pitch, yaw], order: rpy
      imu.chest.linear_acceleration: {from: [ax, ay, az], unit: g}
      wrench.left.torque: {from: [mx, my, mz], unit: N.mm, sign: -1}
      wrench.right.cells: {from: [rf1, rf2, rf3], at: [[0.09, 0], [-0.07, 0.05], [-0.07, -0.05]]}     # force cells
      joints: [hip, knee, ankle]                 # order of the joint vectors, where a format has no names
      ports: {q: joints.position, lfsensor: wrench.left}               # file, port or key -> role

A source is a column's name, or its number from 0 where the file has no header.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from plantar.choices import nearest
from plantar.conventions import Array
from plantar.errors import LogError
from plantar.logs.motion_log import COLUMN
from plantar.logs.readers.force_cells import wrench_of_cells
from plantar.logs.readers.roles import ORDERS, QUANTITIES, factor, quaternion_from_rpy

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

VECTORS = {"angular_velocity": 3, "linear_acceleration": 3, "force": 3, "torque": 3}
ENTRY_KEYS = {"from", "unit", "order", "sign", "at"}
PORT_KEYS = {"role", "unit", "sign", "joints", "take"}
ANY_JOINT = "<joint>"  # in a key and in its source: every joint that the file has such a column of


@dataclass(frozen=True)
class Port:
    """What a file, port or key of a log holds: role, unit, sign, joints in order, which of its values."""

    role: str
    unit: str | None = None
    sign: float = 1.0
    joints: Sequence[str] | None = None
    take: tuple[int, int] | None = None


def maps_columns(robot: RobotModel | None) -> bool:
    """Whether the robot file renames a table's columns."""
    return robot is not None and any(key not in ("joints", "ports") for key in robot.columns)


def joint_order(robot: RobotModel | None) -> tuple[str, ...] | None:
    """`columns.joints`, or None. LogError when it is not a list of names."""
    names = None if robot is None else robot.columns.get("joints")
    if robot is None or names is None:
        return None
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise LogError("columns.joints is not a list of joint names", path=robot.path)
    return _once(names, "columns.joints", robot.path)


def _once(names: Sequence[str], where: str, path: Path) -> tuple[str, ...]:
    """A joint that is named twice would be read from the second place, and the one meant there from none."""
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise LogError(f"{where} names a joint twice", path=path, value=twice, valid="each joint once")
    return tuple(names)


def ports(robot: RobotModel | None) -> dict[str, tuple[Port, ...]]:
    """`columns.ports`, by file, port or key: one role or several. LogError when an entry is not a role."""
    entries = None if robot is None else robot.columns.get("ports")
    if robot is None or entries is None:
        return {}
    if not isinstance(entries, Mapping):
        raise LogError("columns.ports is not a mapping", path=robot.path, valid="port: role")
    return {
        str(name): tuple(
            _port(part, f"columns.ports.{name}", robot.path)
            for part in (entry if isinstance(entry, list) else [entry])
        )
        for name, entry in entries.items()
    }


def _port(entry: object, where: str, path: Path) -> Port:
    made = {"role": entry} if isinstance(entry, str) else entry
    if not isinstance(made, Mapping) or not isinstance(made.get("role"), str) or set(made) - PORT_KEYS:
        raise LogError(
            f"{where} is not a role", path=path, valid="a role, or {role, unit, sign, joints, take}"
        )
    joints, take = made.get("joints"), made.get("take")
    listed = isinstance(joints, list) and all(isinstance(name, str) for name in joints)
    if joints is not None and not listed:
        raise LogError(f"{where}.joints is not a list of names", path=path)
    if take is not None and not (
        isinstance(take, list) and len(take) == 2 and all(isinstance(i, int) and i >= 0 for i in take)
    ):
        raise LogError(f"{where}.take", path=path, value=str(take), valid="[first, after the last]")
    sign = _sign(made.get("sign", 1), where, path)
    slot = None if take is None else (int(take[0]), int(take[1]))
    named = None if joints is None else _once(joints, f"{where}.joints", path)
    return Port(made["role"], made.get("unit"), sign, named, slot)


def apply(table: Mapping[str, Array], robot: RobotModel, path: Path) -> tuple[Array, dict[str, Array]]:
    """Time (n,) and columns of a table whose own columns are `table`; what is not mapped keeps its name.

    Raises LogError: an entry names a column that is not there, an unknown unit, or a wrong number of sources.
    """
    time = np.asarray(table["time"]) if "time" in table else None
    columns = {name: values for name, values in table.items() if COLUMN.fullmatch(name)}
    entries = {key: entry for key, entry in robot.columns.items() if key not in ("joints", "ports")}
    for key, entry in _for_each_joint(entries, list(table), robot.path).items():
        made = entry if isinstance(entry, Mapping) else {"from": entry}
        if made.get("from") in (None, "", []) or set(made) - ENTRY_KEYS:
            valid = "a column, a list of columns, or {from, unit, order, sign, at}"
            message = f"columns.{key} is no source"
            raise LogError(message, path=robot.path, value=str(entry)[:60], valid=valid)
        sources = made["from"] if isinstance(made["from"], list) else [made["from"]]
        values = np.column_stack([_source(table, source, key, path) for source in sources])
        unit, sign = made.get("unit"), _sign(made.get("sign", 1), f"columns.{key}", robot.path)
        if key.startswith("wrench.") and key.endswith(".cells"):
            newtons = values * sign * factor(unit, "force", f"columns.{key}", robot.path)
            columns |= wrench_of_cells(key.removesuffix(".cells"), newtons, made.get("at"), robot.path)
        elif key == "time":
            time = _one(values, key, path)[:, 0] * factor(unit, "time", "columns.time", robot.path)
        else:
            columns |= _mapped(key, values, unit, made.get("order"), sign, robot.path)
    if time is None:
        raise LogError(
            "is missing", path=path, column="time", valid="a column 'time', or columns.time in the robot file"
        )
    return time, columns


def _for_each_joint(entries: Mapping[str, Any], names: Sequence[str], path: Path) -> dict[str, Any]:
    """The entries, one with `<joint>` replaced by one for each joint that the file's names hold. A joint that has an
    entry of its own keeps it."""
    spread: dict[str, Any] = {}
    for key, entry in entries.items():
        if ANY_JOINT not in key:
            continue
        made = entry if isinstance(entry, Mapping) else {"from": entry}
        source = made.get("from")
        if not isinstance(source, str) or source.count(ANY_JOINT) != 1 or key.count(ANY_JOINT) != 1:
            valid = f"joint.{ANY_JOINT}.position: {{from: {ANY_JOINT}_angle, unit: deg}}"
            raise LogError(f"columns.{key} needs one {ANY_JOINT} here and there", path=path, valid=valid)
        before, after = source.strip().split(ANY_JOINT)
        found = [re.fullmatch(f"{re.escape(before)}(.+){re.escape(after)}", name) for name in names]
        joints = [match[1] for match in found if match]
        if not joints:
            message = f"columns.{key}: no column is called like '{source}'"
            raise LogError(message, path=path, valid=nearest(source, names))
        spread |= {
            key.replace(ANY_JOINT, joint): {**made, "from": before + joint + after} for joint in joints
        }
    return spread | {key: entry for key, entry in entries.items() if ANY_JOINT not in key}


def _mapped(
    key: str, values: Array, unit: str | None, order: str | None, sign: float, path: Path
) -> dict[str, Array]:
    stem, _, last = key.rpartition(".")
    if last == "orientation" and stem.startswith("imu."):
        if order == "rpy" and values.shape[1] == 3:
            scale = sign * factor(unit, "position", key, path)
            values, order = quaternion_from_rpy(scale * values), "wxyz"
        if values.shape[1] != 4 or (order or "wxyz") not in ORDERS:
            message = f"columns.{key} needs four sources and an order"
            raise LogError(message, path=path, value=order, valid="wxyz, xyzw, or three and rpy")
        return {f"{key}.{axis}": values[:, i] for i, axis in enumerate(order or "wxyz")}
    if last in VECTORS and stem.startswith(("imu.", "wrench.")):
        if values.shape[1] != 3:
            raise LogError(f"columns.{key} needs three sources", path=path, value=values.shape[1])
        scale = sign * factor(unit, QUANTITIES[last], f"columns.{key}", path)
        return {f"{key}.{axis}": scale * values[:, i] for i, axis in enumerate("xyz")}
    if not COLUMN.fullmatch(key):
        valid = "time, joint.<joint>.position, imu.<name>.angular_velocity, wrench.<name>.force, ..."
        raise LogError(f"columns.{key} is no column of plantar", path=path, valid=valid)
    quantity = QUANTITIES[last] if last in QUANTITIES else QUANTITIES[stem.rpartition(".")[2]]
    scale = sign * factor(unit, quantity, f"columns.{key}", path)
    return {key: scale * _one(values, key, path)[:, 0]}


def _one(values: Array, key: str, path: Path) -> Array:
    if values.shape[1] != 1:
        raise LogError(f"columns.{key} takes one source", path=path, value=values.shape[1])
    return values


def _source(table: Mapping[str, Array], source: Any, key: str, path: Path) -> Array:
    names: Sequence[str] = list(table)
    source = source.strip() if isinstance(source, str) else source
    if isinstance(source, int) and not isinstance(source, bool):
        if not 0 <= source < len(names):
            raise LogError(f"columns.{key}: no column {source}", path=path, valid=f"0 to {len(names) - 1}")
        return table[names[source]]
    if not isinstance(source, str) or source not in table:
        message, valid = (
            f"is missing, or holds a text or nothing (columns.{key})",
            nearest(str(source), names),
        )
        raise LogError(message, path=path, column=str(source), valid=f"numbers in one of {valid}")
    return table[source]


def _sign(value: object, where: str, path: Path) -> float:
    if value not in (1, -1) or isinstance(value, bool):
        raise LogError(f"{where}: sign", path=path, value=str(value), valid="1 or -1")
    return 1.0 if value == 1 else -1.0
