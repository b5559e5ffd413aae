"""Tables of the campaign by hand: each number under its own head, half of an interval behind its ±."""

from __future__ import annotations

from plantar.campaign.compared import ParameterBeside
from plantar.campaign.replay import ReplayRow
from plantar.campaign.tables import simulator_table, table_1
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
