"""`plantar report`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.report import write_dynamics_report, write_feet_report
from plantar.results.feet import FEET_SCHEMA
from plantar.results.io import read_result


def run(
    result: Annotated[
        Path, Argument(help="A result.json with its residuals beside it.", metavar="RESULT.json")
    ],
    out: Annotated[
        Path | None,
        Option("--out", metavar="FILE", help="The page to write; report.html beside the result if left out."),
    ] = None,
) -> None:
    """Write the result's report.html again, from its result.json and residuals.

    Example: plantar report out/feet/result.json
    """
    kind = FEET_SCHEMA.partition("/")[0]  # whether the version can be read, its reader says
    feet = read_result(result)["schema"].startswith(kind)
    print(write_feet_report(result, out) if feet else write_dynamics_report(result, out))
