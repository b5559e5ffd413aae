"""`plantar fleet plan`."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from typer import Argument, BadParameter, Option

from plantar.cli.console import options
from plantar.cli.console.terminal import end_progress, progress
from plantar.files import write_text
from plantar.fleet.manifest import written
from plantar.fleet.plan import find_logs, groups_of, plan_logs, sources_of
from plantar.robot.model import load_robot

UNIT_HELP = (
    "The robot's serial number: a name for all logs, or a regular expression in which one group in parentheses finds "
    "it in each log's path, such as `logs/([^/]+)/`. The robot file's name if left out."
)


def run(
    logs: Annotated[list[str], Argument(help="Logs: paths, patterns in quotes, or URLs.", metavar="GLOB...")],
    robot: Annotated[Path, Option("--robot", metavar="ROBOT.yaml", help="Robot file of all these logs.")],
    unit: Annotated[str | None, Option(metavar="NAME", help=UNIT_HELP)] = None,
    out: Annotated[
        Path | None,
        Option("--out", metavar="MANIFEST.csv", help="The manifest; it is printed if left out."),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """A manifest for `plantar fleet run` from files: a group for each robot and day, with times from the logs.

    Example: plantar fleet plan 'logs/**/*.mcap' --robot robot.yaml --unit 'logs/([^/]+)/' --out fleet.csv
    """
    known = load_robot(robot)
    unit_of = _unit(unit, robot.stem)
    planned = plan_logs(find_logs(logs), known, unit_of, progress(quiet))
    groups = groups_of(planned, str(robot.resolve()))
    end_progress(quiet)
    text = written(groups)
    if out is None:
        print(text, end="")
    else:
        write_text(out, text)
    if not quiet:
        print(f"{len(groups)} groups of {len(planned)} logs; {sources_of(planned)}", file=sys.stderr)


def _unit(unit: str | None, default: str) -> Callable[[str], str]:
    """What to call the robot of a log, by the log's place."""
    if unit is None or "(" not in unit:
        return lambda _: unit or default
    try:
        pattern = re.compile(unit)
    except re.error as error:
        raise BadParameter(f"'{unit}' is no regular expression: {error}", param_hint="--unit") from None
    if pattern.groups != 1:
        raise BadParameter(
            f"'{unit}' has {pattern.groups} groups in parentheses, not one", param_hint="--unit"
        )

    def found(place: str) -> str:
        match = pattern.search(place)
        if match is None or not match[1]:
            raise BadParameter(f"'{unit}' finds no unit in {place}", param_hint="--unit")
        return match[1]

    return found
