"""Log files in: every format becomes the same `MotionLog`. One file a format."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from plantar.errors import LogError
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.urdf_names import with_following_joints, with_urdf_names

if TYPE_CHECKING:
    from plantar.logs.motion_log import MotionLog
    from plantar.robot.model import RobotModel

Reader = Callable[[Path, "RobotModel | None", ReadLimit], "MotionLog"]

TRUTH = ".truth."  # in the name of what the twin writes beside its logs
# Ending of the file's name -> module of this package with `read(path, robot, limit) -> MotionLog`.
FORMATS: dict[str, str] = {
    ".csv": "tables.table",
    ".csv.gz": "tables.table",
    ".parquet": "tables.table",
    ".mcap": "ros.bag",
    ".db3": "ros.bag",
    ".bag": "ros.bag",
    ".bag.active": "ros.bag",
    ".bin": "mc_rtc",
    ".mat": "robot_logger",
    ".npz": "column_file",
    ".dat": "column_file",
    ".txt": "column_file",
    ".log": "column_file",
}


def open_log(
    path: str | os.PathLike[str],
    robot: RobotModel | str | os.PathLike[str] | None = None,
    *,
    memory: int | None = None,
    longest: float = math.inf,
) -> MotionLog:
    """Read one recording, whatever its format.

    Args:
        path: a table (.csv, .csv.gz, .parquet), a bag or its folder (.mcap, .db3, .bag), or a log of mc_rtc, hrpsys,
            YARP and others.
        robot: a robot or the path of its file: topics or column names where a format needs them, and what the log
            calls the joints.
        memory: most bytes that the log's numbers may take; a quarter of the machine's memory if left out.
        longest: of a longer Parquet log only those stretches that move most, so many seconds in all, are read.

    Returns:
        The log in SI units, with the columns of `docs/log_columns.md`.

    Raises:
        LogError: the file is missing, of an unknown format, broken or too large. MissingExtra: a package is missing.

    Example:
        >>> import plantar
        >>> log = plantar.open_log("sway_1.csv")
        >>> log.name, len(log), round(1 / log.period)
        ('sway_1', 1201, 100)
    """
    path = Path(path)
    if isinstance(robot, str | os.PathLike):
        from plantar.robot.model import load_robot

        robot = load_robot(robot)
    if not os.path.exists(path):
        raise LogError("does not exist", path=path)
    path = path if path.name not in ("", "..") else path.resolve()  # '.' is a bag's folder as well
    if str(path).encode(errors="replace").decode() != str(path):  # results name it, and are text
        raise LogError("has a name that is no text", path=ascii(str(path)), valid="a name in UTF-8")
    if path.is_file() and path.stat().st_size == 0:
        raise LogError("is empty", path=path, valid="a recording; was it copied to its end?")
    if TRUTH in path.name:  # a pattern such as logs/*.parquet catches it
        raise LogError("is what the twin knows, no log", path=path, valid="the recording beside it")
    module = _module(path, robot)
    reader: Reader = import_module(f"plantar.logs.readers.{module}").read
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # a damaged file may hold any number
            log = reader(path, robot, ReadLimit(path, memory, longest=longest))
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", path=path) from error
    return of_robot(log.without_empty_joints(), robot)


def of_robot(log: MotionLog, robot: RobotModel | None) -> MotionLog:
    """A log as `open_log` gives it, from one that was read without the robot where `reads_alike`."""
    if robot is None:
        return log
    named = with_urdf_names(log, robot.joint_names_in_logs, robot.joint_names)
    return with_following_joints(named, robot.following_joints)


def reads_alike(path: Path, robot: RobotModel) -> bool:
    """Whether a file is read as it is where no robot is known: the names of joints alone differ then."""
    return _module(path, robot) == _module(path, None) == FORMATS[".csv"]


def _module(path: Path, robot: RobotModel | None) -> str:
    """The reader for a path: by what a directory holds, by the file's name, by its ending."""
    if path.is_dir():
        bag = any(part.suffix.lower() in (".mcap", ".db3", ".bag") for part in path.iterdir())
        return "ros.bag" if bag else "yarp"
    if path.name == "data.log":
        return "yarp"
    ending = next((e for e in sorted(FORMATS, key=len, reverse=True) if path.name.lower().endswith(e)), None)
    mapped = robot is not None and not robot.columns.keys() <= {"joints", "ports"}
    if ending is not None:
        return "column_file" if FORMATS[ending] == "tables.table" and mapped else FORMATS[ending]
    from plantar.logs.readers.hrpsys import is_port_file

    named = (
        robot is not None
        and isinstance(entries := robot.columns.get("ports"), Mapping)
        and path.suffix[1:] in entries
    )
    if named or is_port_file(path):
        return "hrpsys"
    raise LogError("has an unknown ending", path=path, valid=", ".join(FORMATS))


def motion_name(path: Path) -> str:
    """The file's name without its ending: what a result calls the motion."""
    name = path.name
    for ending in sorted(FORMATS, key=len, reverse=True):
        if name.lower().endswith(ending) and len(name) > len(ending):
            return name[: -len(ending)]
    return path.stem
