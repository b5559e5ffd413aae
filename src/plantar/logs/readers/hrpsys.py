"""hrpsys DataLogger: one text file a port, `<base>.<port>`, each line a time and the port's numbers.

Numbers are written in fixed notation with six digits (hrpsys-base, rtc/DataLogger). All ports beside the file
given are read. Roles come from `columns.ports`, else from the usual ends of port names.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from plantar.conventions import Array
from plantar.errors import LogError
from plantar.files import sha256
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers.column_map import Port, ports
from plantar.logs.readers.ports import log_of_ports
from plantar.logs.readers.read_limit import COLUMNS, ReadLimit
from plantar.logs.readers.text_numbers import read_numbers
from plantar.notes import Note

if TYPE_CHECKING:
    from plantar.robot.model import RobotModel


# End of a port's name -> role; {imu} is the robot's IMU, {left} and {right} its force sensors.
USUAL: tuple[tuple[str, str], ...] = (
    (r"(^|_)q$", "joints.position"),
    (r"(^|_)dq$", "joints.velocity"),
    (r"(^|_)tau$", "joints.effort"),
    (r"(^|_)(gyrometer|gyro|rateGyro)$", "imu.{imu}.angular_velocity"),
    (r"(^|_)(gsensor|accel|acc)$", "imu.{imu}.linear_acceleration"),
    (r"(^|_)rpy$", "imu.{imu}.orientation.rpy"),
    (r"(^|_)lfsensor$", "wrench.{left}"),
    (r"(^|_)rfsensor$", "wrench.{right}"),
)


def read(path: Path, robot: RobotModel | None, limit: ReadLimit) -> MotionLog:
    """Read the ports of one recording. LogError: a broken file, or no port of a known role."""
    base, files = port_files(path)
    limit = ReadLimit(path, limit.memory, files.values())
    notes: list[Note] = []
    given = ports(robot)
    roles: dict[str, tuple[Port, ...]] = {}
    data: dict[str, tuple[Array, Array]] = {}
    for port, file in files.items():
        roles[port] = given.get(port) or _usual(port, robot)
        if not roles[port]:
            continue
        values, _ = read_numbers(file, limit, notes)
        if values.shape[1] < 2:
            raise LogError("holds no values beside the time", path=file)
        data[port] = (values[:, 0], values[:, 1:])
    digest = sha256(next(iter(files.values())))
    return log_of_ports(base, limit, digest, data, roles, robot, notes)


def port_files(path: Path) -> tuple[str, dict[str, Path]]:
    """The recording's name and its files by port."""
    base = path.name.rpartition(".")[0]
    files = (file for file in path.parent.glob("*") if file.is_file())
    beside = sorted(file for file in files if file.name.rpartition(".")[0] == base)
    return base, {file.suffix.removeprefix("."): file for file in beside[:COLUMNS]}


def is_port_file(path: Path) -> bool:
    """Whether a file's name ends in a port whose role is known without a robot file."""
    port = path.suffix.removeprefix(".")
    return bool(path.stem) and any(re.search(pattern, port) for pattern, _ in USUAL)


def _usual(port: str, robot: RobotModel | None) -> tuple[Port, ...]:
    names = {"imu": "imu", "left": "left", "right": "right"}
    if robot is not None:
        names |= {side: foot.wrench.name for side, foot in robot.feet.items()}
        names["imu"] = robot.imu.name if robot.imu is not None else "imu"
    role = next((role for pattern, role in USUAL if re.search(pattern, port)), None)
    return () if role is None else (Port(role.format(**names)),)
