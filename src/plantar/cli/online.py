"""`plantar online`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from plantar.cli.console.delay import WrenchDelay
from plantar.cli.console.memory import Memory
from plantar.cli.console.terminal import (
    VERDICT_STYLE,
    console,
    end_progress,
    number,
    print_notes,
    progress,
    table,
)
from plantar.logs.readers import open_log
from plantar.online.estimates import Contact, Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay
from plantar.online.verdicts import judged, log_notes
from plantar.results.feet import FeetResult, Parameter
from plantar.results.io import dump_json
from plantar.robot.model import RobotModel, load_robot

LONGEST_WAIT = 120.0  # s for a browser to open the page
RESULT_HELP = "A result of `identify feet`: its hysteresis, compliance, delay and cutoff are used."


def run(
    robot: Annotated[Path, typer.Argument(help="Robot file (YAML).", metavar="ROBOT.yaml")],
    log: Annotated[Path, typer.Argument(help="Log to replay.", metavar="LOG")],
    result: Annotated[Path | None, typer.Option(help=RESULT_HELP, metavar="RESULT.json")] = None,
    wrench_delay: WrenchDelay = None,
    cutoff: Annotated[
        float | None, typer.Option(help="Of the filters before the regressions, in Hz; the result's, or 5.")
    ] = None,
    write_model: Annotated[
        Path | None,
        typer.Option(help="Also write the file that a controller in C++ constructs its estimator from."),
    ] = None,
    live: Annotated[
        bool, typer.Option("--live", help="Also show it in a browser, at the pace at which it was recorded.")
    ] = False,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Of the page, on this machine alone.")] = 8080,
    memory: Memory = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No table, no progress.")] = False,
) -> None:
    """Replay a log through the estimator of controllers, sample by sample, as a controller would.

    Example: plantar online robot.yaml walk.csv --wrench-delay 4
    """
    step = progress(quiet)
    batch = None if result is None else FeetResult.load(result, residuals=False)
    known = load_robot(robot)
    estimator = FootEstimator(known, batch, wrench_delay=wrench_delay, cutoff=cutoff)
    if write_model is not None:
        estimator.write_model(write_model)
    step(f"read {log.name}")
    motion = open_log(log, known, memory=memory)
    notes = [*log_notes(known, motion), *motion.notes, *motion.joint_notes(known)]
    step(f"replay {log.name}")
    replay = estimator.replay(motion)
    rows = judged(replay.parameters, notes, identified=batch is not None)
    end_progress(quiet)
    if live:
        _show(known, replay, port)
    if json:
        content = {
            "parameters": [asdict(row) for row in rows],
            "latency_us": replay.latency_us,
            "samples": len(motion),
        }
        print(dump_json(content), end="")
    elif not quiet:
        print_notes(console(), notes)
        _print(replay, rows)


def _show(robot: RobotModel, replay: Replay, port: int) -> None:
    from plantar.report.live import LiveView, play

    with LiveView(robot, port) as view:
        print(
            f"open {view.url} in a browser: the log begins when the page is read", file=sys.stderr, flush=True
        )
        if view.wait_for_reader(LONGEST_WAIT):
            play(view, replay)
        else:
            print(f"nobody has opened the page in {LONGEST_WAIT:.0f} s", file=sys.stderr, flush=True)


def _print(replay: Replay, rows: Sequence[Parameter]) -> None:
    out = console()
    heads = ("foot", "axis", "parameter", "value", "95 %", "unit", "verdict", "reason")
    cells = [
        (row.foot, row.axis, row.name, number(row.value), f"± {number(row.half_width, 2)}", row.unit, row.verdict,
         row.reason)
        for row in rows
    ]  # fmt: skip
    out.print(table("At the end of the log", heads, cells, [VERDICT_STYLE[row.verdict] for row in rows]))
    through = (
        "foot",
        "stands %",
        *(f"{axis} mrad rms" for axis in ("pitch", "roll")),
        "flags, % of the samples",
    )
    out.print(table("Through the log", through, [_foot_row(replay, foot) for foot in replay.feet]))
    time = replay.latency_us
    out.print(
        f"a step: median {time['median']:.1f} µs, 99.9 % {time['p999']:.1f} µs, longest {time['max']:.1f} µs"
    )


def _foot_row(replay: Replay, foot: str) -> tuple[str, ...]:
    stands = replay.column(foot, "contact") == Contact.STANCE
    flags = replay.column(foot, "flags").astype(int)
    shares = ((flag, float((flags & flag > 0).mean())) for flag in Flag)
    said = ", ".join(f"{flag.name} {100 * share:.1f}" for flag, share in shares if share and flag.name)
    swings = (1e3 * replay.column(foot, f"{axis}.deflection")[stands] for axis in ("pitch", "roll"))
    return foot, f"{100 * stands.mean():.1f}", *(f"{x.std():.2f}" if x.size else "–" for x in swings), said
