"""Edges and printed numbers of results, each tried on both sides of where it lies; values by hand."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pyarrow as pa
import pytest

from plantar.contact.phases import Phase
from plantar.errors import PlantarError
from plantar.notes import Note
from plantar.results import text
from plantar.results.dynamics import INERTIA_SCHEMA, JOINTS_SCHEMA, DynamicsResult
from plantar.results.dynamics_rows import DynamicsScore, InertialParameter, JointParameter
from plantar.results.dynamics_text import joint_cells, score_cells
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import (
    Assumption,
    AxisModel,
    DelayEstimate,
    LinearEquivalent,
    Parameter,
    ValidationRow,
)
from plantar.results.feet_text import (
    assumption_cells,
    delay_line,
    parameter_cells,
    prediction_cells,
    title_of_axis,
)
from plantar.results.numbers import decimals_for, interval, number, percent, unit, with_uncertainty
from plantar.results.residuals import read_table, tracks_of
from plantar.results.stored import row_of
from plantar.results.usage import used_shares

K = Parameter("left", "pitch", "stiffness", "N.m/rad", 500.0, 5.0, (490.0, 510.0), 1.0, "usable", "")
C = replace(K, name="damping", unit="N.m.s/rad", value=20.0, interval95=(19.0, 21.0), verdict="weak")


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        (number(1.2346e-4), "0.0001235"),  # the smallest size without an exponent
        (number(9.876e-5), "9.876e−5"),
        (number(9.99e6), "9990000"),
        (number(1.234e7), "1.234e7"),
        (number(0.5), "0.5000"),
        (number(float("inf")), "–"),
        (with_uncertainty(3.0, 1.01e-6), "3.0000000 ± 0.0000010"),
        (with_uncertainty(3.0, 9.9e-7), "3.000 ± 9.9e−7"),
        (with_uncertainty(9.99e6, 2e5), "9990000 ± 200000"),
        (with_uncertainty(1.0e7, 2e5), "1.000e7 ± 0.020e7"),
        (interval((1.0, 1.0)), "1.000 to 1.000"),
        (interval((2.0, 1.0)), "2.000 to 1.000"),
        (interval((1.0, 1.000002)), "1.0000000 to 1.0000020"),
        (interval((1.0, 1.0000009)), "1.000 to 1.000"),
        (interval((100.0, 150.0)), "100 to 150"),
        (interval((100.0, 105.0)), "100.0 to 105.0"),
        (interval((float("nan"), 1.0)), "–"),
        (percent(0.314), "0.31 %"),
        (percent(None), "–"),
        (unit("N.m/rad3"), "N·m/rad³"),
        (unit("kg.m2"), "kg·m²"),
        (unit("N.m"), "N·m"),
    ],
)  # fmt: skip
def test_numbers(said: str, expected: str) -> None:
    assert said == expected


@pytest.mark.parametrize(
    ("uncertainty", "decimals"),
    [
        (0.0294, 3),
        (0.0296, 2),
        (0.01, 3),
        (0.0999, 2),
        (2.9, 1),
        (3.0, 0),
        (40.0, 0),
        (400.0, -1),
        (1e-13, 12),
    ],
)
def test_decimals_leave_two_digits_up_to_three_and_then_one(uncertainty: float, decimals: int) -> None:
    assert decimals_for(uncertainty) == decimals


@pytest.mark.parametrize(
    ("delay", "line"),
    [
        (None, []),
        (DelayEstimate(0.005, 0.0005, True), ["Force sensors 5.0 ± 1.0 ms late, measured"]),
        (DelayEstimate(0.005, 0.0, False), ["Force sensors 5.000 ms late, as given"]),
        (
            DelayEstimate(0.0, 0.004, False),
            ["Force sensors 0 ± 8 ms late, not measured from these logs"],
        ),
    ],
)
def test_the_delay_is_told_in_milliseconds_with_twice_its_deviation(
    delay: DelayEstimate | None, line: list[str]
) -> None:
    assert delay_line(delay) == line


def test_an_axis_is_told_in_a_line_and_its_decimal_places_stand_under_each_other() -> None:
    line = "left pitch: K = 500 ± 10 N·m/rad (usable), C = 20.0 ± 1.0 N·m·s/rad (weak)"
    others = [replace(K, foot="right"), replace(K, axis="roll"), replace(K, name="slip_torque")]
    assert title_of_axis([K, C, *others], "left", "pitch") == line
    assert [cells[3:6] for cells in parameter_cells([K, C])] == [
        (" 500 ± 10", "N·m/rad", "2.0 %"),
        ("20.0 ± 1.0", "N·m·s/rad", "5.0 %"),
    ]
    widths = [replace(K, value=-500.0), replace(K, value=0.0), replace(K, interval95=None)]
    assert [(row.half_width, row.half_width_percent) for row in widths] == [(10, 2), (10, None), (None, None)]


@pytest.mark.parametrize(
    ("errors", "said"), [((0.4, 0.4), ""), ((0.4, 0.5), "no better than the offset alone: b"),
                         ((0.6, 0.5), "no better than the offset alone: a, b")],
)  # fmt: skip
def test_a_prediction_that_is_only_as_good_as_the_offset_has_no_skill(
    errors: tuple[float, float], said: str
) -> None:
    rows = [
        ValidationRow("cross", name, "left", "roll", error, 1.0, 9.0, 5.0, 0.5, samples)
        for name, error, samples in zip("ab", errors, (300, 100), strict=True)
    ]
    mean = 0.75 * errors[0] + 0.25 * errors[1]
    assert prediction_cells(rows) == [("2 unseen", "left", "roll", number(mean, 3), "0.500", said)]
    assert [row.has_skill for row in rows] == [error < 0.5 for error in errors]


def test_dynamics_are_printed_by_value() -> None:
    row = JointParameter("knee", "offset", "N.m", -4.0, 0.1, (-4.5, -3.5), "weak", "")
    cells = joint_cells([row, replace(row, value=0.0)])
    assert [each[2:] for each in cells] == [
        ("−4.0 ± 0.5", "N·m", "12 %", "weak"),
        ("0.0 ± 0.5", "N·m", "", "weak"),
    ]
    scores = [
        DynamicsScore(kind, "a", "N.m", 1.0, rms, 9.0, zero_mean_abs=1.0, cad_rms_error=2 * rms, samples=n, axis="fz")
        for kind, rms, n in (("direct", 1.0, 300), ("direct", 3.0, 100), ("cross", 2.0, 50))
    ]  # fmt: skip
    assert score_cells(scores) == [
        ("2 fitted", "fz", "N·m", "1.73", "3.46"),  # √((300·1 + 100·9) / 400)
        ("1 unseen", "fz", "N·m", "2.00", "4.00"),
    ]
    assert not scores[0].has_skill, "as good as the trivial predictor is no skill"
    assert replace(scores[0], mean_abs_error=0.99).has_skill
    assert "percent_of_max" not in scores[0].to_dict()


def test_a_result_names_itself(tmp_path: Path) -> None:
    masses = [
        InertialParameter("arm", name, "kg", value, 1.0)
        for name, value in (("m", 2.5), ("mx", 9.0), ("m", 1.5))
    ]
    one = DynamicsResult(JOINTS_SCHEMA, "walker", (), {}, 4, 1.0, (), tuple(masses), (), (), (), "", None)  # fmt: skip
    assert repr(one) == f"<DynamicsResult of walker: {JOINTS_SCHEMA}, 4 kg, rank 4>"
    assert str(one).startswith("Joints of walker: 4 kg, rank 4; plantar ")
    assert one == replace(one, residuals=pa.table({"time": [0.0]})), (
        "residuals are no part of what is compared"
    )
    knee = JointParameter("knee", "viscous", "N.m.s/rad", 3.0, 0.1, (2.8, 3.2), "usable", "")
    score = DynamicsScore(
        "direct", "a", "N", 1.0, 1.0, 9.0, zero_mean_abs=2.0, cad_rms_error=1.0, samples=5, axis="fz"
    )
    full = replace(
        one, parameters=(replace(knee, joint="hip"), knee), validation=(score, replace(score, motion="b"))
    )
    assert full.parameter("knee", "viscous") is knee
    assert full.score("b", "fz") is full.validation[1]
    for missing in (
        lambda: full.parameter("knee", "offset"),
        lambda: full.score("a", "fx"),
        lambda: full.score("c", "fz"),
    ):
        with pytest.raises(KeyError):
            missing()
    content = replace(one, schema=INERTIA_SCHEMA).to_dict()
    del content["inertial_parameters"]
    (tmp_path / "result.json").write_text(json.dumps(content))
    with pytest.raises(
        PlantarError,
        match=r"result\.json, column 'inertial_parameters': is missing \(valid: a whole result\.json\)$",
    ):
        DynamicsResult.load(tmp_path, beside=False)


def test_residuals_are_read_only_where_they_are_asked_for(tmp_path: Path) -> None:
    table = pa.table({"motion": ["a"], "foot": ["left"], "time": [0.0], "used": [True]})
    FeetResult("r", (), {}, "kelvin_voigt", (K,), (), (), (), (), residuals=table).save(tmp_path)
    assert FeetResult.load(tmp_path).residuals.num_rows == 1
    assert FeetResult.load(tmp_path, residuals=False).residuals is None


def test_an_arm_a_turn_and_a_lean_stand_in_the_file_only_where_there_are_any() -> None:
    plain = AxisModel("left", "pitch", "kelvin_voigt", "asked", LinearEquivalent(500.0, 20.0))
    optional = {
        "moment_arms": (0.0, 0.001),
        "turned": 0.01,
        "leans": 0.02,
        "crosstalk": 0.003,
        "imu_turned": (0.0, 0.0, 0.03),
        "ranking": (),
    }
    for name, value in optional.items():
        content = replace(plain, **{name: value}).to_dict()
        held_out = {"held_out"} if name == "ranking" else set()
        assert set(content) - set(plain.to_dict()) == {name} | held_out
        assert AxisModel.from_dict(content, "laws.0", None) == replace(plain, **{name: value})


def test_an_interval_of_null_is_open() -> None:
    entry = {"joint": "k", "name": "n", "unit": "", "std": 1.0, "verdict": "weak", "reason": ""}
    one = row_of(JointParameter, entry | {"value": None, "interval95": [None, None]}, "p.0", None)
    assert one.interval95 == (-float("inf"), float("inf"))
    assert one.value != one.value


def test_residuals_beyond_two_gigabytes_are_not_read(tmp_path: Path) -> None:
    path = tmp_path / "residuals.parquet"
    path.touch()
    for size, said in (
        (2_000_000_001, r"residuals\.parquet: is larger than 2000000000 bytes \(valid: a smaller file\)$"),
        (2_000_000_000, "cannot be read"),
    ):
        os.truncate(path, size)
        with pytest.raises(PlantarError, match=said):
            read_table(path)


def test_tracks_hold_what_their_table_has() -> None:
    rows = {
        "motion": ["a", "b", "a"],
        "foot": ["l", "r", "l"],
        "time": [0.2, 0.0, 0.1],
        "used": [1.0, 0.0, 0.0],
    }
    tracks = tracks_of(pa.table(rows | {"force_z": [5.0, 6.0, 7.0]}))
    assert [(one.motion, one.foot, list(one.time), list(one.used), list(one.values["force_z"])) for one in tracks] == [
        ("a", "l", [0.1, 0.2], [False, True], [7.0, 5.0]), ("b", "r", [0.0], [False], [6.0])
    ]  # fmt: skip
    assert [(one.role, list(one.support)) for one in tracks] == [("", ["", ""]), ("", [""])]
    for time in (float("nan"), float("inf")):
        with pytest.raises(PlantarError, match=r"^column 'time': is not finite \(valid: seconds\)$"):
            tracks_of(pa.table(rows | {"time": [0.0, 0.1, time]}))
    with pytest.raises(PlantarError, match=r"^column 'time': is not numeric: Failed to parse value: c$"):
        tracks_of(pa.table(rows | {"time": ["a", "b", "c"]}))


def test_a_table_for_a_notebook_is_whole_and_warnings_are_counted() -> None:
    page = ElementTree.fromstring(text.html_table("t", ("a", "b"), [("1", "<2>"), ("3", "4")]))
    assert [[cell.text for cell in line] for line in page.iter("tr")] == [
        ["a", "b"],
        ["1", "<2>"],
        ["3", "4"],
    ]
    warnings = [Note("code", "warning", f"w{place}") for place in range(9)]
    assert text.warnings(warnings[:8]) == [f"  warning: w{place}" for place in range(8)]
    assert text.warnings([*warnings, Note("code", "info", "i")])[-1] == "  further notes, in .notes: 2"


def test_seconds_are_added_up_by_reason() -> None:
    spans = [(1.0, 3.0, True, None), (3.0, 4.5, False, "slip"), (5.0, 7.0, True, None), (7.0, 8.0, False, "slip"),
             (8.0, 8.051, False, "gap"), (8.1, 8.149, False, "air")]  # fmt: skip
    (row,) = used_shares(Phase("a", "left", *span[:2], "double", *span[2:]) for span in spans)
    assert row.seconds == pytest.approx(6.6)
    assert row.used == pytest.approx(4.0)
    assert row.reasons == "slip (2.5 s); gap (0.1 s)"


def test_what_the_robot_file_allows_for_is_told_in_the_units_of_the_shop() -> None:
    """Metres as mm, shares as percent, with two deviations of what the logs show; a name and its widths stand once."""
    none = (None, None)
    rows = [
        Assumption("bush_position", "left x", 0.003, 0.0012, 0.0001, 1.5, None),
        Assumption("bush_position", "left y", 0.003, 0.0012, None, 1.5, None),
        Assumption("wrench_gain", "left", 0.01, None, None, *none),
        Assumption("wrench_delay", "all", 0.0, 0.0, 0.0, *none),
    ]
    assert assumption_cells(rows) == [
        ("bush_position", "3.0 mm", "left x", "1.20 ± 0.20 mm", "± 1.5 %", "–"),
        ("", "", "left y", "1.2 mm", "", ""),
        ("wrench_gain", "1.0 %", "left", "not in these logs", "–", "–"),
    ]
