"""Tables of the campaign by hand: each number under its own head, half of an interval behind its ±."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from kept_texts import assert_as_kept, described
from plantar.campaign.compared import CrossBeside, DirectBeside, ParameterBeside
from plantar.campaign.replay import IDENTIFIED, RECORD, RIGID, ReplayRow
from plantar.campaign.tables import replay_table, simulator_table, table_1, table_2, table_3
from plantar.report.content import Table

ROW = ParameterBeside(
    "left", "pitch", "stiffness", "N.m/rad", 430.0, (428.0, 432.0), 434.0, -0.92, False, 460.0, 6.0, 0.125, 480.0, 0.5
)  # fmt: skip


def told(table: Table) -> dict[str, str]:
    """A row by its heads; heads that stand twice get a number."""
    found: dict[str, str] = {}
    for column, cell in zip(table.columns, table.rows[0], strict=True):
        name = column.heading
        found[f"{name} 2" if name in found else name] = cell.text
    return found


def test_a_parameter_stands_beside_truth_paper_and_the_papers_way() -> None:
    assert told(table_1([ROW])) == {
        "foot": "left", "axis": "pitch", "parameter": "K [N·m/rad]", "identified": "430.0 ± 2.0", "truth": "434.0",
        "error": "−0.92 %", "inside": "no", "paper's way": "460.0", "error 2": "+6.00 %", "claimed std": "0.12 %",
        "paper's robot": "480.0 (0.50 %)",
    }  # fmt: skip
    marks = [cell.mark for cell in table_1([ROW]).rows[0]]
    assert (marks[5], marks[8]) == ("good", "bad"), "within and beyond a per cent"


def test_the_mean_torque_of_a_robot_that_falls_in_one_motion_is_none() -> None:
    fallen = [
        ReplayRow("soft", motion, "left pitch torque", "N.m", error)
        for motion, error in (("a", 0.5), ("b", None))
    ]
    stood = [
        ReplayRow("hard", motion, "left pitch torque", "N.m", error)
        for motion, error in (("a", 0.5), ("b", 0.7))
    ]
    text = {row[0].text: row[7].text for row in simulator_table([*fallen, *stood]).rows}
    assert text == {"soft": "falls", "hard": "0.600"}


def test_direct_validation_stands_by_axis() -> None:
    rows = [DirectBeside("left", axis, error, 20.0, share, 1.5, 7.5, 6.54, 12.0)
            for axis, error, share in (("roll", 1.02, 5.1), ("pitch", 0.98, 4.9))]  # fmt: skip
    table = table_2(rows)
    assert [[cell.text for cell in row] for row in table.rows] == [
        ["pitch", "left", "0.980", "20.0", "4.9 %", "1.50", "7.5 %", "6.54", "12 %"],
        ["roll", "left", "1.02", "20.0", "5.1 %", "1.50", "7.5 %", "6.54", "12 %"],
    ]
    assert [row[4].mark for row in table.rows] == ["good", "bad"], "up to five per cent of the largest torque"
    assert [(column.heading, column.unit) for column in table.columns[2:6]] == [
        ("mean |error|", "N·m"), ("largest |torque|", "N·m"), ("of largest", ""), ("paper's way", "N·m"),
    ]  # fmt: skip


def test_replays_stand_motion_by_motion_in_milliradians() -> None:
    rows = [
        ReplayRow("soft", "b", "chest pitch", "rad", 0.00123),
        ReplayRow("soft", "a", "chest pitch", "rad", None),
        ReplayRow("hard", "b", "chest pitch", "rad", 0.5),
        ReplayRow("hard", "b", "left pitch torque", "N.m", 0.25),
    ]
    table = replay_table(rows)
    assert [[cell.text for cell in row] for row in table.rows] == [
        ["b", "soft", "1.23", "–"], ["b", "hard", "500", "0.250"], ["a", "soft", "falls", "–"],
    ]  # fmt: skip
    assert [(column.heading, column.unit) for column in table.columns] == [
        ("motion", ""), ("feet", ""), ("chest pitch", "mrad"), ("left pitch torque", "N·m"),
    ]  # fmt: skip
    assert table.folded


def test_all_tables_are_as_they_are_kept() -> None:
    """Their heads, units, cells and marks, and what stands below them."""
    unknown = replace(
        ROW, foot="right", name="damping", unit="N.m.s/rad", interval95=None, covered=None, published=None,
        paper_way=None, error_percent=None, paper_way_error_percent=7.0,
    )  # fmt: skip
    direct = [DirectBeside("left", axis, 0.98, 20.0, share, None, None, 6.54, 12.0) for axis, share in
              (("roll", 5.1), ("pitch", 4.9))]  # fmt: skip
    cross = [
        CrossBeside(motion, foot, axis, 0.2 + 0.1 * place, 0.35, None if place else 0.4, 1.5 * place or None)
        for place, (motion, foot, axis) in enumerate((
            ("squat", "left", "pitch"), ("squat", "left", "roll"), ("squat", "right", "pitch"),
            ("tilt", "left", "roll")))
    ]  # fmt: skip
    replayed = [
        ReplayRow(feet, motion, quantity, unit, None if (feet, motion) == (RIGID, "bow") else 0.01 * place + size)
        for place, feet in enumerate((IDENTIFIED, RIGID, RECORD), 1) for motion, size in (("a", 0.002), ("bow", 0.005))
        for quantity, unit in (("chest pitch", "rad"), ("chest roll", "rad"), ("left pitch torque", "N.m"))
    ]  # fmt: skip
    made = [
        table_1([ROW, unknown]),
        table_2(direct),
        table_3(cross),
        simulator_table(replayed),
        replay_table(replayed),
    ]
    assert_as_kept(described(made), Path(__file__).parent / "kept" / "tables.txt")
