"""A feet result on the terminal: tables like the paper's 1 to 3, then the notes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from plantar.cli.console.terminal import VERDICT_STYLE, print_notes, table
from plantar.notes import listing
from plantar.pages import on_feet
from plantar.results.feet import FeetResult, Parameter, ValidationRow, Verdict
from plantar.results.feet_text import over_all_motions
from plantar.results.numbers import MISSING, number

if TYPE_CHECKING:
    from rich.console import Console


LOST = "no better than the offset alone"
NARROW = 112  # columns that table 1 takes in full
MOST_ROWS = 12  # of a table of errors: three motions of two feet; of more, the mean over the motions
REMARK_LINES = 4  # of notes that are no warnings; the result has all


def print_feet(out: Console, result: FeetResult) -> None:
    """Warnings about the logs, parameters, reasons where one is not usable, validation, other notes: some fifty lines
    however many logs there are; report.html has the rest."""
    from rich.markup import escape  # what prints nothing does not import it

    warnings = [note for note in result.notes if note.severity == "warning"]
    if warnings:
        print_notes(out, warnings)
        out.print()
    out.print(parameter_table(result, narrow=out.width < NARROW))
    print_advice(out, result.parameters)
    if further := on_feet(row.verdict for row in result.parameters):
        out.print(escape(further))
    for kind, title in (("direct", "Table 2. Direct validation"), ("cross", "Table 3. Cross validation")):
        rows = [row for row in result.validation if row.kind == kind]
        if rows:
            out.print()
            if len(rows) <= MOST_ROWS:
                out.print(validation_table(title, rows))
            else:
                out.print(_summary_table(title, rows))
                out.print("[dim]over all motions; each of them stands in report.html[/]")
    print_notes(out, [note for note in result.notes if note.severity != "warning"], REMARK_LINES)


def parameter_table(result: FeetResult, *, narrow: bool) -> object:
    """Table 1 with intervals and verdicts; a narrow one without the two deviations, so that no word is cut."""
    heads = ("foot", "axis", "parameter", "value", "unit", "95 % interval", "std", "white std %", "verdict")
    kept = [place for place, head in enumerate(heads) if not (narrow and head in ("std", "white std %"))]
    rows = [_parameter_cells(row) for row in result.parameters]
    return table(
        f"Table 1. Feet of {result.robot} ({result.model}, offset {result.settings.get('offset', '')})",
        [heads[place] for place in kept],
        [[row[place] for place in kept] for row in rows],
        [VERDICT_STYLE[row.verdict] for row in result.parameters],
    )


def _parameter_cells(row: Parameter) -> tuple[str, ...]:
    interval = " to ".join(number(bound, 5) for bound in row.interval95) if row.interval95 else MISSING
    return (row.foot, row.axis, row.name, number(row.value, 5), row.unit, interval, number(row.std, 3),
            number(row.relative_std_percent, 2), row.verdict)  # fmt: skip


def validation_table(title: str, rows: list[ValidationRow]) -> object:
    """Mean errors beside the trivial predictor's; a row that does not beat it is marked."""
    return _error_table(title, "motion", [(row.motion, row, "" if row.has_skill else LOST) for row in rows])


def _summary_table(title: str, rows: list[ValidationRow]) -> object:
    """The same of each foot and axis over all motions, those named that the offset alone predicts as well."""
    merged = over_all_motions(rows)
    lines = [(str(count), row, f"{LOST}: {listing(lost, 3)}" if lost else "") for row, count, lost in merged]
    return _error_table(title, "motions", lines)


def _error_table(title: str, what: str, rows: list[tuple[str, ValidationRow, str]]) -> object:
    cells = [
        (name, row.foot, row.axis, number(row.mean_abs_error, 3), number(row.rms_error, 3), number(row.max_abs),
         number(row.percent_of_max, 3), number(row.zero_mean_abs, 3), lost)
        for name, row, lost in rows
    ]  # fmt: skip
    columns = (what, "foot", "axis", "mean |error|", "rms", "max |torque|", "% of max", "offset alone", "")
    return table(f"{title} [N·m]", columns, cells, ["yellow" if lost else "" for *_, lost in rows])


def print_advice(out: Console, parameters: Sequence[Parameter]) -> None:
    """Why numbers are not usable and what to record next, a line for those that are alike."""
    from rich.markup import escape

    for verdict, names, rest in advised(parameters):
        out.print(f"[{VERDICT_STYLE[verdict]}]{names}: {verdict}[/]: {escape(rest)}")


def advised(parameters: Sequence[Parameter]) -> Iterator[tuple[Verdict, str, str]]:
    """Verdict, names and the rest of the line for numbers that are not usable; those with the same reason share a line,
    and advice that was given is not repeated but named by whom it was given to."""
    alike: dict[tuple[Verdict, str, str], list[str]] = {}
    for row in parameters:
        if row.verdict != "usable":
            name = f"{row.foot} {row.axis} {row.name}"
            alike.setdefault((row.verdict, row.reason, row.advice or ""), []).append(name)
    given: dict[str, str] = {}
    for (verdict, reason, advice), names in alike.items():
        said = f"as for {given[advice]}" if advice in given else advice
        given.setdefault(advice, names[0])
        yield verdict, ", ".join(names), f"{reason}. Next: {said}." if advice else f"{reason}."
