"""Formats with one file or key a port: each port's vectors to columns, all ports on one time base."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers.column_map import Port, joint_order
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.roles import role_columns
from plantar.logs.readers.streams import Stream, merge, origin
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel


def joints_for(count: int, robot: RobotModel | None, path: Path, notes: list[Note]) -> Sequence[str]:
    """Names of a joint vector's entries: `columns.joints`, or the URDF's order where the number agrees."""
    named = joint_order(robot)
    if named is not None:
        return named
    if robot is not None and count == len(robot.joint_names):
        text = "joints without names; the URDF's order is taken (set columns.joints in the robot file)"
        notes.append(Note("joint_order", "warning", f"{path.name}: {text}"))
        return robot.joint_names
    valid = "columns.joints in the robot file, in the log's order"
    raise LogError(f"does not name its {count} joints", path=path, valid=valid)


def port_columns(
    port: Port, values: Array, robot: RobotModel | None, path: Path, notes: list[Note]
) -> dict[str, Array]:
    """One port's vector (n, k) as columns by its role."""
    if port.take is not None:
        values = values[:, port.take[0] : port.take[1]]
    joints: Sequence[str] = port.joints or ()
    if port.role.startswith("joints.") and not joints:
        joints = joints_for(values.shape[1], robot, path, notes)
    return role_columns(port.role, values, joints, path, unit=port.unit, sign=port.sign)


def log_of_ports(
    name: str,
    limit: ReadLimit,
    digest: str | None,
    data: Mapping[str, tuple[Array, Array]],
    roles: Mapping[str, Sequence[Port]],
    robot: RobotModel | None,
    notes: list[Note],
) -> MotionLog:
    """A log from ports (time, values (n, k)) and their roles, stamps of an epoch less whole seconds.

    LogError when no port has a role.
    """
    path = limit.path
    start = origin(min((float(np.nanmin(time)) for time, _ in data.values() if time.size), default=0.0))
    streams = []
    for port, (time, values) in data.items():
        columns: dict[str, Array] = {}
        for part in roles.get(port, ()):
            columns |= port_columns(part, values, robot, path, notes)
        if columns:
            streams.append(Stream(port, time - start, columns))
    if not streams:
        found = ", ".join(list(data)[:8])
        raise LogError(
            f"no port has a known role (found: {found})", path=path, valid="columns.ports in the robot file"
        )
    time, merged = merge(streams, limit, notes)
    return MotionLog(name, time, merged, path, digest, tuple(notes))
