"""Log files in: every format becomes the same `MotionLog`. One file a format."""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from plantar.errors import LogError, located

if TYPE_CHECKING:
    from plantar.log import MotionLog
    from plantar.robot import RobotModel

Reader = Callable[[Path, "RobotModel | None"], "MotionLog"]

# Ending of the file's name -> module of this package with `read(path, robot) -> MotionLog`.
FORMATS: dict[str, str] = {
    ".csv": "table",
    ".csv.gz": "table",
    ".parquet": "table",
    ".mcap": "ros_bag",
    ".db3": "ros_bag",
    ".bag": "ros_bag",
}


def open_log(path: str | os.PathLike[str], robot: RobotModel | None = None) -> MotionLog:
    """Read one recording, whatever its format; `robot` gives topics or column maps where a format needs them.

    Raises LogError: the file is missing, of an unknown format, or broken.
    """
    path = Path(path)
    if not path.exists():
        raise LogError(located("does not exist", path=path))
    ending = next((e for e in sorted(FORMATS, key=len, reverse=True) if path.name.lower().endswith(e)), None)
    if ending is None:
        raise LogError(located("has an unknown ending", path=path, valid=", ".join(FORMATS)))
    reader: Reader = import_module(f"plantar.readers.{FORMATS[ending]}").read
    return reader(path, robot)


def motion_name(path: Path) -> str:
    """The file's name without its ending: what a result calls the motion."""
    name = path.name
    for ending in sorted(FORMATS, key=len, reverse=True):
        if name.lower().endswith(ending) and len(name) > len(ending):
            return name[: -len(ending)]
    return path.stem
