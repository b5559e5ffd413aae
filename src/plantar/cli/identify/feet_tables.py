"""A feet result on the terminal: tables like the paper's 1 to 3, then the notes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from plantar.cli.console.advice import advised
from plantar.cli.console.terminal import VERDICT_STYLE, number, print_notes, table
from plantar.pages import on_feet
from plantar.results.feet import FeetResult, Parameter, ValidationRow

if TYPE_CHECKING:
    from rich.console import Console


def print_feet(out: Console, result: FeetResult) -> None:
    """Warnings about the logs, parameters, reasons where one is not usable, validation, other notes."""
    from rich.markup import escape  # what prints nothing does not import it

    warnings = [note for note in result.notes if note.severity == "warning"]
    if warnings:
        print_notes(out, warnings)
        out.print()
    out.print(parameter_table(result))
    for verdict, names, rest in advised(result.parameters):
        out.print(f"[{VERDICT_STYLE[verdict]}]{names}: {verdict}[/]: {escape(rest)}")
    if further := on_feet(row.verdict for row in result.parameters):
        out.print(escape(further))
    for kind, title in (("direct", "Table 2. Direct validation"), ("cross", "Table 3. Cross validation")):
        rows = [row for row in result.validation if row.kind == kind]
        if rows:
            out.print()
            out.print(validation_table(title, rows))
    print_notes(out, [note for note in result.notes if note.severity != "warning"])


def parameter_table(result: FeetResult) -> object:
    """Table 1 with intervals and verdicts."""
    return table(
        f"Table 1. Feet of {result.robot} ({result.model}, offset {result.settings.get('offset', '')})",
        ("foot", "axis", "parameter", "value", "unit", "95 % interval", "std", "white std %", "verdict"),
        [_parameter_cells(row) for row in result.parameters],
        [VERDICT_STYLE[row.verdict] for row in result.parameters],
    )


def _parameter_cells(row: Parameter) -> tuple[str, ...]:
    interval = f"{row.interval95[0]:.5g} to {row.interval95[1]:.5g}" if row.interval95 else "–"
    return (row.foot, row.axis, row.name, number(row.value, 5), row.unit, interval, number(row.std, 3),
            number(row.relative_std_percent, 2), row.verdict)  # fmt: skip


def validation_table(title: str, rows: list[ValidationRow]) -> object:
    """Mean errors beside the trivial predictor's; a row that does not beat it is marked."""
    lost = [row.mean_abs_error >= row.zero_mean_abs for row in rows]
    cells = [
        (row.motion, row.foot, row.axis, number(row.mean_abs_error, 3), number(row.rms_error, 3), number(row.max_abs),
         number(row.percent_of_max, 3), number(row.zero_mean_abs, 3), "no better than the offset alone" if bad else "")
        for row, bad in zip(rows, lost, strict=True)
    ]  # fmt: skip
    columns = (
        "motion",
        "foot",
        "axis",
        "mean |error|",
        "rms",
        "max |torque|",
        "% of max",
        "offset alone",
        "",
    )
    return table(f"{title} [N·m]", columns, cells, ["yellow" if bad else "" for bad in lost])
