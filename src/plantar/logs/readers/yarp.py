"""YARP dumps: one directory a port with `data.log` (number, time stamps, values) and `info.log`.

As written by yarpdatadumper (yarp.it): `[packet] [stamp] [bottle]`, with two stamps where info.log says
`Stamp: tx+rx`. Brackets of nested bottles are read over. Roles come from `columns.ports`, keyed by the port's
directory; YARP's own units are degrees and degrees per second, so give `unit: deg`.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

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

DEPTH = 5  # directories below the one given
INFO_LIMIT = 4096  # bytes of info.log that are looked at


def read(path: Path, robot: RobotModel | None, limit: ReadLimit) -> MotionLog:
    """Read every dumped port under a directory, or the one a `data.log` belongs to."""
    root = path if path.is_dir() else path.parent
    files = dumps(root)
    limit = ReadLimit(path, limit.memory, files)
    notes: list[Note] = []
    given = ports(robot)
    data: dict[str, tuple[Array, Array]] = {}
    roles: dict[str, tuple[Port, ...]] = {}
    for file in files:
        port = "/".join(file.parent.relative_to(root).parts) or file.parent.name
        roles[port] = given.get(port) or given.get(file.parent.name, ())
        if not roles[port]:
            notes.append(Note("port_ignored", "info", f"{port}: no role in columns.ports, not used"))
            data[port] = (np.empty(0), np.empty((0, 0)))
            continue
        values, _ = read_numbers(file, limit, notes, strip=b'()"[]')
        stamps = 2 if _both_stamps(file.parent / "info.log") else 1
        if values.shape[1] <= 1 + stamps:
            raise LogError("holds no values beside packet number and stamp", path=file)
        data[port] = (values[:, 1], values[:, 1 + stamps :])
    return log_of_ports(root.name, limit, sha256(files[0]), data, roles, robot, notes)


def dumps(root: Path) -> list[Path]:
    """The `data.log` files at most `DEPTH` directories below `root`. LogError when there is none."""
    found: list[Path] = []
    for depth in range(DEPTH):
        found += sorted(root.glob("*/" * depth + "data.log"))[:COLUMNS]
    if not found:
        valid = "a ROS bag, or YARP dumps with data.log"
        if endings := sorted({"".join(file.suffixes[-2:]) for file in root.iterdir() if file.is_file()}):
            raise LogError(
                "is a directory, no log",
                path=root,
                valid=f"its files, such as {root / f'*{endings[0]}'}; {valid}",
            )
        raise LogError("is a directory without logs", path=root, valid=valid)
    return found


def _both_stamps(info: Path) -> bool:
    try:
        with open(info, "rb") as handle:
            text = handle.read(INFO_LIMIT)
    except OSError:
        return False
    line = next((line for line in text.splitlines() if line.startswith(b"Stamp:")), b"")
    return b"tx" in line and b"rx" in line
