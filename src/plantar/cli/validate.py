"""`plantar validate`."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from typer import Argument

from plantar.cli.console import options
from plantar.cli.console.terminal import console, end_progress, print_json, print_notes, progress
from plantar.cli.identify.feet_tables import validation_table
from plantar.feet.validate import scored_feet
from plantar.logs.inputs import open_together
from plantar.results.feet import FeetResult
from plantar.robot.model import load_robot


def run(
    result: options.FeetFile,
    robot: options.Robot,
    logs: Annotated[list[Path], Argument(help="Logs that the fit has not seen.", metavar="LOG...")],
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Reconstruct the torque of unseen logs with identified feet and compare (table 3).

    Example: plantar validate out/feet/result.json robot.yaml squat.csv
    """
    step = progress(quiet)
    found = FeetResult.load(result, residuals=False)
    known = load_robot(robot)
    rows, notes = scored_feet(found, known, open_together(logs, known, memory), step)
    end_progress(quiet)
    if json:
        said = {"validation": [asdict(row) for row in rows], "notes": [asdict(note) for note in notes]}
        print_json(schema="plantar.validation/1", **said)
    elif not quiet:
        console().print(validation_table("Table 3. Cross validation", rows))
        print_notes(console(), notes)
