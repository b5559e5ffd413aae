"""Numbers in print, by value, and the units over them."""

from __future__ import annotations

import math

import pytest

from plantar.report.tables import offset_table, validation_table
from plantar.results.feet import Offset, ValidationRow


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
