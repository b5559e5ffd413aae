"""`plantar design`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from plantar.cli.console.terminal import console, end_progress, number, progress, table
from plantar.errors import MissingExtra, PlantarError, located
from plantar.results.io import dump_json
from plantar.robot.model import load_robot


def run(
    robot: Annotated[Path, typer.Argument(help="Robot file (YAML) of a biped.", metavar="ROBOT.yaml")],
    stiffness: Annotated[
        float, typer.Option(help="Of each foot in pitch and roll, as far as you know it, in N·m/rad.")
    ],
    out: Annotated[
        Path, typer.Option(help="CSV of the motion; a JSON with what it promises goes beside it.")
    ],
    damping: Annotated[
        float | None,
        typer.Option(help="In N·m·s/rad, for the prediction; 0.04 s times the stiffness if left out."),
    ] = None,
    duration: Annotated[float, typer.Option(help="Of the motion, in s.")] = 60.0,
    rate: Annotated[float, typer.Option(help="Rows a second, in Hz.")] = 200.0,
    criterion: Annotated[
        str, typer.Option(help="What is made small: the 'widest' relative interval, or D, A of all.")
    ] = "widest",
    seed: Annotated[int, typer.Option(help="Draws frequencies and the search.", min=0)] = 0,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")] = False,
) -> None:
    """Make a motion that shows the feet as well as balance and limits allow, for half to twice the stiffness told.

    MOTION.csv holds `time` and the position of every joint of the URDF, from standing still to standing still.
    MOTION.json holds the half widths it predicts, the balance margins and the limits it kept.

    Example: plantar design robot.yaml --stiffness 500 --out motion.csv
    """
    try:
        from plantar.design.outputs import content_of, write_design
        from plantar.design.story import DesignSettings, design_motion
    except ImportError as error:
        raise MissingExtra(error.name or "mujoco", "twin", "plantar design") from error
    if out.suffix.lower() != ".csv":
        raise PlantarError(located("has an unknown ending", path=out, valid=".csv"))
    settings = DesignSettings(stiffness, damping, duration, criterion, seed)  # type: ignore[arg-type]
    step = progress(quiet)
    found = design_motion(load_robot(robot), settings, step)
    step("write")
    write_design(found, out, rate)
    end_progress(quiet)
    content = content_of(found, out, rate)
    if json:
        print(dump_json(content), end="")
        return
    screen = console()
    rows = [
        (row["foot"], row["axis"], row["name"], number(row["half_width_percent"], 3),
         *(number(one["half_width_percent"], 3) for one in row["at"]))
        for row in content["parameters"]
    ]  # fmt: skip
    factors = [f"x{one['factor']:.3g}" for one in content["rehearsals"]]
    screen.print(table("95 % half widths that it predicts [% of the value]",
                       ("foot", "axis", "parameter", "predicted", *factors), rows))  # fmt: skip
    rows = [
        (f"x{one['factor']:.3g}", number(1e3 * one["sole_margin"], 3), number(100 * one["least_load"], 3),
         number(one["friction"], 2), number(100 * one["effort"], 3), number(one["bend"], 2))
        for one in content["rehearsals"]
    ]  # fmt: skip
    heads = (
        "stiffness",
        "margin on the soles [mm]",
        "least load [%]",
        "friction",
        "torque [% of limit]",
        "bend [rad]",
    )
    screen.print(table("\nRehearsed", heads, rows))
    screen.print(f"\n{out}\n{out.with_suffix('.json')}", markup=False)
