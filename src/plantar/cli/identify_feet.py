"""`plantar identify feet`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, cast

import numpy as np
import typer

from plantar.cli.feet_tables import print_feet
from plantar.cli.terminal import console, end_progress, progress
from plantar.errors import PlantarError, located
from plantar.identify.feet import identify_feet
from plantar.identify.settings import AUTOMATIC, FeetSettings, OffsetRule
from plantar.models import LAWS
from plantar.readers import open_log
from plantar.report import write_feet_report
from plantar.result import dump_json
from plantar.robot import load_robot

OFFSETS = ("per-motion", "shared")


def run(
    robot: Annotated[Path, typer.Argument(help="Robot file (YAML).", metavar="ROBOT.yaml")],
    logs: Annotated[list[Path], typer.Argument(help="Logs to fit, each with its own offset.", metavar="LOG...")],
    out: Annotated[Path, typer.Option("--out", help="Folder for result.json, residuals.parquet and report.html.")],
    validate: Annotated[list[Path] | None, typer.Option("--validate", help="Logs to score only.")] = None,
    offset: Annotated[str, typer.Option(help="One offset per motion, or shared by all as in the paper.",
                                        metavar="per-motion|shared")] = "per-motion",
    model: Annotated[str, typer.Option(help=f"Law of the bush: {', '.join((AUTOMATIC, *LAWS))}. {AUTOMATIC} takes what "
                                       "predicts held-out motions best.", metavar="LAW")] = AUTOMATIC,
    wrench_delay: Annotated[float | None, typer.Option(help="How late the wrenches are [ms]; estimated if "
                                                       "left out.")] = None,
    cutoff: Annotated[float, typer.Option(help="Zero-phase low-pass on both sides of the fit [Hz].", min=0.1)] = 5.0,
    window: Annotated[float | None, typer.Option(help="Largest deflection from the resting pose that serves [deg].",
                                                 min=0.01)] = None,
    json: Annotated[bool, typer.Option("--json", help="Print result.json instead of tables.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No tables, no progress.")] = False,
) -> None:  # fmt: skip
    """Stiffness, damping and offset of each foot, in pitch and roll, from logs of a standing robot.

    Example: plantar identify feet talos.yaml sway_*.csv --validate squat.csv --out out/feet
    """
    if offset not in OFFSETS:
        raise typer.BadParameter(f"'{offset}' is not one of {', '.join(OFFSETS)}", param_hint="--offset")
    if model not in (AUTOMATIC, *LAWS):
        raise typer.BadParameter(
            f"'{model}' is not one of {', '.join((AUTOMATIC, *LAWS))}", param_hint="--model"
        )
    if out.exists() and not out.is_dir():
        raise PlantarError(located("is a file", path=out, valid="a folder for the results"))
    step = progress(quiet)
    reach = None if window is None else float(np.radians(window))
    late = None if wrench_delay is None else 1e-3 * wrench_delay
    settings = FeetSettings(cast(OffsetRule, offset), model, cutoff, window=reach, wrench_delay=late)
    loaded = load_robot(robot)
    fitted, unseen = ([open_log(path, loaded) for path in paths] for paths in (logs, validate or ()))
    result = identify_feet(loaded, fitted, unseen, settings, step)
    step("write")
    path = result.save(out)
    report = write_feet_report(path)
    end_progress(quiet)
    if json:
        print(dump_json(result.to_dict()), end="")
    elif not quiet:
        screen = console()
        print_feet(screen, result)
        screen.print(f"\n{path}\n{report}", markup=False)
