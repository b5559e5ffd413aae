"""The report of an inertia or joints identification (eq. 2 and 3): tables and notes."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Final

from plantar.files import write_text
from plantar.notes import kinds, listed
from plantar.pages import on_joints
from plantar.report.content import Cell, Column, Table
from plantar.report.page import render
from plantar.report.tables import input_table, settings_table, skill_cell, verdict_cell
from plantar.report.verdict import LEADS
from plantar.results.dynamics import JOINTS_SCHEMA, ONE_OF_MANY, DynamicsResult, DynamicsScore
from plantar.results.io import result_path
from plantar.results.numbers import interval, number, percent, unit, with_uncertainty

_HEADINGS: Final = {
    "kind": "kind",
    "motion": "motion",
    "joint": "joint",
    "axis": "axis",
    "unit": "unit",
    "mean_abs_error": "mean |error|",
    "rms_error": "rms error",
    "max_abs": "largest |value|",
    "percent_of_max": "mean |error| of largest [%]",
    "zero_mean_abs": "mean |error| of the mean alone",
    "cad_rms_error": "rms error by the URDF",
    "relative_error_percent": "relative error [%]",
}


def write_dynamics_report(result: str | os.PathLike[str], out: str | os.PathLike[str] | None = None) -> Path:
    """Write `report.html` for a `plantar.inertia/1` or `plantar.joints/1` result and return its path.

    `result` is `result.json` or its directory; the page is one file that needs no network. Raises
    `PlantarError` for a result that cannot be read.
    """
    path = result_path(result)
    read = DynamicsResult.load(path, beside=False)
    if read.schema == JOINTS_SCHEMA:
        subject, verdict, made = "Joint parameters", _joints_verdict(read), [_joints(read)]
    else:
        subject, verdict, made = "Inertial parameters", _inertia_verdict(read), _inertia(read)
    made += [_validation(read)] if read.validation else []
    page = render(
        "dynamics.html.j2",
        styles=["report.css"],
        title=f"{subject} of {read.robot}",
        result=read,
        warnings=kinds(read.notes, "warning"),
        notes=kinds(read.notes, "info"),
        verdict=verdict,
        tables=made,
        appendix=[input_table(read.inputs), settings_table(read.settings)],
    )
    target = Path(out) if out is not None else path.parent / "report.html"
    write_text(target, page)
    return target


def _inertia_verdict(result: DynamicsResult) -> list[str]:
    condition = number(result.condition_number, 2)
    text = f"The logs determine {result.rank} base parameters, with a condition number of {condition}."
    return [text, ONE_OF_MANY, *_prediction(result)]


def _joints_verdict(result: DynamicsResult) -> list[str]:
    sentences = []
    for verdict, lead in LEADS.items():
        rows = (row for row in result.parameters if row.verdict == verdict)
        names = [f"{row.joint} {row.name.replace('_', ' ')}" for row in rows]
        if names:
            shown = names if len(names) <= 8 else [*names[:7], f"{len(names) - 7} more"]
            sentences.append(f"{lead}: {listed(shown)}.")
    further = on_joints(row.verdict for row in result.parameters)
    return [*sentences, *_prediction(result), *([further] if further else [])]


def _prediction(result: DynamicsResult) -> list[str]:
    count = len(result.validation)
    if not count:
        return []
    better = sum(row.has_skill for row in result.validation)
    closer = sum(row.rms_error < row.cad_rms_error for row in result.validation)
    return [
        f"The model predicts better than the mean alone in {better} of {count} rows of the validation, "
        f"better than the URDF alone in {closer}."
    ]


def _inertia(result: DynamicsResult) -> list[Table]:
    base = [
        (row.expression, with_uncertainty(row.value, (row.interval95[1] - row.interval95[0]) / 2),
         number(row.std, 2), percent(row.relative_std_percent))
        for row in result.base_parameters
    ]  # fmt: skip
    base_columns = Column.words("expression")
    base_columns += map(Column, ("value ± half of its 95 % interval", "std", "relative std"))
    inertial = [
        (row.link, row.name, unit(row.unit), number(row.value), number(row.cad),
         number(row.value - row.cad, 3))
        for row in result.inertial_parameters
    ]  # fmt: skip
    columns = Column.words("link", "parameter", "unit")
    columns += [Column(name) for name in ("identified", "URDF", "difference")]
    return [
        Table.of("Base parameters", base_columns, base, folded=len(base) > 40),
        Table.of("Inertial parameters of each link", columns, inertial, folded=len(inertial) > 40),
    ]


def _joints(result: DynamicsResult) -> Table:
    rows = [
        (row.joint, row.name.replace("_", " "), unit(row.unit), number(row.value), number(row.std, 2),
         interval(row.interval95), verdict_cell(row), row.reason)
        for row in result.parameters
    ]  # fmt: skip
    columns = Column.words("joint", "parameter", "unit")
    columns += [Column(name) for name in ("value", "std", "95 % interval")]
    columns += Column.words("verdict", "why")
    return Table.of("Joint parameters", columns, rows)


def _validation(result: DynamicsResult) -> Table:
    """Every number that the rows bring, the known ones first: the URDF's errors stand beside the model's."""
    contents = [_content(row) for row in result.validation]
    present = dict.fromkeys(key for content in contents for key in content)
    keys = [key for key in _HEADINGS if key in present] + [key for key in present if key not in _HEADINGS]
    numeric = {key for key in keys if any(isinstance(content.get(key), float) for content in contents)}
    rows = []
    for row, content in zip(result.validation, contents, strict=True):
        cells = [Cell(_text(content.get(key))) for key in keys]
        rows.append([*cells, skill_cell(row)])
    columns = [Column(_HEADINGS.get(key, key.replace("_", " ")), numeric=key in numeric) for key in keys]
    return Table.of("Validation", [*columns, Column("skill", numeric=False)], rows)


def _content(row: DynamicsScore) -> dict[str, Any]:
    content = {key: float(value) if isinstance(value, int) else value for key, value in row.to_dict().items()}
    return content | {"unit": unit(row.unit)}


def _text(value: object) -> str:
    return number(value, 3) if isinstance(value, float) else "" if value is None else str(value)
