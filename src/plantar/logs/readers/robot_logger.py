"""MATLAB v7.3 files of the iCub and ergoCub robot logger: HDF5 with one group a signal.

`/robot_logger_device/joints_state/{positions,velocities,torques}` with `data`, `timestamps`,
`elements_names`; `FTs/<sensor>`, `accelerometers/<imu>`, `gyros/<imu>`, `orientations/<imu>` (roll, pitch,
yaw) (bipedal-locomotion-framework, YarpRobotLoggerDevice). Units are SI there; where a log's are not, name
the signal in `columns.ports` with its unit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from plantar.conventions import Array
from plantar.errors import LogError, needs
from plantar.files import sha256
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import motion_name
from plantar.logs.readers.column_map import Port, ports
from plantar.logs.readers.ports import log_of_ports
from plantar.logs.readers.read_limit import NUMBER, ReadLimit
from plantar.notes import Note, listing

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel

NAME_LIMIT = 1000  # characters of a name, and joints
OLDER = b"MATLAB 5.0"  # what files of -v6 and -v7 start with
TABLES = "a robot logger's file; a table of your own as CSV, by writetable, with `columns` in the robot file"
SIGNALS = {
    "joints_state/positions": "joints.position",
    "joints_state/velocities": "joints.velocity",
    "joints_state/accelerations": "joints.acceleration",
    "joints_state/torques": "joints.effort",
}
GROUPS = {
    "FTs": "wrench.{name}",
    "gyros": "imu.{name}.angular_velocity",
    "accelerometers": "imu.{name}.linear_acceleration",
    "orientations": "imu.{name}.orientation.rpy",
}


def read(path: Path, robot: RobotModel | None, limit: ReadLimit) -> MotionLog:
    """Read a logger's file. LogError: not HDF5, or no signal of use. MissingExtra: no h5py."""
    with needs("h5py", "logs", "reading .mat logs"):
        import h5py
    notes: list[Note] = []
    with path.open("rb") as start:
        if start.read(len(OLDER)) == OLDER:
            raise LogError("is a MATLAB file older than 7.3", path=path, valid=TABLES)
    try:
        with h5py.File(path, "r") as file:
            root = next(
                (g for name, g in file.items() if isinstance(g, h5py.Group) and "joints_state" in g), file
            )
            data, roles = _signals(root, ports(robot), limit)
            held = [str(name)[:NAME_LIMIT] for name in root]
    except (OSError, KeyError, RuntimeError, ValueError, TypeError, AttributeError, MemoryError) as error:
        reason = " ".join(str(error).split())[:120]
        raise LogError(f"is not a readable MATLAB 7.3 file: {reason}", path=path) from error
    if not data:
        raise LogError(f"holds no signal of a robot logger, but {listing(held)}", path=path, valid=TABLES)
    return log_of_ports(motion_name(path), limit, sha256(path), data, roles, robot, notes)


def _signals(
    root: Any, given: dict[str, tuple[Port, ...]], limit: ReadLimit
) -> tuple[dict[str, tuple[Array, Array]], dict[str, tuple[Port, ...]]]:
    wanted = {name: Port(role) for name, role in SIGNALS.items()}
    for group, role in GROUPS.items():
        for name in root.get(group, ()):
            wanted[f"{group}/{name}"] = Port(role.format(name=name))
    data, roles = {}, {}
    for name in dict.fromkeys((*wanted, *given)):
        if name not in root:
            continue
        group = root[name].get("measured", root[name])
        time, values = _signal(group, name, limit)
        joints = _names(root, group)
        mine = given.get(name) or (wanted[name],)
        data[name] = (time, values)
        unnamed = [port.role.startswith("joints.") and not port.joints for port in mine]
        roles[name] = tuple(
            replace(port, joints=joints) if lacks else port for port, lacks in zip(mine, unnamed, strict=True)
        )
    return data, roles


def _signal(group: Any, name: str, limit: ReadLimit) -> tuple[Array, Array]:
    """Stamps (n,) and values (n, k) of a signal; MATLAB's (k, 1, n) comes out of HDF5 as (n, 1, k)."""
    parts = []
    for key in ("timestamps", "data"):
        source = group[key]
        if source.dtype.kind not in "fiu":
            raise LogError(f"{name}/{key} is no array of numbers", path=limit.path)
        # HDF5 unpacks whole chunks, which may be larger than what is in use of them.
        limit.unpack(NUMBER * max(source.size, math.prod(source.chunks or ())))
        limit.hold(NUMBER * source.size)
        parts.append(np.asarray(source[()], dtype=np.float64))
    time = parts[0].ravel()
    values = parts[1].reshape(parts[1].shape[0], -1)
    if values.shape[0] != time.size and values.shape[-1] == time.size:
        values = values.T
    if values.shape[0] != time.size:
        raise LogError(f"{name} has {values.shape[0]} samples and {time.size} stamps", path=limit.path)
    return time, values


def _names(root: Any, group: Any) -> Sequence[str] | None:
    """A signal's element names, else the file's list of joints; None where neither is there."""
    for holder, key in ((group, "elements_names"), (root, "description_list")):
        if key in holder:
            cells = holder[key]
            if cells.size > NAME_LIMIT or math.prod(cells.chunks or ()) > NAME_LIMIT:
                raise ValueError(f"{key} holds more than {NAME_LIMIT} names")
            return tuple(_text(holder.file[cell]) for cell in np.asarray(cells[()]).ravel())
    return None


def _text(source: Any) -> str:
    """A MATLAB char array: 16-bit codes."""
    if source.size > NAME_LIMIT or math.prod(source.chunks or ()) > NAME_LIMIT:
        raise ValueError("a name is too long")
    return "".join(chr(int(code)) for code in np.asarray(source[()]).ravel())
