"""`plantar init`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from plantar.errors import PlantarError, located
from plantar.files import write_text
from plantar.robot.model import load_robot
from plantar.robot_guess import guess_robot_file

OUT_HELP = "The robot file to write."


def run(
    urdf: Annotated[Path, typer.Argument(help="The robot's URDF.", metavar="URDF")],
    logs: Annotated[list[Path], typer.Argument(help="Logs to look for sensors in.", metavar="LOG...")],
    out: Annotated[Path, typer.Option("--out", help=OUT_HELP, metavar="FILE")] = Path("robot.yaml"),
    force: Annotated[bool, typer.Option("--force", help="Write over an existing file.")] = False,
) -> None:
    """Write a first robot file by looking: feet and soles from the URDF, sensors from logs; every guess is marked.

    Example: plantar init talos.urdf sway_1.mcap --out talos.yaml
    """
    if out.exists() and not force:
        raise PlantarError(located("is there already", path=out, valid="another --out, or --force"))
    text = guess_robot_file(urdf, logs, out)
    write_text(out, text)
    load_robot(out)  # what was written must be readable
    print(text, end="")
    guesses = text.count("# GUESS")
    print(f"# {out}: {guesses} lines are guesses, marked GUESS; look at the bush heights first")
