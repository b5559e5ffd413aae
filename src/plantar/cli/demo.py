"""`plantar demo`."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from plantar.cli.console import options
from plantar.cli.console.terminal import console, end_progress, print_json, progress, table
from plantar.errors import needs
from plantar.files import refuse_file

if TYPE_CHECKING:
    from plantar.campaign import Campaign
    from plantar.report import Table

MARKS = {"good": "green", "weak": "yellow", "bad": "red"}
PRESET_HELP = (
    "Imperfections: ideal; sensors: noise, biases, zeros, drift; realistic: also hysteresis and late force sensors; "
    "or harsh."
)


def run(
    out: Annotated[
        Path, Option("--out", metavar="DIR", help="Folder for logs, result, figures and report.")
    ] = Path("out/demo"),
    preset: Annotated[str, Option(metavar="PRESET", help=PRESET_HELP)] = "realistic",
    seed: Annotated[int, Option(metavar="N", help="Seed of noise, biases and zeros.", min=0)] = 0,
    quick: Annotated[bool, Option("--quick", help="Two motions only: to see it run.")] = False,
    json: Annotated[bool, Option("--json", help="Print result.json instead of tables.")] = False,
    quiet: options.Quiet = False,
) -> None:  # fmt: skip
    """The paper's campaign on a robot in MuJoCo whose feet are known: play, record, identify, validate, report.

    OUT gets logs/ (robot file, URDF, logs, and the truth beside them), result.json, residuals.parquet,
    report.html, robot.html (the robot in motion) and figures/ (SVG and PDF).

    Example: plantar demo --out out/demo
    """
    with needs("mujoco", "all", "plantar demo"):
        from plantar.campaign import Course, run_campaign
        from plantar.campaign.present import write_campaign_report
    refuse_file(out)
    step = _progress(quiet)
    campaign = run_campaign(out, Course.quick() if quick else None, preset, seed, step)
    written = write_campaign_report(campaign, step)
    end_progress(quiet)
    if json:
        print_json(**campaign.result.to_dict())
    elif not quiet:
        _print(campaign)
        paths = (out / "result.json", written.report, written.scene, out / "figures")
        console().print("\n" + "\n".join(str(path) for path in paths), markup=False)


def _progress(quiet: bool) -> Callable[[str], None]:
    """On a terminal every step in place, elsewhere only the steps that take long."""
    show = progress(quiet)
    if quiet or sys.stderr.isatty():
        return show
    return lambda line: show(line) if line.startswith(("play", "replay", "write")) else None


def _print(campaign: Campaign) -> None:
    from plantar.campaign.tables import tables

    out = console()
    for place, made in enumerate(tables(campaign)):
        if place:
            out.print()
        out.print(_drawn(made))
    for note in campaign.result.notes:
        if note.severity == "warning":
            out.print(f"note: {note.text}", markup=False, style="yellow")


def _drawn(made: Table) -> object:
    headings = [f"{one.heading} [{one.unit}]" if one.unit else one.heading for one in made.columns]
    rows = [[cell.text for cell in row] for row in made.rows]
    told = ("bad", "weak")
    styles = [next((MARKS[cell.mark] for cell in row if cell.mark in told), "") for row in made.rows]
    return table(made.caption, headings, rows, styles)
