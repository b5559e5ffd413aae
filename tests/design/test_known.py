"""What an earlier result knows."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from plantar.conventions import NORMAL95
from plantar.design.known import Known
from plantar.errors import DataError
from plantar.results.feet import Diagnosis, FeetResult, Parameter

SPRING = 0.5
WIDER = 1.1


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


def test_a_weak_stiffness_widens_the_range_and_is_not_believed() -> None:
    """What it misses may be an element that did not slip: the spring alone is softer."""
    result, known = found(), Known.of(found())
    weak = tuple(
        replace(row, verdict="weak") if (row.foot, row.axis) == ("right", "pitch") else row
        for row in result.parameters
    )
    less = Known.of(replace(result, parameters=weak))
    assert less.stiffness == pytest.approx(np.sqrt(400.0 * 300.0))
    assert less.damping == pytest.approx(0.04 * less.stiffness)
    assert (less.low, less.high) == pytest.approx((SPRING * 490.0 / WIDER, known.high))
    assert np.isinf(less.deviations["right", "pitch"]).all()
    assert np.isfinite(less.deviations["left", "pitch"]).all()
    nothing = tuple(replace(row, verdict="weak") for row in result.parameters)
    assert Known.of(replace(result, parameters=nothing)).stiffness == pytest.approx(known.stiffness)


OTHERS: tuple[dict[str, Any], ...] = ({"foot": "right"}, {"axis": "pitch"}, {"name": "damping"})


def test_intervals_that_reach_below_zero_say_how_high_and_the_value_how_low() -> None:
    rows = tuple(
        replace(row, value=200.0, verdict="weak", interval95=(-10.0, 400.0))
        if row.name == "stiffness"
        else row
        for row in found().parameters
    )
    known = Known.of(replace(found(), parameters=rows))
    assert (known.stiffness, known.low, known.high) == pytest.approx((200.0, 200.0 / WIDER, 400.0 * WIDER))


def test_what_may_be_an_element_makes_no_spring_stiffer() -> None:
    """Found: 300 in roll, of which an element makes up to 40 %; the sum is sure to 3 %. Pitch shows the element."""
    result, low, share = found(), 0.6 * 300.0, 1.0 - (0.03 / 0.4) ** 2
    rows = [
        replace(row, verdict="weak", interval95=(low, 1.4 * 300.0))
        if (row.axis, row.name) == ("roll", "stiffness")
        else row
        for row in result.parameters
    ]
    rows += [
        Parameter("left", "pitch", name, "", value, 0.0, None, 0.0, "usable", "")
        for name, value in (("slip_torque", 1.2), ("slip_angle", 0.012))
    ]
    hidden = Diagnosis(
        "left", "roll", "stiffness", "hidden memory", {"hidden memory": share}, 40.0, "", advice=""
    )
    usable = [row for row in rows if (row.name, row.verdict) == ("stiffness", "usable")]
    stiffest = max(row.interval95[1] for row in usable if row.interval95)
    of_others = tuple(replace(hidden, **other, variance_shares={"hidden memory": 0.5}) for other in OTHERS)
    known = Known.of(replace(result, parameters=tuple(rows), diagnosis=(hidden,)))
    assert known.element == pytest.approx(
        [100.0, 50.0]
    )  # of roll: in the proportion of what rubber usually has
    assert known.low == pytest.approx(low / WIDER)  # the interval holds the element
    assert known.high == pytest.approx(WIDER * stiffest)  # not the weak interval's 420
    softer = tuple(
        replace(row, value=200.0, interval95=(196.0, 204.0)) if row in usable else row for row in rows
    )
    known = Known.of(replace(result, parameters=softer, diagnosis=(*of_others, hidden)))
    assert known.high == pytest.approx(WIDER * (1.03 * 300.0 - 50.0))
    alone = tuple(row for row in rows if row not in usable)
    known = Known.of(replace(result, parameters=alone, diagnosis=(hidden,)))
    assert known.high == pytest.approx(WIDER * known.stiffness)  # never below what is designed for
    no_element = Known.of(replace(result, parameters=tuple(rows[:-2]), diagnosis=(hidden,)))
    assert no_element.element is None
    assert no_element.low == pytest.approx(SPRING * low / WIDER)


@pytest.mark.parametrize(
    "wrong", [{"verdict": "unidentifiable"}, {"value": 0.0}, {"value": None}, {"interval95": None}]
)
def test_a_result_without_numbers_is_refused(wrong: dict[str, Any]) -> None:
    result = found()
    empty = replace(result, parameters=tuple(replace(row, **wrong) for row in result.parameters))
    with pytest.raises(
        DataError,
        match=r"^the result has no stiffness and damping that could be used \(valid: a result with "
        r"some, or --stiffness without --after\)$",
    ):
        Known.of(empty)
