"""`plantar init`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.errors import PlantarError
from plantar.files import write_text
from plantar.robot.model import load_robot
from plantar.robot_guess import guess_robot_file

OUT_HELP = "The robot file to write."
COLUMNS_HELP = "A YAML file with the key `columns`, for logs whose column names are not plantar's."
LOGS_HELP = "Logs of the robot standing, to find sensors in and to check the file against."


def run(
    urdf: Annotated[Path, Argument(help="The robot's URDF.", metavar="URDF")],
    logs: Annotated[list[Path] | None, Argument(help=LOGS_HELP, metavar="LOG...")] = None,
    out: Annotated[Path, Option("--out", help=OUT_HELP, metavar="FILE")] = Path("robot.yaml"),
    columns: Annotated[Path | None, Option("--columns", help=COLUMNS_HELP, metavar="FILE")] = None,
    force: Annotated[bool, Option("--force", help="Write over an existing file.")] = False,
) -> None:
    """Write a first robot file: feet and soles from the URDF, sensors from the logs; every guess is marked.

    Example: plantar init talos.urdf sway_1.mcap --out talos.yaml
    """
    if out.exists() and not force:
        raise PlantarError("is there already", path=out, valid="another --out, or --force")
    write_text(out, guess_robot_file(urdf, logs or [], out, columns))
    guesses = load_robot(out).guesses  # what was written must be readable
    print(out.read_text(), end="")
    first = "look at the outlines of the soles first: no interval allows for a wrong one"
    print(f"# {out}: {len(guesses)} lines are guesses, marked GUESS; {first}")
