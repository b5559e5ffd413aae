"""Results beside the truth and the paper: errors signed, motions weighed, the paper's tables as printed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from plantar.campaign.compared import cross_beside, direct_beside, parameters_beside
from plantar.campaign.paper import TABLE_1, TABLE_2, TABLE_3
from plantar.campaign.tables import table_1, table_3
from plantar.results.feet import FeetResult, Parameter, ValidationRow
from plantar.twin import PAPER


def test_the_paper_tables_agree_with_themselves() -> None:
    assert len(TABLE_1) == 12
    for row in TABLE_2.values():
        assert 100 * row.mean_abs_error / row.max_abs == pytest.approx(row.percent_of_max, abs=0.06)
    assert sum(len(cells) for cells in TABLE_3.values()) == 16
    for foot, bush in PAPER.items():
        for axis in ("pitch", "roll"):
            assert TABLE_1[foot, axis, "stiffness"].value == getattr(bush, f"{axis}_stiffness")
            assert TABLE_1[foot, axis, "damping"].value == getattr(bush, f"{axis}_damping")


def parameter(name: str, value: float, half: float) -> Parameter:
    interval = (value - half, value + half)
    return Parameter("right", "pitch", name, "N.m/rad", value, half / 2, interval, 0.1, "usable", "because")


def validation(kind: Any, motion: str, error: float, largest: float, samples: int) -> ValidationRow:
    return ValidationRow(kind, motion, "right", "pitch", error, error, largest, 1.0, 9.0, samples)


def result(*rows: ValidationRow, stiffness: float = 440.0) -> FeetResult:
    parameters = (parameter("stiffness", stiffness, 5.0), parameter("damping", 15.89, 1.0))
    return FeetResult("twin", (), {}, "kelvin_voigt", parameters, (), (), rows, ())


def test_errors_are_signed_and_in_percent_of_the_truth() -> None:
    stiffness, damping = parameters_beside(result(), result(stiffness=430.0), PAPER)
    assert stiffness.error_percent == pytest.approx(100 * 6 / 434)
    assert stiffness.paper_way_error_percent == pytest.approx(-100 * 4 / 434)
    assert (stiffness.covered, damping.covered) == (False, True)
    unknown = replace(parameter("stiffness", 440.0, 5.0), interval95=None)
    (row,) = parameters_beside(replace(result(), parameters=(unknown,)), result(), PAPER)
    assert row.covered is None, "no interval, no claim"
    table = table_1([stiffness, damping])
    assert [cell.mark for cell in (table.rows[0][5], table.rows[1][5])] == ["bad", "good"]
    assert table.rows[0][10].text == "434.0 (0.20 %)"


def test_direct_validation_weighs_motions_by_their_samples() -> None:
    ours = result(validation("direct", "a", 1.0, 10.0, 100), validation("direct", "b", 4.0, 40.0, 300))
    (row,) = direct_beside(ours, replace(ours, validation=()))
    assert row.mean_abs_error == pytest.approx(3.25)
    assert row.percent_of_max == pytest.approx(100 * 3.25 / 40)
    assert (row.published, row.paper_way) == (6.54, None)


def test_cross_validation_puts_the_papers_motions_first() -> None:
    ours = result(validation("cross", "Tilt2", 0.1, 9.0, 10), validation("cross", "Squat", 0.3, 9.0, 10))
    squat, tilt = cross_beside(ours, ours)
    assert (squat.motion, squat.published, tilt.published) == ("Squat", 0.38, None)
    assert [row[2].mark for row in table_3([squat, tilt]).rows] == [
        "weak",
        "",
    ]  # more than half of the paper's
