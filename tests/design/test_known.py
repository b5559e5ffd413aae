"""What an earlier result knows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.conventions import NORMAL95
from plantar.design.known import WIDER, Known
from plantar.errors import DataError
from plantar.results.feet import FeetResult, Parameter


def found() -> FeetResult:
    rows = []
    for foot, axis, value in (("left", "pitch", 400.0), ("left", "roll", 300.0), ("right", "pitch", 500.0)):
        for name, share, width in (("stiffness", 1.0, 0.02), ("damping", 0.04, 0.1)):
            middle = share * value
            ends = (middle * (1 - width), middle * (1 + width))
            rows.append(Parameter(foot, axis, name, "", middle, 0.0, ends, 0.0, "usable", "", ""))
    return FeetResult("a robot", (), {}, "kelvin_voigt", tuple(rows), (), (), (), ())


def test_range_and_deviations_come_from_the_intervals() -> None:
    result = found()
    rows = [
        row for row in result.parameters if row.axis != "z" and row.name == "stiffness" and row.interval95
    ]
    known = Known.of(result)
    assert known.stiffness == pytest.approx(np.exp(np.mean([np.log(row.value) for row in rows])))
    assert known.high == pytest.approx(WIDER * max(row.interval95[1] for row in rows))
    assert known.low == pytest.approx(min(row.interval95[0] for row in rows) / WIDER)
    row = rows[0]
    deviation = (row.interval95[1] - row.interval95[0]) / 2 / NORMAL95
    assert known.deviations[row.foot, row.axis][0] == pytest.approx(deviation)
    precision = known.precision((row.foot, "other"))
    assert precision[0, ("pitch", "roll").index(row.axis), 0, 0] == pytest.approx(deviation**-2)
    assert not precision[1].any()


def test_a_result_without_numbers_is_refused() -> None:
    result = found()
    empty = replace(
        result, parameters=tuple(replace(row, verdict="unidentifiable") for row in result.parameters)
    )
    with pytest.raises(DataError, match="no stiffness and damping that could be used"):
        Known.of(empty)
