"""A feet result as an object: what it prints, its table, its plot, and that it comes back from its file unchanged."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot
from feet_trials import noisy
from plantar.errors import DataError, PlantarError
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.notes import Note
from plantar.results.feet import Comparison, FeetResult
from plantar.results.feet_rows import AxisModel, Candidate, DelayEstimate, LinearEquivalent, Parameter
from plantar.results.feet_text import (
    delay_line,
    parameter_cells,
    prediction_cells,
    title_of_axis,
    weak_lines,
)
from plantar.results.text import columns, html_lines, html_table, warnings

mpl.use("agg")

K = Parameter("left", "pitch", "stiffness", "N.m/rad", 434.02, 0.16, (433.7, 434.34), 0.2, "usable", "narrow")
C = Parameter(
    "left", "pitch", "damping", "N.m.s/rad", -0.4, 1.0, (-2.4, 1.6), 9.0, "weak", "wide", "sway faster"
)
Z = Parameter(
    "left", "z", "stiffness", "N/m", None, None, None, None, "unidentifiable", "no load moves", None
)


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> FeetResult:
    """Bushes that stiffen, so that models were compared; one unseen log."""
    truth = {key: replace(model, hardening=20000.0) for key, model in TRUTH.items()}
    logs = [noisy(record(sway(f"sway_{seed}", seed, duration=12.0, truth=truth)), seed) for seed in (1, 2, 3)]
    robot = make_robot(tmp_path_factory.mktemp("robot"))
    return identify_feet(robot, logs[:2], logs[2:], FeetSettings(wrench_delay=0.002))


def full(result: FeetResult) -> FeetResult:
    """With what `plantar demo` adds."""
    other = Comparison("shared offset", {"offset": "shared"}, result.parameters, result.validation)
    return replace(result, comparisons=(other,), campaign={"preset": "ideal", "table_1": [{"a": 1.5}]})


def test_a_result_comes_back_from_its_file_to_the_byte(result: FeetResult, tmp_path: Path) -> None:
    for place, one in enumerate((result, full(result))):
        path = one.save(str(tmp_path / str(place)))
        again = FeetResult.load(path)
        assert again.models == one.models
        assert any(model.ranking for model in again.models), "this test would prove nothing"
        assert (again.sensor_delay, again.diagnosis) == (one.sensor_delay, one.diagnosis)
        assert again.assumptions == one.assumptions
        assert (again.parameters, again.comparisons) == (one.parameters, one.comparisons)
        assert again.residuals is not None
        assert again.residuals.num_rows == one.residuals.num_rows
        assert again.save(tmp_path / "again").read_bytes() == path.read_bytes()


def test_the_file_has_the_contracts_keys_in_their_order(result: FeetResult) -> None:
    keys = [
        "schema", "robot", "plantar", "created", "inputs", "settings", "model", "parameters", "offsets", "phases",
        "validation", "notes", "robot_model", "laws", "latency", "compliance", "diagnosis",
        "assumptions",
    ]  # fmt: skip
    content = result.to_dict()
    assert list(content) == keys
    assert list(full(result).to_dict()) == [*keys, "comparisons", "campaign"]
    law = next(row for row in content["laws"] if "ranking" in row)
    assert list(law) == ["foot", "axis", "law", "reason", "linear_equivalent", "held_out", "ranking"]
    assert list(law["ranking"][0]) == ["law", "held_out_rms", "parameters", "refused", "chosen"]
    assert list(content["latency"]) == ["wrench_delay", "std", "measured", "unit", "feet", "encoder_delay"]
    assert set(content["compliance"]) == {"left", "right"}


def test_the_moment_arm_of_the_load_stands_only_where_there_is_one(
    result: FeetResult, tmp_path: Path
) -> None:
    with_arm = replace(result.models[0], moment_arms=(0.004, 0.0))
    again = FeetResult.load(replace(result, models=(with_arm, *result.models[1:])).save(tmp_path))
    assert [row.moment_arms[0] for row in again.models] == [0.004, 0.0, 0.0, 0.0]
    assert ["moment_arms" in row for row in again.to_dict()["laws"]] == [True, False, False, False]


def test_a_file_of_another_version_keeps_its_version(result: FeetResult, tmp_path: Path) -> None:
    content = result.to_dict() | {"plantar": "0.0.9", "created": "2026-01-01T00:00:00Z", "colour": "red"}
    (tmp_path / "result.json").write_text(json.dumps(content))
    again = FeetResult.load(tmp_path)
    assert (again.version, again.residuals) == ("0.0.9", None)
    assert again.to_dict() == {key: value for key, value in content.items() if key != "colour"}


def test_numbers_that_are_not_finite_come_back(result: FeetResult, tmp_path: Path) -> None:
    row = replace(result.parameters[0], interval95=(-math.inf, 5.0), std=math.inf)
    offset = replace(result.offsets[0], std=math.nan)
    model = AxisModel("left", "roll", "hardening", "r", LinearEquivalent(1.0, 2.0), (0.0, 0.0), "h",
                      (Candidate("iwan", math.inf, 3, "too slow", False),))  # fmt: skip
    odd = replace(result, parameters=(row,), offsets=(offset,), models=(model,))
    again = FeetResult.load(odd.save(tmp_path))
    assert again.parameters[0].interval95 == (-math.inf, 5.0)
    assert math.isnan(again.offsets[0].std)
    assert again.to_dict() == odd.to_dict()


@pytest.mark.parametrize(
    ("change", "place"),
    [
        (lambda c: c.pop("robot"), "'robot': is missing"),
        (lambda c: c.pop("parameters"), "'parameters': is missing"),
        (lambda c: c.update(phases={}), "result.json, column 'phases': Input should be a valid list"),
        (lambda c: c["parameters"][1].update(value="much"), "'parameters.1.value'"),
        (lambda c: c["parameters"][0].update(verdict="fine"), "'parameters.0.verdict'"),
        (lambda c: c["offsets"][0].pop("motion"), "'offsets.0.motion'"),
        (lambda c: c["laws"][0].pop("law"), "'laws.0.model'"),
        (lambda c: c["laws"].append(3), "'laws.4'"),
        (lambda c: c["latency"].update(unit="ms"), "'latency.unit'"),
        (lambda c: c.update(compliance={"left": "soft"}), "'compliance.left'"),
        (lambda c: c.update(comparisons=[{"name": "x"}]), "'comparisons.0.settings'"),
        (lambda c: c.update(schema="plantar.inertia/1"), "plantar.inertia/1"),
    ],
)
def test_a_broken_file_is_one_line(
    result: FeetResult, tmp_path: Path, change: Callable[[dict[str, Any]], object], place: str
) -> None:
    content = json.loads(json.dumps(result.to_dict()))
    change(content)
    (tmp_path / "result.json").write_text(json.dumps(content))
    with pytest.raises(PlantarError, match=re.escape(place)) as caught:
        FeetResult.load(tmp_path)
    assert str(tmp_path / "result.json") in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_number_is_printed_with_half_of_its_interval_in_units_and_percent() -> None:
    left, right = parameter_cells([K, C])
    assert left == ("left", "pitch", "stiffness", "434.0 ± 0.3", "N·m/rad", "0.074 %", "usable")
    assert right[3:] == (" −0.4 ± 2.0", "N·m·s/rad", "500 %", "weak")
    assert parameter_cells([Z])[0][3:] == ("–", "N/m", "–", "unidentifiable")
    assert (K.half_width, K.half_width_percent) == (pytest.approx(0.32), pytest.approx(0.0737, abs=1e-4))
    assert (Z.half_width, Z.half_width_percent) == (None, None)
    title = "left pitch: K = 434.0 ± 0.3 N·m/rad (usable), C = −0.4 ± 2.0 N·m·s/rad (weak)"
    assert title_of_axis([K, C, Z], "left", "pitch") == title


def test_advice_is_given_where_there_is_one_and_told_once() -> None:
    bare, lost = replace(C, name="slip_torque", advice=None), replace(Z, advice="sway faster")
    *why, head, todo = weak_lines([K, C, bare, lost])
    assert why[:2] == ["Not usable as they are", "  left pitch damping, left pitch slip torque (weak): wide"]
    assert (head, todo) == ("What to record next", "  for left pitch damping, left z stiffness: sway faster")
    assert weak_lines([K]) == []
    assert "What to record next" not in weak_lines([bare])


def test_the_text_has_every_number_its_verdict_reason_and_advice(result: FeetResult) -> None:
    notes = (Note("a", "warning", "the feet slid"), Note("b", "info", "by the way"))
    lines = str(replace(result, parameters=(K, C, Z), notes=notes)).splitlines()
    assert lines[0].startswith("Feet of biped: hardening, offset per-motion; logs: 2 fitted, 1 unseen")
    assert "  left  pitch  stiffness  434.0 ± 0.3  N·m/rad    0.074 %  usable" in lines
    assert "  left pitch damping (weak): wide" in lines
    assert "  left z stiffness (unidentifiable): no load moves" in lines
    assert "  for left pitch damping: sway faster" in lines
    assert "Force sensors 2.000 ms late, as given" in lines
    assert "  warning: the feet slid" in lines
    assert "  further notes, in .notes: 1" in lines
    assert not any("by the way" in line for line in lines)


def test_prediction_is_the_mean_over_samples_and_says_where_nothing_was_learnt(result: FeetResult) -> None:
    row = result.validation[0]
    rows = [
        replace(row, motion="long", mean_abs_error=1.0, zero_mean_abs=4.0, samples=300),
        replace(row, motion="short", mean_abs_error=2.0, zero_mean_abs=2.0, samples=100),
    ]
    (cells,) = prediction_cells(rows)
    expected = ("2 fitted", "left", "pitch", "1.25", "3.50", "no better than the offset alone: short")
    assert cells == expected
    assert delay_line(None) == []
    measured = DelayEstimate(0.004, 0.0005, measured=True)
    assert delay_line(measured) == ["Force sensors 4.0 ± 1.0 ms late, measured"]  # 1.96 deviations


def test_columns_are_aligned_and_markup_is_text() -> None:
    assert columns([("a", "bb", "c"), ("aaa", "b", "")]) == ["  a    bb  c", "  aaa  b"]
    page = html_table("<b>", ["x"], [["<script>"]]) + html_lines(["<i>"])
    assert not re.search("<b>|<script>|<i>", page)
    many = [Note("n", "warning", f"number {k}") for k in range(11)]
    assert len(warnings(many)) == 9
    assert warnings(many)[-1] == "  further notes, in .notes: 3"


def test_a_notebook_shows_the_table(result: FeetResult) -> None:
    page = replace(result, robot="<img>")._repr_html_()
    assert "&lt;img&gt;" in page
    assert page.count("<tr>") == 1 + len(result.parameters)
    usable = sum(row.verdict == "usable" for row in result.parameters)
    assert (
        repr(result)
        == f"<FeetResult of biped: {len(result.parameters)} parameters, {usable} usable, from 2 logs>"
    )


def test_a_notebook_says_all_that_print_says_but_the_prediction(result: FeetResult) -> None:
    """Why a number is not usable, what to record next, how late the sensors are, and every warning."""
    told = replace(
        result,
        parameters=(K, C, Z),
        sensor_delay=DelayEstimate(0.004, 0.0005, measured=True),
        notes=(Note("gap", "warning", "a < b"), Note("model", "info", "unseen")),
    )
    page = told._repr_html_()
    for line in ("left pitch damping (weak): wide", "left z stiffness (unidentifiable): no load moves",
                 "for left pitch damping: sway faster", "Force sensors 4.0 ± 1.0 ms late, measured",
                 "warning: a &lt; b", "further notes, in .notes: 1"):  # fmt: skip
        assert f">{line}</div>" in page
        assert line.replace("&lt;", "<") in str(told)


def test_the_arrow_table_has_a_row_for_each_parameter(result: FeetResult) -> None:
    table = replace(result, parameters=(K, Z)).to_table()
    first, last = table.to_pylist()
    assert first == {
        "foot": "left", "axis": "pitch", "name": "stiffness", "unit": "N.m/rad", "value": 434.02, "std": 0.16,
        "low": 433.7, "high": 434.34, "relative_std_percent": 0.2, "verdict": "usable", "reason": "narrow",
        "advice": None,
    }  # fmt: skip
    assert [last[name] for name in ("value", "low", "high")] == [None, None, None]
    assert result.to_table().schema == table.schema


def test_the_plot_draws_used_samples_of_each_motion(result: FeetResult) -> None:
    axes = result.plot("left", "roll")
    assert len(axes.get_lines()) == 2 * 3, "measured and model, three motions"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["measured", "model"]
    again = result.plot("left", "roll", motions="sway_2", axes=axes)
    assert again is axes
    measured = axes.get_lines()[-2]
    rows = result.residuals.to_pylist()
    mine = [row for row in rows if (row["motion"], row["foot"]) == ("sway_2", "left")]
    angle = [1e3 * row["roll.deflection"] if row["used"] else np.nan for row in mine]
    np.testing.assert_allclose(measured.get_xdata(), angle)
    np.testing.assert_allclose(measured.get_ydata(), [row["roll.torque"] for row in mine])
    np.testing.assert_allclose(axes.get_lines()[-1].get_ydata(), [row["roll.predicted"] for row in mine])


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        (("middle", "pitch", ()), r"^value 'middle': no foot has that name \(valid: left, right\)$"),
        (("left", "z", ()), r"^value 'z': no axis has that name \(valid: pitch, roll\)$"),
        (
            ("left", "pitch", ("squat",)),
            r"^value 'squat': no motion has that name \(valid: sway_1, sway_2, sway_3\)$",
        ),
    ],
)
def test_what_cannot_be_plotted_is_one_line(
    result: FeetResult, asked: tuple[str, str, tuple[str, ...]], expected: str
) -> None:
    foot, axis, motions = asked
    with pytest.raises(DataError, match=expected):
        result.plot(foot, axis, motions=motions)
    with pytest.raises(
        DataError,
        match=r"^the result holds no residuals to draw \(valid: a result of identify_feet, or "
        r"FeetResult\.load of a folder with residuals\.parquet\)$",
    ):
        replace(result, residuals=None).plot("left", "pitch")
