"""What a result of feet says in text, of rows that are made up: every cell."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from plantar.contact.phases import Phase
from plantar.notes import Note
from plantar.results.feet import DelayEstimate, Parameter, ValidationRow
from plantar.results.feet_rows import Assumption
from plantar.results.feet_text import (
    assumption_cells,
    delay_line,
    over_all_motions,
    parameter_cells,
    prediction_cells,
    title_of_axis,
    weak_lines,
)
from plantar.results.text import columns, html_lines, html_table, warnings
from plantar.results.usage import used_shares

ROW = Parameter(
    "left", "pitch", "stiffness", "N.m/rad", 434.04, 1.0, (433.74, 434.34), 0.1, "usable", "narrow"
)
SLIP = replace(
    ROW, name="slip_torque", unit="N.m", value=5.5, interval95=(3.5, 7.5), verdict="weak", reason="wide", advice="sway"
)  # fmt: skip
NONE = replace(
    ROW, axis="roll", name="damping", unit="N.m.s/rad", value=None, interval95=None, verdict="unidentifiable",
    reason="still", advice="sway",
)  # fmt: skip


def test_numbers_stand_with_their_points_under_each_other() -> None:
    assert parameter_cells([ROW, SLIP, NONE]) == [
        ("left", "pitch", "stiffness", "434.0 ± 0.3", "N·m/rad", "0.069 %", "usable"),
        ("left", "pitch", "slip torque", "  5.5 ± 2.0", "N·m", "36 %", "weak"),
        ("left", "roll", "damping", "    –", "N·m·s/rad", "–", "unidentifiable"),
    ]
    assert parameter_cells([]) == []


def test_why_numbers_are_not_usable_and_what_to_record_stand_together() -> None:
    same = replace(SLIP, foot="right")
    assert weak_lines([ROW, SLIP, NONE, same, replace(NONE, advice=None)]) == [
        "Not usable as they are",
        "  left pitch slip torque, right pitch slip torque (weak): wide",
        "  left roll damping, left roll damping (unidentifiable): still",
        "What to record next",
        "  for left pitch slip torque, left roll damping, right pitch slip torque: sway",
    ]
    assert weak_lines([replace(SLIP, advice=None)]) == [
        "Not usable as they are",
        "  left pitch slip torque (weak): wide",
    ]
    assert weak_lines([ROW]) == []


def test_an_axis_in_a_line() -> None:
    damping = replace(
        ROW, name="damping", unit="N.m.s/rad", value=18.2, interval95=(17.1, 19.3), verdict="weak"
    )
    rows = [replace(ROW, foot="right"), ROW, SLIP, damping, NONE]
    assert title_of_axis(rows, "left", "pitch") == (
        "left pitch: K = 434.0 ± 0.3 N·m/rad (usable), C = 18.2 ± 1.1 N·m·s/rad (weak)"
    )
    assert title_of_axis(rows, "left", "roll") == "left roll: C = – N·m·s/rad (unidentifiable)"


def test_scores_over_all_motions_are_over_all_samples() -> None:
    """30 samples and 10: means of errors, of squares; the largest torque; who is no better than the offset alone."""
    first = ValidationRow("cross", "a", "left", "roll", 1.0, 2.0, 8.0, 12.5, 4.0, 30)
    other = ValidationRow("cross", "b", "left", "roll", 3.0, 6.0, 5.0, 60.0, 3.0, 10)
    fitted = replace(other, kind="direct", mean_abs_error=0.5)
    (row, count, lost), (alone, one, none) = over_all_motions([first, fitted, other])
    assert (count, lost, one, none) == (2, ["b"], 1, [])
    assert (row.motion, row.kind, row.samples, row.max_abs) == ("all", "cross", 40, 8.0)
    assert (row.mean_abs_error, row.zero_mean_abs) == (1.5, 3.75)
    assert row.rms_error == pytest.approx(((30 * 4 + 10 * 36) / 40) ** 0.5)
    assert row.percent_of_max == pytest.approx(100 * 1.5 / 8)
    assert (alone.motion, alone.mean_abs_error, alone.percent_of_max) == ("all", 0.5, 10.0)
    still = replace(first, max_abs=0.0, samples=0)
    assert over_all_motions([still])[0][0].percent_of_max is None
    assert prediction_cells([first, other, fitted]) == [
        ("2 unseen", "left", "roll", "1.50", "3.75", "no better than the offset alone: b"),
        ("1 fitted", "left", "roll", "0.500", "3.00", ""),
    ]


@pytest.mark.parametrize(
    ("delay", "lines"),
    [
        (None, []),
        (DelayEstimate(0.0123, 0.001, True), ["Force sensors 12.3 ± 2.0 ms late, measured"]),
        (
            DelayEstimate(0.0123, 0.001, False),
            ["Force sensors 12.3 ± 2.0 ms late, not measured from these logs"],
        ),
        (DelayEstimate(0.0123, 0.0, False), ["Force sensors 12.30 ms late, as given"]),
    ],
)
def test_a_delay_in_a_line(delay: DelayEstimate | None, lines: list[str]) -> None:
    assert delay_line(delay) == lines


def test_what_may_be_wrong_in_cells() -> None:
    """A key's second number has no name and no width again; what may not be wrong and is not stands nowhere."""
    rows = [
        Assumption("bush_position", "left x", 0.003, 0.0041, 0.0005, 1.234, None),
        Assumption("bush_position", "left y", 0.003, -0.002, None, None, None),
        Assumption("link_mass", "", 0.05, None, None, None, 2.5),
        Assumption("wrench_delay", "", 0.0, None, None, 0.0, None),
        Assumption("imu_mount", "x", 0.0, 0.02, 0.001, None, None),
        Assumption("wrench_gain", "", 0.01, None, None, None, None),
    ]
    assert assumption_cells(rows) == [
        ("bush_position", "3.0 mm", "left x", "4.1 ± 1.0 mm", "± 1.2 %", "–"),
        ("", "", "left y", "−2.0 mm", "", ""),
        ("link_mass", "5.0 %", "", "in how well wrench_delay is known", "–", "± 2.5 %"),
        ("imu_mount", "0 deg", "x", "1.15 ± 0.11 deg", "–", "–"),
        ("wrench_gain", "1.0 %", "", "not in these logs", "–", "–"),
    ]


def test_columns_begin_at_one_place() -> None:
    assert columns([("a", "bbb", ""), ("cccc", "d", "e")]) == ["  a     bbb", "  cccc  d    e"]
    assert columns([("a",)], indent="") == ["a"]


def test_eight_warnings_are_told_and_the_rest_is_counted() -> None:
    notes = [Note("code", "info" if k == 2 else "warning", f"text {k}") for k in range(11)]
    told = [f"  warning: text {k}" for k in range(9) if k != 2]
    assert warnings(notes) == [*told, "  further notes, in .notes: 3"]
    assert warnings(notes[:2]) == told[:2]


def test_a_notebooks_texts_are_escaped_and_their_indents_kept() -> None:
    cell = 'style="text-align:left;padding:2px 10px"'
    assert html_table("a < b", ("x", "y&z"), [("1", "<2>")]) == (
        '<table><caption style="text-align:left;padding:4px 10px">a &lt; b</caption>'
        f"<thead><tr><th {cell}>x</th><th {cell}>y&amp;z</th></tr></thead>"
        f"<tbody><tr><td {cell}>1</td><td {cell}>&lt;2&gt;</td></tr></tbody></table>"
    )
    assert html_lines(["a & b", "  c "]) == (
        '<div style="padding:1px 10px 1px 10px">a &amp; b</div><div style="padding:1px 10px 1px 30px">c</div>'
    )


def test_seconds_by_the_kind_of_their_reason() -> None:
    def phase(start: float, end: float, reason: str | None, **changes: Any) -> Phase:
        fields = {"motion": "m", "foot": "left", "support": "double", "used": False} | changes
        return Phase(start=start, end=end, reason=reason, **fields)

    left, right = used_shares(
        [
            phase(0.0, 2.0, None, used=True), phase(2.0, 3.0, "tips: one way"), phase(3.0, 3.5, "tips: another"),
            phase(3.5, 5.5, None, support="air"), phase(5.5, 5.53, "slip: x"), phase(6.0, 6.0, "nothing: lasts"),
            phase(0.0, 1.0, "in the air", foot="right"), phase(1.0, 4.0, None, foot="right", used=True),
        ]
    )  # fmt: skip
    assert (left.motion, left.foot, left.seconds, left.used) == ("m", "left", pytest.approx(5.53), 2.0)
    assert dict(left.left_out) == {"tips": 1.5, "air": 2.0, "slip": pytest.approx(0.03)}
    assert left.reasons == "tips (1.5 s); air (2.0 s)"
    assert right.to_dict() == {
        "motion": "m", "foot": "right", "seconds": 4.0, "served": 3.0, "reasons": "in the air (1.0 s)"
    }  # fmt: skip
