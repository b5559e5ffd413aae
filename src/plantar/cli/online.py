"""`plantar online`."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from plantar.cli.console import options
from plantar.cli.console.terminal import (
    VERDICT_STYLE,
    console,
    end_progress,
    print_json,
    print_notes,
    progress,
    table,
)
from plantar.cli.identify.feet_tables import print_advice
from plantar.conventions import ROTATIONAL_AXES
from plantar.errors import SettingsError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.online.estimates import Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import UNKNOWN, Replay
from plantar.online.verdicts import judged, log_notes, result_notes
from plantar.pages import ONLINE
from plantar.results.feet import FeetResult, Parameter
from plantar.results.numbers import number
from plantar.robot.model import RobotModel, load_robot

if TYPE_CHECKING:  # what prints nothing does not import it
    from rich.table import Table

    from plantar.report.figures.plots import Format

PIECE = 1.0  # s of the log, behind which the table may be refreshed
REFRESH = 0.1  # s between two tables
KINDS: Sequence[Format] = ("png", "svg", "pdf")
LONGEST_WAIT = 120.0  # s for a browser to open the page
DELAY_HELP = (
    "How late the force sensors are against the IMU, in milliseconds (5, not 0.005). If left out: the result's. "
    "Without a result it is 0, and the damping's interval allows for the delay that the robot file allows."
)
RESULT_HELP = (
    "A result of `identify feet`: its hysteresis, compliance, bush centres, delay and cutoff are used."
)


def run(
    robot: options.Robot,
    log: Annotated[Path, Argument(help="Log to replay.", metavar="LOG")],
    result: Annotated[Path | None, Option(help=RESULT_HELP, metavar="RESULT.json")] = None,
    wrench_delay: Annotated[
        float | None, Option(parser=options.seconds, metavar="MS", help=DELAY_HELP)
    ] = None,
    cutoff: Annotated[
        float | None,
        Option(
            metavar="HZ",
            help="Cut-off of the filters before the regressions, in Hz. If left out: the result's, or 5.",
        ),
    ] = None,
    write_model: Annotated[
        Path | None,
        Option(
            metavar="FILE", help="Also write the file that a controller in C++ constructs its estimator from."
        ),
    ] = None,
    live: Annotated[
        bool, Option("--live", help="Also show it in a browser, at the pace at which it was recorded.")
    ] = False,
    plot: Annotated[
        Path | None,
        Option(
            help="Also draw deflections, stiffness and damping over time: FILE.png, .svg or .pdf.",
            metavar="FILE",
        ),
    ] = None,
    port: Annotated[
        int,
        Option(
            metavar="N", min=0, max=65535, help="Port of the --live page, which only this machine can open."
        ),
    ] = 8080,
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Replay a log through the estimator of controllers, sample by sample, as a controller would.

    Example: plantar online robot.yaml walk.csv --wrench-delay 4
    """
    kind = None if plot is None else _kind(plot)
    step = progress(quiet)
    batch = None if result is None else FeetResult.load(result, residuals=False)
    known = load_robot(robot)
    estimator = FootEstimator(known, batch, wrench_delay=wrench_delay, cutoff=cutoff)
    if write_model is not None:
        estimator.write_model(write_model)
    step(f"read {log.name}")
    motion = open_log(log, known, memory=memory)
    notes = [*log_notes(known, motion), *result_notes(batch), *motion.notes, *motion.joint_notes(known)]
    step(f"replay {log.name}")
    end_progress(quiet)
    shown = sys.stdout.isatty() and not json and not quiet
    replay = _refreshed(estimator, motion) if shown else estimator.replay(motion)
    rows = judged(replay.parameters, notes, identified=batch is not None)
    if live:
        _show(known, replay, port)
    if plot is not None and kind is not None:
        _draw(replay, plot, kind)
    if json:
        told = [asdict(row) for row in rows]
        print_json(parameters=told, latency_us=replay.latency_us, samples=len(motion))
    elif not quiet:
        print_notes(console(), notes)
        _print(replay, rows)


def _refreshed(estimator: FootEstimator, log: MotionLog) -> Replay:
    """The log replayed under a table that shows what is known so far."""
    from rich.live import Live

    shown = 0.0
    with Live(console=console(), auto_refresh=False, transient=True) as screen:
        for replay in estimator.replay_in_pieces(log, PIECE):
            if time.monotonic() - shown > REFRESH:
                screen.update(_so_far(replay), refresh=True)
                shown = time.monotonic()
    return replay


def _so_far(replay: Replay) -> Table:
    """Small enough to stand still on a screen."""
    heads = ("foot", "axis", "mrad", "K [N.m/rad]", "95 %", "C [N.m.s/rad]", "95 %", "flags now")
    rows = []
    for foot in replay.feet:
        now = replay.estimate(foot)
        said = ", ".join(flag.name for flag in Flag if flag in now.flags and flag.name)
        for axis, one in zip(ROTATIONAL_AXES, (now.pitch, now.roll), strict=True):
            numbers = [f"{1e3 * one.deflection:.2f}"]
            for found in (one.stiffness, one.damping):
                known = found.half_width < UNKNOWN * abs(found.value)
                value, half = (found.value, found.half_width) if known else (None, None)
                numbers += [number(value), _plain(half)]
            rows.append((foot, axis, *numbers, said if axis == "pitch" else ""))
    return table(f"At {replay.time[-1]:.1f} s", heads, rows)


def _kind(plot: Path) -> Format:
    for kind in KINDS:
        if plot.suffix == f".{kind}":
            return kind
    raise SettingsError(
        f"plot '{plot}': no picture of this kind (valid: {', '.join(f'.{kind}' for kind in KINDS)})"
    )


def _draw(replay: Replay, plot: Path, kind: Format) -> None:
    from plantar.report.figures.plots import save
    from plantar.report.figures.replay import replay_picture

    save(replay_picture(replay), plot.parent, plot.stem, (kind,))


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


def _known(rows: Sequence[Parameter], title: str) -> Table:
    heads = ("foot", "axis", "parameter", "value", "95 %", "unit", "verdict")
    cells = [
        (row.foot, row.axis, row.name, number(row.value), _plain(row.half_width), row.unit, row.verdict)
        for row in rows
    ]
    return table(title, heads, cells, [VERDICT_STYLE[row.verdict] for row in rows])


def _plain(half: float | None) -> str:
    """A half width to two digits, without a power of ten: it stands beside its value."""
    return "–" if half is None else f"± {float(f'{half:.2g}'):.15g}"


def _print(replay: Replay, rows: Sequence[Parameter]) -> None:
    out = console()
    out.print(_known(rows, "At the end of the log"))
    print_advice(out, rows)
    through = ("foot", "stands %", "pitch mrad rms", "roll mrad rms", "flags, % of the samples")
    out.print(table("Through the log", through, [_foot_row(replay, foot) for foot in replay.feet]))
    out.print(f"“{ONLINE}” in plantar's documentation says what each flag means.")
    took = replay.latency_us
    median, p999, longest = (f"{took[key]:.1f} µs" for key in ("median", "p999", "max"))
    out.print(f"a step: median {median}, 99.9 % {p999}, longest {longest}")


def _foot_row(replay: Replay, foot: str) -> tuple[str, ...]:
    stands = replay.stands(foot)
    flags = replay.column(foot, "flags").astype(int)
    shares = ((flag, float((flags & flag > 0).mean())) for flag in Flag)
    said = ", ".join(f"{flag.name} {100 * share:.1f}" for flag, share in shares if share and flag.name)
    swings = (1e3 * replay.column(foot, f"{axis}.deflection")[stands] for axis in ("pitch", "roll"))
    return foot, f"{100 * stands.mean():.1f}", *(f"{x.std():.2f}" if x.size else "–" for x in swings), said
