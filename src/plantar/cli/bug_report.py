"""`plantar bug-report`."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Iterator, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated

import yaml
from typer import Argument

import plantar
from plantar.cli.console import options
from plantar.errors import PlantarError
from plantar.inspection import inspect_log
from plantar.logs.readers import open_log
from plantar.results.io import dump_json
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.schema import read_robot_file, read_yaml

DEPENDENCIES = ("numpy", "scipy", "pin", "pydantic", "pyarrow", "typer", "mujoco", "clarabel", "rosbags")
# Where a path begins: a slash or a drive behind a space, a quote, a bracket or the like, and no word before it.
INNER = r"(?:[^\s'\",;()<>|]*[/\\])"
PATH = re.compile(rf"(?<![\w./\\])(?:(?:[A-Za-z]:|~)[/\\]{INNER}?|[/\\]{INNER})")


def run(
    robot: options.Robot,
    logs: Annotated[list[Path], Argument(help="Logs that show the trouble.", metavar="LOG...")],
    memory: options.Memory = None,
) -> None:
    """What to send with a question: versions, the robot file's settings and what `inspect` says, as Markdown to paste.

    No sample of a log is in it, no comment of the robot file, no folder, no name of a user or machine: files go by
    their own names. A log that cannot be read is no obstacle: what plantar says of it is in the report.

    Example: plantar bug-report talos.yaml sway_1.csv > report.md
    """
    known = Folders([robot, *logs])
    for section in sections(robot, logs, memory):
        print(known.left_out(section), flush=True)


def sections(robot: Path, logs: Sequence[Path], memory: int | None) -> Iterator[str]:
    """The report part by part, so that what comes before an unexpected error is printed."""
    yield f"## plantar {plantar.__version__}: bug report\n\nWhat did you do, what did you expect, what happened?\n"
    yield _versions()
    try:
        yield _folded(f"robot file {robot.name}", "yaml", _settings(robot))
        loaded = load_robot(robot)
    except PlantarError as error:
        yield f"`{robot.name}` is refused: {error}\n"
        return
    for log in logs:
        yield _inspected(log, loaded, memory)


def _versions() -> str:
    found = {
        "plantar": plantar.__version__,
        "Python": f"{platform.python_version()} ({platform.python_implementation()})",
        "platform": f"{platform.platform()}, {os.cpu_count()} processors",
        **{name: _version(name) for name in DEPENDENCIES},
    }
    rows = "\n".join(f"| {name} | {value} |" for name, value in found.items())
    return f"| | version |\n|---|---|\n{rows}\n"


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


def _settings(robot: Path) -> str:
    """What the robot file says, without its comments; which of its keys are guesses."""
    entry, guesses = read_robot_file(robot)
    said = read_yaml(robot)[0] | {"urdf": Path(entry["urdf"]).name}
    lines = [f"# guessed: {guess.key}" for guess in guesses]
    return "\n".join([*lines, yaml.safe_dump(said, sort_keys=False, default_flow_style=None, width=110)])


def _inspected(log: Path, robot: RobotModel, memory: int | None) -> str:
    try:
        summary = inspect_log(robot, open_log(log, robot, memory=memory))
    except PlantarError as error:
        return f"`{log.name}` is refused: {error}\n"
    content = {"schema": "plantar.inspect/1", "logs": [summary.to_dict()]}
    return _folded(f"inspect {log.name}", "json", dump_json(content))


def _folded(title: str, kind: str, text: str) -> str:
    """A part that trackers show folded up."""
    return f"<details><summary>{title}</summary>\n\n```{kind}\n{text.rstrip()}\n```\n\n</details>\n"


class Folders:
    """The folders that files were given in, absolute or not: left out of whatever is printed."""

    def __init__(self, files: Sequence[Path]) -> None:
        folders = {str(folder) for file in files for folder in (file.parent, file.resolve().parent)}
        self.known = sorted(folders - {".", os.sep}, key=len, reverse=True)

    def left_out(self, text: str) -> str:
        """The text with each path shortened to the name of its file; topics such as /imu/data stay as they are."""
        for folder in self.known:
            text = re.sub(rf"(?<![\w./\\-]){re.escape(folder)}[/\\]", "", text)
        return PATH.sub(lambda path: "" if _is_folder(path[0]) else path[0], text)


def _is_folder(path: str) -> bool:
    """Whether a path leads into this machine's files: its first folder is there, whatever follows."""
    if path[0] == "~" or path[1:2] == ":":
        return True
    first = re.split(r"[/\\]", path)[1]
    return bool(first) and Path(os.sep, first).is_dir()
