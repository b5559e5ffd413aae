"""`plantar compare`."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from plantar.cli.console import options
from plantar.cli.console.terminal import console, end_progress, progress, table
from plantar.errors import PlantarError, needs
from plantar.exporters.job import LEAST_LOAD, Stance
from plantar.files import refuse_file, write_text
from plantar.logs.inputs import open_together
from plantar.results.feet import FeetResult
from plantar.results.io import dump_json
from plantar.results.numbers import number
from plantar.robot.model import load_robot

if TYPE_CHECKING:
    from plantar.comparison.compare import KindScore

MILLI = 1e3


def run(
    result: options.FeetFile,
    robot: options.Robot,
    logs: Annotated[list[Path], Argument(help="Logs with joints, attitude and wrenches.", metavar="LOG...")],
    simulator: Annotated[str, Option("--simulator", metavar="NAME", help="Only mujoco so far.")] = "mujoco",
    out: Annotated[
        Path | None,
        Option("--out", metavar="DIR", help="Folder for comparison.svg and comparison.json."),
    ] = None,
    swing: options.Swing = None,
    pivot: options.Pivot = "ground",
    least_load: options.LeastLoad = LEAST_LOAD,
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Play logs' joint motion in MuJoCo on rigid feet, on exported joints and on exported contact, beside the record.

    Example: plantar compare out/feet/result.json robot.yaml squat.csv --out out/comparison
    """
    with needs("mujoco", "twin", "plantar compare"):
        from plantar.comparison.compare import SIMULATORS, compare, pooled
        from plantar.comparison.scenes import CONTACT
        from plantar.report.figures.plots import save
        from plantar.report.figures.simulation import replays
    if simulator not in SIMULATORS:
        raise PlantarError("unknown simulator", value=simulator, valid=", ".join(SIMULATORS))
    if out is not None:
        refuse_file(out)
    step = progress(quiet)
    found = FeetResult.load(result, residuals=False)
    known = load_robot(robot)
    scores, replayed = compare(
        found, known, open_together(logs, known, memory), step, swing, Stance(pivot, least_load)
    )
    end_progress(quiet)
    content = dump_json({"schema": "plantar.comparison/1", "scores": [asdict(row) for row in scores]})
    if out is not None:
        write_text(out / "comparison.json", content)
        if replayed:
            save(replays(replayed, CONTACT), out, "comparison", ["svg"])
    if json:
        print(content, end="")
    elif not quiet:
        screen = console()
        heads = ("motion", "feet", "chest pitch [mrad]", "chest roll [mrad]", "foot torque [N·m]")
        screen.print(table("Error against the record", heads, [_cells(row) for row in scores]))
        kinds = tuple(dict.fromkeys(one.feet for one in scores))
        tips = {one.motion: one.tips for one in scores if one.tips is not None}
        for flat in (False, True) if tips else (False,):
            text = ", ".join(f"{kind} {_milli(pooled(scores, kind, flat))}" for kind in kinds)
            screen.print(f"chest, {'until a sole tips' if flat else 'all motions'}: {text}", markup=False)
        for motion, time in tips.items():
            text = (
                f"{motion}: from {time:.1f} s on a sole of the record stands on its edge and tips by itself; "
            )
            text += "points under the ankle follow that only with the loop"
            screen.print(text, markup=False, style="yellow")
        for one in scores:
            if one.fell is not None:
                text = f"{one.motion}: on '{one.feet}' the robot falls at {one.fell:.1f} s"
                text += (
                    f", all are compared up to {one.until:.1f} s" if one.until else ", too early to compare"
                )
                screen.print(text, markup=False, style="yellow")


def _milli(error: float | None) -> str:
    return "-" if error is None else f"{number(MILLI * error, 3)} mrad"


def _cells(row: KindScore) -> tuple[str, ...]:
    if row.chest_pitch is None or row.chest_roll is None:
        return row.motion, row.feet, "falls", "falls", "falls"
    chest = (number(MILLI * row.chest_pitch, 3), number(MILLI * row.chest_roll, 3))
    return row.motion, row.feet, *chest, number(row.torque, 3)
