"""`plantar convert`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.cli.console import options
from plantar.errors import PlantarError
from plantar.logs.readers import motion_name, open_log
from plantar.logs.save import ENDINGS, save_log
from plantar.robot.model import load_robot

LOGS_HELP = "Logs of any format that plantar reads."
OUT_HELP = "A file ending in " + ", ".join(ENDINGS) + "; for several logs a directory."
ROBOT_HELP = "Robot file, for its topics and column map, and for the frames of a bag's messages."


def run(
    logs: Annotated[list[Path], Argument(help=LOGS_HELP, metavar="LOG...")],
    out: Annotated[Path, Option("--out", help=OUT_HELP, metavar="FILE")],
    to: Annotated[
        str,
        Option("--to", metavar="FORMAT", help="Format of the files in a directory: csv, parquet or mcap."),
    ] = "parquet",
    robot: Annotated[Path | None, Option("--robot", help=ROBOT_HELP, metavar="ROBOT.yaml")] = None,
    memory: options.Memory = None,
    quiet: Annotated[bool, Option("--quiet", "-q", help="Do not print what was assumed.")] = False,
) -> None:
    """A log in another format: a table with plantar's columns, or a ROS 2 bag.

    Example: plantar convert walk.bag --robot talos.yaml --out walk.parquet
    """
    loaded = None if robot is None else load_robot(robot)
    for path, target in zip(logs, _targets(logs, out, to), strict=True):
        log = open_log(path, loaded, memory=memory)
        notes = (*log.notes, *save_log(log, target, loaded))
        if not quiet:
            for note in notes:
                print(f"{note.severity}: {note.text}", file=sys.stderr)
        print(target)


def _targets(logs: list[Path], out: Path, to: str) -> list[Path]:
    if len(logs) == 1 and out.suffix.lower() in ENDINGS:
        return [out]
    if not (out.is_dir() or out.suffix.lower() in ("", *ENDINGS) or out.suffix[1:].isdigit()):
        valid = f"a file ending in {', '.join(ENDINGS)}, or a folder"
        raise PlantarError(f"ends in {out.suffix}, which convert does not write", path=out, valid=valid)
    if f".{to}" not in ENDINGS:
        raise PlantarError(f"--to {to} is not a format", valid=", ".join(e[1:] for e in ENDINGS))
    if out.suffix.lower() in ENDINGS or out.is_file():
        raise PlantarError("is one file for several logs", path=out, valid="a directory, and --to a format")
    names = [motion_name(path) for path in logs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise PlantarError(f"two logs are called '{twice}'", path=out, valid="logs of different names")
    return [out / f"{name}.{to}" for name in names]
