"""Numbers in the tables of a page, by hand: each under its own head."""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from types import SimpleNamespace

import pytest

from plantar.report.content import Table
from plantar.report.dynamics import _inertia, _joints, _prediction
from plantar.report.fleet import _effects, _level_cell, _trends, _verdict
from plantar.report.tables import offset_table, parameter_table, skill_cell, validation_table
from plantar.results.dynamics_rows import BaseParameter, InertialParameter, JointParameter
from plantar.results.feet_rows import Offset, Parameter, ValidationRow
from plantar.results.numbers import MISSING


def texts(table: Table) -> list[list[str]]:
    return [[cell.text for cell in row] for row in table.rows]


def heads(table: Table) -> list[str]:
    return [
        f"{column.heading} [{column.unit}]" if column.unit else column.heading for column in table.columns
    ]


def test_parameters() -> None:
    rows = [
        Parameter("left", "pitch", "stiffness", "N.m/rad", 434.02, 0.16, (433.7, 434.34), 0.0125, "usable", "narrow"),
        Parameter("left", "roll", "damping", "N.m.s/rad", 3.0, 4.0, (-5.0, 11.0), 9.0, "unidentifiable", "wide"),
    ]  # fmt: skip
    assert texts(parameter_table(rows)) == [
        ["left", "pitch", "K", "N·m/rad", "434.0", "0.16", "433.7 to 434.3", "0.013 %", "usable"],
        ["left", "roll", "C", "N·m·s/rad", "(3.000)", "4.0", "−5 to 11", "9.0 %", "unidentifiable"],
    ]


def test_offsets_stand_by_motion_with_half_of_their_interval() -> None:
    rows = [
        Offset("left", "pitch", "a", "N.m", 1.5, 0.1),
        Offset("right", "roll", "a", "N.m", -2.0, 0.5),
        Offset("left", "pitch", "b", "N.m", 0.25, 0.01),
    ]
    table = offset_table(rows)
    assert heads(table) == ["motion", "left pitch [N·m]", "right roll [N·m]"]
    assert texts(table) == [["a", "1.50 ± 0.20", "−2.0 ± 1.0"], ["b", "0.250 ± 0.020", "–"]]


def test_scores_and_how_much_better_than_nothing() -> None:
    row = ValidationRow("cross", "squat", "left", "pitch", 0.5, 0.75, 20.0, 2.5, 2.0, 100)
    lost = ValidationRow("cross", "still", "left", "roll", 2.0, 2.5, 8.0, 25.0, 2.0, 100)
    seen = ValidationRow("direct", "sway", "left", "roll", 1.0, 1.5, 8.0, 12.5, 1.5, 100)
    assert texts(validation_table([row, lost, seen], "cross")) == [
        ["squat", "left", "pitch", "0.500", "0.750", "20.0", "2.5 %", "2.00", "75 % better"],
        ["still", "left", "roll", "2.00", "2.50", "8.00", "25 %", "2.00", "none"],
    ]
    assert [skill_cell(one).mark for one in (row, lost, seen)] == ["good", "bad", "weak"]
    half = ValidationRow("cross", "sway", "left", "roll", 1.0, 1.5, 8.0, 12.5, 2.0, 100)
    unknown = [replace(half, zero_mean_abs=0.0), replace(half, mean_abs_error=float("nan"))]
    assert [skill_cell(one).mark for one in (half, replace(half, mean_abs_error=1.01))] == ["good", "weak"]
    assert [(skill_cell(one).text, skill_cell(one).mark) for one in unknown] == [(MISSING, "")] * 2


def test_inertias_beside_the_cads() -> None:
    result = SimpleNamespace(
        base_parameters=(BaseParameter("m1 + m2", -4.0, 0.5, (-5.0, -3.0), 12.5),),
        inertial_parameters=(InertialParameter("leg", "m", "kg", 3.5, 3.0),),
    )
    base, inertial = _inertia(result)  # type: ignore[arg-type]
    assert texts(base) == [["m1 + m2", "−4.0 ± 1.0", "0.50", "12 %"]]
    assert texts(inertial) == [["leg", "m", "kg", "3.500", "3.000", "0.500"]], (
        "the identified less the URDF's"
    )


def test_terms_of_joints() -> None:
    row = JointParameter("knee", "viscous", "N.m.s/rad", 3.0, 0.1, (2.8, 3.2), "usable", "narrow")
    scores = tuple(
        SimpleNamespace(has_skill=skill, rms_error=1.0, cad_rms_error=by_urdf)
        for skill, by_urdf in ((True, 2.0), (False, 1.0), (True, 0.5))
    )
    result = SimpleNamespace(parameters=(row,), validation=scores)
    expected = ["knee", "viscous", "N·m·s/rad", "3.000", "0.10", "2.80 to 3.20", "usable", "narrow"]
    assert texts(_joints(result)) == [expected]  # type: ignore[arg-type]
    assert _prediction(result) == [  # type: ignore[arg-type]
        "The model predicts better than the mean alone in 2 of 3 rows of the validation, "
        "better than the URDF alone in 1."
    ]


def test_a_fleets_levels_effects_and_trends() -> None:
    level = SimpleNamespace(
        unit="r1", foot="left", axis="pitch", name="stiffness", unit_of_value="N.m/rad", value=400.0, low=398.0,
        high=402.0, sure_low=392.0, sure_high=408.0, recordings=12, since=date(2026, 1, 2), trend=-1.25,
        trend_low=-2.5, trend_high=0.5,
    )  # fmt: skip
    cell = _level_cell(level)  # type: ignore[arg-type]
    assert cell.text == "400.0 ± 8.0"
    assert cell.hover == "mean of 12 recordings; as days scatter 398.0 to 402.0"
    effect = SimpleNamespace(
        foot="left", axis="pitch", name="stiffness", unit_of_value="N.m/rad", value=400.0, low=390.0, high=410.0,
        units=3, recordings=36, recordings_percent=0.5, days_percent=None, units_percent=2.25,
    )  # fmt: skip
    summary = SimpleNamespace(effects=(effect,), levels=(level,), failures=(), groups=36, alarms=())
    (row,) = texts(_effects(summary))  # type: ignore[arg-type]
    assert row[4:] == ["400.0", "390.0 to 410.0", "3", "36", "0.5", "–", "2.2"]
    (row,) = texts(_trends(summary))  # type: ignore[arg-type]
    assert row == ["r1", "left", "pitch", "stiffness", "2026-01-02", "−1.2", "−2.5 to 0.5"]
    first, last = _verdict(summary, 3, {"done": 20, "seconds": 10.0, "reused": 4})  # type: ignore[arg-type]
    assert first == "36 groups of 3 robots; 0 failures; 0 alarms."
    assert last == "The last run computed 20 groups in 10.0 s (7200 groups an hour); 4 were there already."


@pytest.mark.parametrize("kind", ["direct", "cross"])
def test_each_table_has_its_own_scores(kind: str) -> None:
    rows = [
        ValidationRow(each, each, "left", "pitch", 0.5, 0.75, 20.0, 2.5, 2.0, 100)
        for each in ("direct", "cross")
    ]
    assert [row[0] for row in texts(validation_table(rows, kind))] == [kind]
