"""`plantar select`."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

from typer import Argument, Option

from plantar.cli.console import options
from plantar.cli.console.terminal import console, end_progress, print_json, progress, table
from plantar.logs.inputs import open_together
from plantar.motions.select_motions import UNKNOWN, Choice, Selection, select_motions
from plantar.results.feet_text import SYMBOLS
from plantar.results.numbers import number
from plantar.robot.model import load_robot


def run(
    robot: options.Robot,
    logs: Annotated[list[Path], Argument(help="Logs to choose from.", metavar="LOG...")],
    compare: Annotated[
        str,
        Option(metavar="MOTION,...", help="Motions to compare with the best set, separated by commas."),
    ] = "",
    largest: Annotated[int, Option(metavar="N", help="Largest number of logs in a set.", min=1, max=20)] = 6,
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Rank logs, alone and in sets, by how much they say about each parameter of the feet.

    Example: plantar select robot.yaml out/*.csv --compare Manual_right_roll,Manual_left_roll,Tilt3
    """
    step = progress(quiet)
    known = load_robot(robot)
    named = [name.strip() for name in compare.split(",") if name.strip()]
    found = select_motions(known, open_together(logs, known, memory), named, largest, progress=step)
    end_progress(quiet)
    if json:
        print_json(schema="plantar.selection/1", **_plain(found))
        return
    screen = console()
    screen.print(_table("Each log alone: the expected 95 % half width [% of the value]", found.alone))
    screen.print(_table("\nThe best set of each size", found.best))
    rows = [choice for choice in (found.compared, found.together) if choice is not None]
    screen.print(_table("\nFor comparison", rows))
    smallest = next((c for c in found.best if c.usual < 1.2 * found.best[-1].usual), found.best[-1])
    few = "1 log gives" if len(smallest.motions) == 1 else f"{len(smallest.motions)} logs give"
    screen.print(f"\n{few} nearly all the information: {', '.join(smallest.motions)}.", markup=False)


def _table(title: str, choices: Any) -> object:
    keys = list(choices[0].half_width_percent)
    heads = [f"{foot[:5]} {axis} {SYMBOLS[term]}" for foot, axis, term in keys]
    rows = [
        (" + ".join(choice.motions), *(_percent(choice.half_width_percent[key]) for key in keys),
         number(choice.usual, 3), number(choice.condition_number, 3))
        for choice in choices
    ]  # fmt: skip
    return table(title, ("logs", *heads, "mean", "condition"), rows)


def _percent(value: float) -> str:
    return "–" if value >= UNKNOWN else number(value, 3)


def _plain(found: Selection) -> dict[str, Any]:
    def choice(one: Choice) -> dict[str, Any]:
        widths = [
            {"foot": f, "axis": a, "name": n, "percent": w} for (f, a, n), w in one.half_width_percent.items()
        ]
        return {**asdict(one), "half_width_percent": widths, "usual": one.usual}

    return {
        "alone": [choice(one) for one in found.alone],
        "best": [choice(one) for one in found.best],
        "together": choice(found.together),
        "compared": choice(found.compared) if found.compared else None,
    }
