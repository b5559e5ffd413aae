"""Tables of a page that stand beside table 1 to 3: every number by hand, every column with its unit."""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from pathlib import Path

import numpy as np
import pytest

from plantar.contact.phases import Phase
from plantar.fleet.alarms import alarm_of
from plantar.fleet.series import Days, Series, SeriesKey, by_day
from plantar.fleet.statistics.changes import Change
from plantar.fleet.summary import Effect, FleetSummary, Level, Reason
from plantar.notes import Note
from plantar.report.content import Table
from plantar.report.dynamics import (
    _inertia,
    _inertia_verdict,
    _joints_verdict,
    _validation,
    write_dynamics_report,
)
from plantar.report.fleet import _effects, _failures, _robots, _trends, _units
from plantar.report.tables import (
    comparison_tables,
    input_table,
    neighbour_table,
    offset_table,
    parameter_table,
    settings_table,
    used_table,
    validation_table,
)
from plantar.results.dynamics import INERTIA_SCHEMA, ONE_OF_MANY, DynamicsResult
from plantar.results.dynamics_rows import BaseParameter, DynamicsScore, InertialParameter, JointParameter
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Comparison, Input, Parameter, ValidationRow


def texts(table: Table) -> list[list[str]]:
    return [[cell.text for cell in row] for row in table.rows]


def heads(table: Table) -> list[str]:
    return [f"{one.heading} [{one.unit}]" if one.unit else one.heading for one in table.columns]


def test_what_is_used_of_each_log_adds_up_by_motion_and_foot() -> None:
    phases = [
        Phase("walk", "left", 0.0, 2.0, "double", True, None),
        Phase("walk", "left", 2.0, 3.5, "transition", False, "tips"),
        Phase("walk", "left", 3.5, 4.0, "transition", False, "tips"),
        Phase("walk", "left", 4.0, 8.0, "air", False, None),
        Phase("walk", "left", 8.0, 8.0, "single", False, "of one sample"),
        Phase("walk", "right", 0.0, 10.0, "single", True, None),
        Phase("sway", "left", 1.0, 6.0, "double", True, None),
        Phase("sway", "left", 6.0, 21.0, "double", False, "slides"),
        Phase("sway", "left", 21.0, 21.03, "transition", False, "a moment, which nobody reads"),
        Phase("still", "left", 2.0, 2.0, "double", True, None),
    ]
    table = used_table(phases)
    assert heads(table) == ["motion", "foot", "length [s]", "used [s]", "share", "left out because"]
    assert texts(table) == [
        ["walk", "left", "8.00", "2.00", "25 %", "tips (2.0 s); air (4.0 s)"],
        ["walk", "right", "10.0", "10.0", "100 %", "nothing left out"],
        ["sway", "left", "20.0", "5.00", "25 %", "slides (15.0 s)"],
        ["still", "left", "0", "0", "–", "nothing left out"],
    ]


K = Parameter("left", "pitch", "stiffness", "N.m/rad", 400.0, 4.0, (392.0, 408.0), 0.1, "usable", "narrow")
SCORE = ValidationRow("cross", "squat", "left", "pitch", 0.5, 0.75, 20.0, 2.5, 2.0, 100)
RESULT = FeetResult("b", (), {}, "kelvin_voigt", (K,), (), (), (SCORE,), ())


def test_another_choice_stands_beside_the_result() -> None:
    theirs = replace(K, value=320.0, interval95=(310.0, 330.0))
    others = (replace(SCORE, mean_abs_error=1.25, zero_mean_abs=9.0), replace(SCORE, motion="nobody's"))
    shared = Comparison("one offset", {}, (theirs, replace(theirs, foot="right")), others)
    alone = replace(SCORE, motion="told by nobody else")
    parameters, errors = comparison_tables(replace(RESULT, validation=(SCORE, alone), comparisons=(shared,)))
    assert heads(parameters)[3:] == ["unit", "this result", "one offset", "difference"]
    assert texts(parameters) == [["left", "pitch", "K", "N·m/rad", "400 ± 8", "320 ± 10", "−20.0 %"]]
    assert heads(errors)[4:] == ["this result [N·m]", "one offset [N·m]", "offset alone [N·m]"]
    assert texts(errors) == [["cross", "squat", "left", "pitch", "0.500", "1.25", "2.00"]]


def test_columns_say_their_units() -> None:
    assert heads(neighbour_table([]))[1:5] == [
        "pitch [N·m/rad]",
        "roll [N·m/rad]",
        "z [N/m]",
        "C [N·m·s/rad]",
    ]
    assert heads(validation_table([], "cross"))[3:] == [
        "mean |error| [N·m]", "rms error [N·m]", "largest |torque| [N·m]", "mean |error| of largest",
        "mean |error| of the offset alone [N·m]", "skill",
    ]  # fmt: skip
    assert heads(parameter_table([]))[4:] == [
        "value", "std", "95 % interval", "relative std, as in the paper", "verdict",
    ]  # fmt: skip
    assert heads(offset_table([])) == ["motion"]
    rows = validation_table([replace(SCORE, axis="z")], "cross").rows
    assert rows[0][2].text == "z [N]"


def test_inputs_and_settings_are_told_with_their_units() -> None:
    table = input_table([Input("a/walk.csv", "f00d", "fit"), Input("b/squat.csv", None, "validate")])
    assert texts(table) == [["walk.csv", "fit", "f00d"], ["squat.csv", "validate", "–"]]
    assert table.rows[0][0].hover == "a/walk.csv"
    settings = {
        "cutoff": 5.0,
        "edge_margin": 0.005,
        "window": 0.1,
        "wrench_delay": 0.004,
        "deep": {"x": [1, 2]},
    }
    assert texts(settings_table(settings)) == [
        ["cutoff", "5.000 Hz"], ["edge_margin", "0.005000 m"], ["window", "0.1000 rad"],
        ["wrench_delay", "0.004000 s"], ["deep.x", "1, 2"],
    ]  # fmt: skip


def dynamics(**parts: object) -> DynamicsResult:
    """A result whose numbers differ from each other."""
    score = DynamicsScore(
        "cross", "squat", "N", 0.25, 0.375, 9.0, percent_of_max=2.5, zero_mean_abs=1.0, cad_rms_error=3.0,
        samples=12, relative_error_percent=7.5, axis="force.x",
    )  # fmt: skip
    lost = replace(score, axis="force.y", zero_mean_abs=0.125)
    base = BaseParameter("m1 + m2", 20.0, 0.5, (19.0, 21.0), 2.5)
    own = InertialParameter("leg", "m", "kg", 3.5, 3.0)
    return replace(
        DynamicsResult(
            INERTIA_SCHEMA, "arm", (), {}, 12, 345.0, (base,), (own,), (), (score, lost), (), "", None
        ),
        **parts,
    )


def test_a_dynamics_page_has_every_number_under_its_head() -> None:
    result = dynamics()
    assert _inertia_verdict(result) == [
        "The logs determine 12 base parameters, with a condition number of 345.",
        ONE_OF_MANY,
        "The model predicts better than the mean alone in 1 of 2 rows of the validation, "
        "better than the URDF alone in 2.",
    ]
    base, inertial = _inertia(result)
    assert heads(base) == ["expression", "value ± half of its 95 % interval", "std", "relative std"]
    assert heads(inertial) == ["link", "parameter", "unit", "identified", "URDF", "difference"]
    table = _validation(result)
    first = dict(zip(heads(table), texts(table)[0], strict=True))
    assert first == {
        "kind": "cross", "motion": "squat", "axis": "force.x", "unit": "N", "mean |error|": "0.250",
        "rms error": "0.375", "largest |value|": "9.00", "mean |error| of largest [%]": "2.50",
        "mean |error| of the mean alone": "1.00", "relative error [%]": "7.50", "rms error by the URDF": "3.00",
        "samples": "12.0", "skill": "75 % better",
    }  # fmt: skip
    assert [row[-1].text for row in table.rows] == ["75 % better", "none"]


def test_a_dynamics_page_has_warnings_and_remarks(tmp_path: Path) -> None:
    notes = (Note("regularisation", "warning", "held back much"), Note("rates", "info", "were derived"))
    dynamics(notes=notes).save(tmp_path)
    page = write_dynamics_report(tmp_path).read_text()
    assert page.count("held back much") == page.count("were derived") == 1
    assert page.index("held back much") < page.index("were derived")


def test_many_joints_are_counted() -> None:
    terms = tuple(
        JointParameter(f"j{place}", "viscous", "N.m.s/rad", 1.0, 0.1, (0.8, 1.2), "usable", "")
        for place in range(9)
    )
    first, *_ = _joints_verdict(dynamics(parameters=terms, validation=()))
    assert first == f"Trust: {', '.join(f'j{place} viscous' for place in range(7))} and 2 more."
    eight, *_ = _joints_verdict(dynamics(parameters=terms[:8], validation=()))
    assert "j7 viscous" in eight
    assert "more" not in eight


KEY = SeriesKey("left", "pitch", "stiffness", "N.m/rad")


def fleet() -> FleetSummary:
    """Two robots, one of them with a step and an outlier."""
    series = [
        Series(unit, KEY, tuple(f"{unit}{day}" for day in range(6)), np.arange(20454.0, 20460.0),
               np.log(np.full(6, value)), np.full(6, 0.01))
        for unit, value in (("a", 400.0), ("b", 500.0))
    ]  # fmt: skip
    levels = [
        Level(one.unit, "left", "pitch", "stiffness", "N.m/rad", value, value - 2, value + 2, value - 8, value + 8,
              recordings, date(2026, 1, 2), 1.25, 0.5, 2.5)
        for one, value, recordings in zip(series, (400.0, 500.0), (12, 34), strict=True)
    ]  # fmt: skip
    days = [by_day(one) for one in series]
    alarms = [
        alarm_of(series[0], days[0], Change(kind, 1, 2, 0.05, 0.04, 0.06)) for kind in ("step", "outlier")
    ]
    alarms.append(alarm_of(series[1], days[1], Change("outlier", 1, 1, 0.05, 0.04, 0.06)))
    effect = Effect("left", "pitch", "stiffness", "N.m/rad", 450.0, 400.0, 500.0, 2, 46, 1.0, 2.0, 3.0)
    failures = (Reason("no column #", 7, "no column 3"),)
    return FleetSummary(
        12, 1.0, (effect,), tuple(levels), tuple(alarms), failures, tuple(series), tuple(days)
    )


def test_a_fleets_tables_have_every_number_under_its_head() -> None:
    summary = fleet()
    assert heads(_robots(summary)) == ["robot", "recordings", "left pitch [N·m/rad]", "alarms"]
    assert texts(_robots(summary)) == [["a", "12", "400.0 ± 8.0", "2"], ["b", "34", "500.0 ± 8.0", "1"]]
    assert [row[-1].mark for row in _robots(summary).rows] == ["weak", ""], (
        "an outlier alone is no alarm of a robot"
    )
    row = dict(zip(heads(_effects(summary)), texts(_effects(summary))[0], strict=True))
    assert row["recordings of a day differ [%]"] == "1"
    assert row["days of a robot differ [%]"] == "2"
    assert row["robots differ [%]"] == "3"
    assert (row["robots"], row["recordings"], row["mean"]) == ("2", "46", "450.0")
    assert heads(_trends(summary))[-2:] == ["trend [% a month]", "95 % interval"]
    failures = _failures(summary)
    assert failures is not None
    assert texts(failures) == [["7", "no column #", "no column 3"]]


def test_what_is_drawn_of_a_robot_is_its_days_and_bounds() -> None:
    first, second = _units(fleet(), ())
    (drawn,) = first["series"]
    assert drawn["time"] == [86400.0 * day for day in range(20454, 20460)]
    assert drawn["values"] == pytest.approx([400.0] * 6)
    assert drawn["bounds"] == [398.0, 402.0, 392.0, 408.0]
    assert drawn["since"] == 86400 * 20455
    assert drawn["title"] == "left pitch stiffness [N·m/rad]"
    assert (first["alarms"], second["alarms"]) == (2, 1)


def test_the_page_of_a_series_with_most_recordings_counts_those() -> None:
    """A robot's recordings are those of its number that most of them show."""
    summary = fleet()
    roll = replace(summary.levels[0], axis="roll", recordings=5)
    table = _robots(replace(summary, levels=(*summary.levels, roll)))
    assert texts(table)[0][1] == "12"


def test_days_are_a_mean_of_their_recordings() -> None:
    times = np.array([10.2, 10.9, 12.0, np.nan])
    series = Series(
        "a", KEY, ("g0", "g1", "g2", "g3"), times, np.array([1.0, 2.0, 5.0, 9.0]), np.full(4, 0.1)
    )
    days = by_day(series)
    assert isinstance(days, Days)
    assert days.day.tolist() == [10.0, 12.0]
    assert days.values.tolist() == [1.5, 5.0]
    assert days.counts.tolist() == [2.0, 1.0]
    assert days.groups == (("g0", "g1"), ("g2",))
    assert days.weights(0.2, 0.1).tolist() == pytest.approx([1 / (0.01 + 0.04 / 2), 1 / (0.01 + 0.04)])
    assert series.days == [10, 10, 12, "g3"]


def test_settings_within_settings_are_told_four_levels_deep() -> None:
    """What lies deeper is told as it would be written in JSON; so is an empty one."""
    deep: dict[str, object] = {"f": {"g": 1}}
    for name in "edcba":
        deep = {name: deep}
    table = settings_table(deep | {"none": {}, "some": [1, 2.5, "x"], "wrench_delay": 0.004})
    assert texts(table)[:3] == [
        ["a.b.c.d.e", '{"f": {"g": 1}}'], ["none", "{}"], ["some", "1, 2.500, x"],
    ]  # fmt: skip
