"""`plantar identify inertia`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from plantar.cli.dynamics_tables import print_inertia
from plantar.cli.terminal import console, end_progress, progress
from plantar.errors import PlantarError, located
from plantar.identify.inertia import identify_inertia
from plantar.identify.whole_body import DynamicsSettings
from plantar.readers import open_log
from plantar.report import write_dynamics_report
from plantar.result import dump_json
from plantar.robot import load_robot


def run(
    robot: Annotated[Path, typer.Argument(help="Robot file (YAML).", metavar="ROBOT.yaml")],
    logs: Annotated[list[Path], typer.Argument(help="Logs to fit.", metavar="LOG...")],
    out: Annotated[
        Path, typer.Option("--out", help="Folder for result.json, identified.urdf and the report.")
    ],
    validate: Annotated[
        list[Path] | None, typer.Option("--validate", help="A log to score only; repeat for more.")
    ] = None,
    cutoff: Annotated[
        float, typer.Option(help="Zero-phase low-pass on both sides of the fit [Hz].", min=0.1)
    ] = DynamicsSettings.cutoff,
    json: Annotated[bool, typer.Option("--json", help="Print result.json instead of tables.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No tables, no progress.")] = False,
) -> None:
    """Masses, centres and inertias of a floating-base robot's links from IMU, encoders and feet (eq. 2).

    Example: plantar identify inertia talos.yaml walk_1.csv --validate walk_2.csv --out out/inertia
    """
    if out.exists() and not out.is_dir():
        raise PlantarError(located("is a file", path=out, valid="a folder for the results"))
    loaded = load_robot(robot)
    fitted, unseen = ([open_log(path, loaded) for path in paths] for paths in (logs, validate or ()))
    result = identify_inertia(loaded, fitted, unseen, DynamicsSettings(cutoff), progress(quiet))
    path = result.save(out)
    report = write_dynamics_report(path)
    end_progress(quiet)
    if json:
        print(dump_json(result.to_dict()), end="")
    elif not quiet:
        screen = console()
        print_inertia(screen, result)
        screen.print(f"\n{path}\n{out / 'identified.urdf'}\n{report}", markup=False)
