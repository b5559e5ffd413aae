"""`plantar export`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.cli.console import options
from plantar.exporters import TARGETS, export
from plantar.exporters.job import LEAST_LOAD

TARGET_HELP = "One of: " + ", ".join(TARGETS) + "."
MODEL_HELP = "Existing robot model to extend: MJCF, SDFormat, URDF or USD; the result's own URDF if left out."
HYSTERESIS_HELP = (
    "mujoco-contact: slip and tipping, which contact points cannot model, are left to plantar.FootHysteresis, to be "
    "called in your simulation's loop."
)
OFFSET_HELP = "Let each spring rest at -offset/K instead of 0."


def run(
    result: Annotated[
        Path, Argument(help="A result.json of identify feet or inertia.", metavar="RESULT.json")
    ],
    to: Annotated[str, Option("--to", help=TARGET_HELP, metavar="TARGET")],
    out: Annotated[Path, Option("--out", help="The file to write.", metavar="FILE")],
    model: Annotated[Path | None, Option("--model", help=MODEL_HELP, metavar="MODEL")] = None,
    with_offset: Annotated[bool, Option("--with-offset", help=OFFSET_HELP)] = False,
    swing: options.Swing = None,
    hysteresis: Annotated[bool, Option("--hysteresis", help=HYSTERESIS_HELP)] = False,
    pivot: options.Pivot = "ground",
    least_load: options.LeastLoad = LEAST_LOAD,
    quiet: Annotated[bool, Option("--quiet", "-q", help="No notes on what the target cannot hold.")] = False,
) -> None:
    """Write a result for a simulator or controller: springs and dampers in its own format and units.

    Example: plantar export out/feet/result.json --to mjcf --model robot.xml --out robot_on_bushes.xml
    """
    notes = export(
        result,
        to,
        out,
        model,
        with_offset=with_offset,
        swing=swing,
        hysteresis=hysteresis,
        pivot=pivot,
        least_load=least_load,
    )
    if not quiet:
        for note in notes:
            print(f"{out.name}: {note.severity}: {note.text}", file=sys.stderr)
    print(out)
