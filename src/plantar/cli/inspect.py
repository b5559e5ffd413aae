"""`plantar inspect`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.markup import escape
from typer import Argument, Option

from plantar.cli.console import options
from plantar.cli.console.terminal import (
    SEVERITY_STYLE,
    VERDICT_STYLE,
    console,
    end_progress,
    print_json,
    progress,
    table,
)
from plantar.errors import LogError
from plantar.inspection import LogSummary, inspect_log
from plantar.logs.readers import open_log
from plantar.notes import NAMED, Finding, Note
from plantar.results.feet_text import ASSUMPTION_HEADS, assumption_cells
from plantar.results.numbers import number
from plantar.robot.model import load_robot


def run(
    robot: options.Robot,
    logs: Annotated[list[Path], Argument(help="Logs to look at.", metavar="LOG...")],
    columns: Annotated[bool, Option("--columns", help="Also the range of every column.")] = False,
    memory: options.Memory = None,
    json: options.Json = False,
    quiet: Annotated[
        bool, Option("--quiet", "-q", help="Only the exit code: 1 where a log cannot be used.")
    ] = False,
) -> None:
    """What is in the logs, what is wrong with them, and what each can identify by itself.

    Example: plantar inspect talos.yaml sway_1.csv, or for scripts: plantar inspect talos.yaml sway_1.csv --json
    """
    step = progress(quiet)
    loaded = load_robot(robot)
    summaries, unread = list[LogSummary](), list[LogError]()
    for path in logs:
        step(f"inspect {path.name}")
        try:
            log = open_log(path, loaded, memory=memory)
        except LogError as error:  # says nothing of the other logs
            unread.append(error)
            continue
        summaries.append(inspect_log(loaded, log))
    end_progress(quiet)
    if json:
        print_json(schema="plantar.inspect/1", logs=[summary.to_dict() for summary in summaries])
    elif not quiet:
        for summary in summaries:
            _print(console(), summary, columns, "URDF" if loaded.weighed is None else "robot, as weighed,")
        if not loaded.feet:
            console().print(
                f"{escape(robot.name)} names no feet: `plantar identify joints` is for such a robot"
            )
    if unread:
        raise unread[0] if len(unread) == 1 else LogError("; ".join(map(str, unread)))
    if any(finding.fatal for summary in summaries for finding in summary.findings):
        raise typer.Exit(1)


def _print(out: Console, log: LogSummary, columns: bool, weighs: str) -> None:
    sampling = log.sampling
    out.print(
        f"\n[bold]{escape(log.name)}[/]: {log.duration:.1f} s, {log.samples} samples at {sampling.rate:.4g} Hz, "
        f"jitter {round(1e3 * sampling.jitter, 6):.2g} ms, {len(sampling.gaps)} gaps, {len(log.columns)} columns"
    )
    for start, end in sampling.gaps[:5]:
        out.print(f"  gap from {start:.3f} to {end:.3f} s")
    holes = [column for column in log.columns if column.missing]
    for column in holes[:5]:
        out.print(f"  {escape(column.name)}: {column.missing} samples without a value")
    if log.carried is not None:
        out.print(
            f"  the feet carry {log.carried:.2f} kg on average{_as_recorded(log)}; the {weighs} "
            f"weighs {log.mass:.2f} kg"
        )
    alike: dict[tuple[str, bool], list[Finding]] = {}
    for finding in log.findings:
        alike.setdefault((finding.code, finding.fatal), []).append(finding)
    for (_, fatal), (first, *others) in sorted(alike.items(), key=lambda entry: not entry[0][1]):
        style, kind = ("red", "problem") if fatal else (SEVERITY_STYLE[first.severity], first.severity)
        for finding in (first, *others[: NAMED - 1]):
            out.print(f"  [{style}]{kind}[/]: {escape(finding.text)}")
        if len(others) >= NAMED:
            out.print(f"  and {len(others) + 1 - NAMED} more like these; --json has all")
    if log.feet:
        out.print(table("Feet", ("foot", "both stand s", "alone s", "load N", "used s", "pitch deg rms", "roll deg rms",
                                 "pitch rad/s rms", "roll rad/s rms"), _foot_rows(log)))  # fmt: skip
    told = {f"{of}{finding.text}" for finding in log.findings for of in ("", f"{log.name}: ")}
    warnings = [note for note in log.notes if note.severity == "warning" and note.text not in told]
    _print_notes(out, warnings)
    if log.parameters:
        heads = ("foot", "axis", "parameter", "value", "verdict", "reason")
        above = ["", *(row.reason for row in log.parameters)]
        rows = [
            (p.foot, p.axis, p.name, number(p.value), p.verdict, "as above" if p.reason == last else p.reason)
            for p, last in zip(log.parameters, above, strict=False)
        ]
        styles = [VERDICT_STYLE[p.verdict] for p in log.parameters]
        out.print(table("What this log identifies, in SI units", heads, rows, styles))
    if allowed := assumption_cells(log.assumptions):
        out.print(table("What the robot file may be wrong about", ASSUMPTION_HEADS, allowed))
    if columns:
        ranges = [(c.name, number(c.least), number(c.largest), str(c.missing)) for c in log.columns]
        out.print(table("Columns", ("column", "least", "largest", "missing"), ranges))
    _print_notes(out, [note for note in log.notes if note.severity != "warning"])


def _as_recorded(log: LogSummary) -> str:
    """Whether zeros of force sensors stand in what the feet carry."""
    off = any(finding.code == "air_reading" for finding in log.findings)
    return " as recorded, zeros of the force sensors included" if off else ""


def _print_notes(out: Console, notes: Sequence[Note]) -> None:
    for note in notes:
        out.print(f"  [{SEVERITY_STYLE[note.severity]}]{note.severity}: {escape(note.text)}[/]")


def _foot_rows(log: LogSummary) -> list[tuple[str, ...]]:
    return [
        (foot.foot, f"{foot.double:.1f}", f"{foot.single:.1f}", f"{foot.load:.0f}", f"{foot.serving:.1f}",
         *(f"{np.degrees(foot.deflection_rms[axis]):.2f}" for axis in ("pitch", "roll")),
         *(f"{foot.rate_rms[axis]:.3f}" for axis in ("pitch", "roll")))
        for foot in log.feet
    ]  # fmt: skip
