"""What `plantar identify inertia` and `plantar identify joints` share: options, and the way from logs to results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from plantar.cli.terminal import console, end_progress
from plantar.errors import PlantarError, located
from plantar.identify.dynamics_result import DynamicsResult
from plantar.identify.whole_body import DynamicsSettings
from plantar.log import MotionLog
from plantar.readers import open_log
from plantar.report import write_dynamics_report
from plantar.result import dump_json
from plantar.robot import RobotModel, load_robot

Robot = Annotated[Path, typer.Argument(help="Robot file (YAML).", metavar="ROBOT.yaml")]
Logs = Annotated[list[Path], typer.Argument(help="Logs to fit.", metavar="LOG...")]
Out = Annotated[Path, typer.Option("--out", help="Folder for result.json, identified.urdf and the report.")]
Validate = Annotated[
    list[Path] | None, typer.Option("--validate", help="A log to score only; repeat for more.")
]
Cutoff = Annotated[float, typer.Option(help="Zero-phase low-pass on both sides of the fit [Hz].", min=0.1)]
AsRecorded = Annotated[
    bool,
    typer.Option(
        "--as-recorded", help="Name wrench channels that contradict Newton's law, but do not mend them."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print result.json instead of tables.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No tables, no progress.")]

CUTOFF = DynamicsSettings.cutoff

Identify = Callable[[RobotModel, Sequence[MotionLog], Sequence[MotionLog]], DynamicsResult]


def identified(
    identify: Identify,
    show: Callable[[Console, DynamicsResult], None],
    robot: Path,
    logs: Sequence[Path],
    validate: Sequence[Path] | None,
    out: Path,
    *,
    json: bool,
    quiet: bool,
) -> None:
    """Read, identify, save, report and print."""
    if out.exists() and not out.is_dir():
        raise PlantarError(located("is a file", path=out, valid="a folder for the results"))
    loaded = load_robot(robot)
    fitted, unseen = ([open_log(path, loaded) for path in paths] for paths in (logs, validate or ()))
    result = identify(loaded, fitted, unseen)
    path = result.save(out)
    report = write_dynamics_report(path)
    end_progress(quiet)
    if json:
        print(dump_json(result.to_dict()), end="")
    elif not quiet:
        screen = console()
        show(screen, result)
        screen.print(f"\n{path}\n{out / 'identified.urdf'}\n{report}", markup=False)
