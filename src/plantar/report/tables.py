"""The tables of a feet report: the paper's table 1 to 3 with what they leave out beside them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import Any

from plantar.contact.phases import Phase
from plantar.conventions import NORMAL95
from plantar.report.content import Cell, Column, Mark, Table
from plantar.report.verdict import MARKS, symbol
from plantar.results import feet_text
from plantar.results.dynamics import DynamicsScore, JointParameter
from plantar.results.feet import Assumption, Comparison, FeetResult, Input, Offset, Parameter, ValidationRow
from plantar.results.numbers import MISSING, interval, number, percent, unit, with_uncertainty
from plantar.results.reference import neighbours
from plantar.results.usage import used_shares

SETTING_UNITS = {"cutoff": "Hz", "edge_margin": "m", "window": "rad", "wrench_delay": "s"}


def parameter_table(parameters: Sequence[Parameter]) -> Table:
    """Table 1: every parameter with its deviation, interval and verdict."""
    rows = [
        (row.foot, row.axis, Cell(symbol(row.name), hover=row.name), unit(row.unit), _value_cell(row),
         number(row.std, 2), interval(row.interval95), percent(row.relative_std_percent), verdict_cell(row))
        for row in parameters
    ]  # fmt: skip
    columns = Column.words("foot", "axis", "parameter", "unit")
    columns += map(Column, ("value", "std", "95 % interval", "relative std, as in the paper"))
    columns += Column.words("verdict")
    remark = (
        "Trust std and the interval: they allow for autocorrelated residuals. The "
        "paper's relative deviation takes residuals for white noise and is far too small; here to compare. "
        "A value in brackets is unidentifiable: not to be used."
    )
    return Table.of("Table 1. Identified parameters", columns, rows, remark=remark)


def _value_cell(row: Parameter) -> Cell:
    """The value; in brackets where nobody may use it."""
    if row.value is None or row.verdict != "unidentifiable":
        return Cell(number(row.value))
    return Cell(f"({number(row.value)})", hover="unidentifiable: not to be used")


def verdict_cell(row: Parameter | JointParameter) -> Cell:
    return Cell(row.verdict, MARKS[row.verdict], row.reason)


def neighbour_table(parameters: Sequence[Parameter]) -> Table:
    """The result's feet among published and configured ones, softest first."""
    rows: list[list[Cell | str]] = []
    for line in neighbours(parameters):
        one = line.reference
        given = [
            MISSING if value is None else f"{value:.4g}"
            for value in (one.pitch, one.roll, one.z, one.damping)
        ]
        mark: Mark = "good" if line.own else ""
        rows.append([Cell(one.robot, mark), *given, one.origin, one.source])
    columns = [*Column.words("robot"), Column("pitch", unit("N.m/rad")), Column("roll", unit("N.m/rad"))]
    columns += [Column("z", unit("N/m")), Column("C", unit("N.m.s/rad")), *Column.words("", "source")]
    remark = (
        "Most were configured and never measured: they show a likely size, no more. 1e8 stands for rigid."
    )
    return Table.of("Foot stiffness elsewhere", columns, rows, remark=remark, folded=True)


def assumption_table(rows: Sequence[Assumption]) -> Table:
    """What the robot file allows for, and what was found of it."""
    columns = Column.words(*feet_text.ASSUMPTION_HEADS)
    remark = (
        "Std is the deviation under uncertainty: in the robot file. The last columns: the 95 % interval of K and C if "
        "nothing else were wrong, of the axis where it is widest. Write what you know better into the robot file."
    )
    return Table.of(
        "What the robot file may be wrong about", columns, feet_text.assumption_cells(rows), remark=remark
    )


def offset_table(offsets: Sequence[Offset]) -> Table:
    """Offsets, one line a motion, a column for each foot and axis."""
    keys = list(dict.fromkeys((row.foot, row.axis, row.unit) for row in offsets))
    found = {(row.motion, row.foot, row.axis): row for row in offsets}
    rows: list[list[Cell | str]] = []
    for motion in dict.fromkeys(row.motion for row in offsets):
        line: list[Cell | str] = [motion]
        for foot, axis, _ in keys:
            row = found.get((motion, foot, axis))
            half = None if row is None or row.std is None else NORMAL95 * row.std
            line.append(MISSING if row is None else with_uncertainty(row.value, half))
        rows.append(line)
    columns = Column.words("motion")
    columns += [Column(f"{foot} {axis}", unit(name)) for foot, axis, name in keys]
    remark = "Zeros of sensors in each recording, not a property of the foot; ± is half of the 95 % interval."
    return Table.of("Offsets of each motion", columns, rows, remark=remark)


def validation_table(validation: Sequence[ValidationRow], kind: str) -> Table:
    """Table 2 (`direct`) or table 3 (`cross`), the trivial predictor beside the model."""
    rows = [
        (row.motion, row.foot, "z [N]" if row.axis == "z" else row.axis, number(row.mean_abs_error, 3),
         number(row.rms_error, 3), number(row.max_abs, 3), percent(row.percent_of_max), number(row.zero_mean_abs, 3),
         skill_cell(row))
        for row in validation
        if row.kind == kind
    ]  # fmt: skip
    columns = [
        *Column.words("motion", "foot", "axis"),
        Column("mean |error|", "N·m"),
        Column("rms error", "N·m"),
    ]
    columns += [Column("largest |torque|", "N·m"), Column("mean |error| of largest")]
    columns += [Column("mean |error| of the offset alone", "N·m"), *Column.words("skill")]
    title = {
        "direct": "Table 2. Direct validation: the motions used for the fit",
        "cross": "Table 3. Cross-validation: motions that the fit has not seen",
    }[kind]
    remark = (
        "Where the model does not beat its own offset, either it has learnt nothing or the motion hardly bends the "
        "foot: then the offset's error is small, too."
    )
    if kind == "cross":
        remark += (
            " The unseen motion's offset comes from its first second, which is left out of the score; where a foot "
            "steps, each stance has an offset of its own, for the model and for the offset alone alike."
        )
    return Table.of(title, columns, rows, remark=remark)


def skill_cell(row: ValidationRow | DynamicsScore) -> Cell:
    """How much smaller the error is than the trivial predictor's."""
    if not (row.zero_mean_abs > 0 and row.mean_abs_error >= 0):
        return Cell(MISSING)
    share = 100 * (1 - row.mean_abs_error / row.zero_mean_abs)
    if not row.has_skill:
        return Cell("none", "bad", "the trivial predictor does as well or better")
    return Cell(f"{share:.0f} % better", "good" if share >= 50 else "weak")


def comparison_tables(result: FeetResult) -> list[Table]:
    """For each comparison its parameters and its errors beside the result's."""
    return [table for other in result.comparisons for table in _comparison(result, other)]


def _comparison(result: FeetResult, other: Comparison) -> list[Table]:
    theirs = {(row.foot, row.axis, row.name): row for row in other.parameters}
    rows = []
    for ours in result.parameters:
        row = theirs.get((ours.foot, ours.axis, ours.name))
        if row is None:
            continue
        change = (
            100 * (row.value - ours.value) / abs(ours.value) if row.value is not None and ours.value else None
        )
        text = with_uncertainty(ours.value, ours.half_width)
        against = with_uncertainty(row.value, row.half_width)
        signed = MISSING if change is None else f"{change:+.1f} %".replace("-", "−")
        rows.append((ours.foot, ours.axis, symbol(ours.name), unit(ours.unit), text, against, signed))
    columns = Column.words("foot", "axis", "parameter", "unit")
    columns += [Column("this result"), Column(other.name), Column("difference")]
    tables = [Table.of(f"Compared: {other.name}, parameters", columns, rows)] if rows else []
    scores = {(row.kind, row.motion, row.foot, row.axis): row for row in other.validation}
    lines = []
    for score in result.validation:
        match = scores.get((score.kind, score.motion, score.foot, score.axis))
        if match is not None:
            ours_text, theirs_text = number(score.mean_abs_error, 3), number(match.mean_abs_error, 3)
            offset = number(score.zero_mean_abs, 3)
            lines.append((score.kind, score.motion, score.foot, score.axis, ours_text, theirs_text, offset))
    heads = Column.words("kind", "motion", "foot", "axis")
    heads += [Column(name, "N·m") for name in ("this result", other.name, "offset alone")]
    if lines:
        tables.append(Table.of(f"Compared: {other.name}, mean |error|", heads, lines, folded=len(lines) > 24))
    return tables


def used_table(phases: Sequence[Phase]) -> Table:
    """How much of each log is used, and for what reasons the rest is not."""
    rows = []
    for one in used_shares(phases):
        share = percent(100 * one.used / one.seconds) if one.seconds > 0 else MISSING
        lengths = (number(one.seconds, 3), number(one.used, 3), share)
        rows.append((one.motion, one.foot, *lengths, one.reasons or "nothing left out"))
    columns = [*Column.words("motion", "foot"), Column("length", "s"), Column("used", "s"), Column("share")]
    columns += Column.words("left out because")
    remark = "The bars of each motion, below, say where and why in full."
    return Table.of("What is used of each log", columns, rows, remark=remark)


def input_table(inputs: Sequence[Input]) -> Table:
    columns = Column.words("file", "role", "SHA-256")
    rows = [
        (Cell(PurePath(row.path).name, hover=row.path), row.role, row.sha256 or MISSING) for row in inputs
    ]
    return Table.of("Inputs", columns, rows)


def settings_table(settings: Mapping[str, Any]) -> Table:
    """Settings with nested ones as `outer.inner`, and the units of those that have one."""
    rows = [(key, f"{text} {SETTING_UNITS.get(key, '')}".rstrip()) for key, text in _flat(settings, "")]
    return Table.of("Settings", Column.words("setting", "value"), rows)


def _text(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(map(_text, value))
    if isinstance(value, float):
        return number(value)
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _flat(settings: Mapping[str, Any], prefix: str, depth: int = 0) -> list[tuple[str, str]]:
    lines: list[tuple[str, str]] = []
    for key, value in settings.items():
        if isinstance(value, Mapping) and value and depth < 4:
            lines += _flat(value, f"{prefix}{key}.", depth + 1)
        else:
            lines.append((f"{prefix}{key}", _text(value)))
    return lines
