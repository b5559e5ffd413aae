"""Numbers in print, by value, and the units over them."""

from __future__ import annotations

import math

import pytest

from plantar.report.tables import offset_table, parameter_table, settings_table, validation_table
from plantar.report.verdict import statement
from plantar.results.feet import Offset, Parameter, ValidationRow


def test_an_offsets_plus_minus_is_half_of_the_95_percent_interval() -> None:
    table = offset_table([
        Offset(foot="left", axis="pitch", motion="tilt", unit="N.m", value=-1.5, std=0.1),
        Offset(foot="left", axis="roll", motion="tilt", unit="N.m", value=0.25, std=math.nan),
    ])  # fmt: skip
    assert [(column.heading, column.unit) for column in table.columns[1:]] == [
        ("left pitch", "N·m"),
        ("left roll", "N·m"),
    ]
    assert [cell.text for cell in table.rows[0]] == ["tilt", "−1.50 ± 0.20", "0.2500"]


@pytest.mark.parametrize("kind", ["direct", "cross"])
def test_errors_of_torques_stand_under_newton_metres(kind: str) -> None:
    row = ValidationRow(
        kind=kind, motion="squat", foot="right", axis="roll", mean_abs_error=0.125, rms_error=0.25, max_abs=16.5,
        percent_of_max=0.76, zero_mean_abs=0.5, samples=400,
    )  # fmt: skip
    table = validation_table([row], kind)
    shown = {
        column.heading: (cell.text, column.unit)
        for column, cell in zip(table.columns, table.rows[0], strict=True)
    }
    assert shown == {
        "motion": ("squat", ""),
        "foot": ("right", ""),
        "axis": ("roll", ""),
        "mean |error|": ("0.125", "N·m"),
        "rms error": ("0.250", "N·m"),
        "largest |torque|": ("16.5", "N·m"),
        "mean |error| of largest": ("0.76 %", ""),
        "mean |error| of the offset alone": ("0.500", "N·m"),
        "skill": ("75 % better", ""),
    }


def row(name: str, verdict: str) -> Parameter:
    return Parameter("left", "pitch", name, "", 59.2, 18.0, (22.6, 95.8), 7.0, verdict, "wide")  # type: ignore[arg-type]


def test_a_value_that_nobody_may_use_is_in_brackets() -> None:
    shown = [
        cells[4].text
        for cells in parameter_table([row("stiffness", "weak"), row("damping", "unidentifiable")]).rows
    ]
    assert shown == ["59.20", "(59.20)"]


def test_settings_are_rounded_and_have_units() -> None:
    table = settings_table(
        {"cutoff": 2.4607377956741168, "model": "auto", "nested": {"window": 0.5}, "wrench_delay": None}
    )
    shown = {cells[0].text: cells[1].text for cells in table.rows}
    assert shown["cutoff"] == "2.461 Hz"
    assert shown["model"] == "auto"
    assert shown["nested.window"] == "0.5000"


@pytest.mark.parametrize(
    ("verdicts", "mark"),
    [
        (("usable", "usable"), "good"),
        (("weak", "unidentifiable"), "weak"),
        (("unidentifiable", "unidentifiable"), "bad"),
    ],
)
def test_an_axis_is_red_where_neither_number_can_be_told(verdicts: tuple[str, str], mark: str) -> None:
    rows = [row(name, verdict) for name, verdict in zip(("stiffness", "damping"), verdicts, strict=True)]
    assert statement("left pitch", "pitch", rows, {}).mark == mark
