"""What is promised of a number: the worst of all draws of the sensors, and of the neighbouring rehearsals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from unittest.mock import Mock, patch

import numpy as np
import pytest

import design_samples
from plantar.design.rehearsal import Rehearsal
from plantar.design.writing import promised

LATE = 0.005  # s, in the preset of the rehearsals
ROLL = ("left", "roll", "stiffness")


def drawn(
    *values: float | None, half: float = 4.0, feet: Sequence[str] = ("left",), axis: str = "roll"
) -> Rehearsal:
    """At twice the stiffness told, a result of each draw; None is one in which nothing was found."""
    results = []
    for value in values:
        rows = [Mock(foot=foot, axis=axis, value=value, verdict="usable") for foot in feet]
        for row in rows:
            row.name, row.interval95 = "stiffness", value and (value - half, value + half)
        results.append(None if value is None else Mock(parameters=rows))
    return Rehearsal(2.0, results=tuple(results))


def test_a_half_width_is_the_widest_of_all_draws_of_both_feet_and_of_the_neighbours() -> None:
    found = design_samples.designed()
    factors = [one.factor for one in found.rehearsals]
    widths = [1.0, 2.0, 3.0, None, 1.5, 0.5]
    played = [
        replace(drawn(None if wide is None else 100.0, 100.0, half=wide or 0.0), factor=factor)
        for factor, wide in zip(factors, widths, strict=True)
    ]
    played[3] = replace(played[3], results=(None,))
    wider, opposite = drawn(100.0, half=1.7), drawn(100.0, half=2.5, feet=("right",))
    played[4] = replace(played[4], results=(*played[4].results, *wider.results))
    of_each = promised.half_widths(replace(found, rehearsals=tuple(played)), "roll", "stiffness")
    assert of_each == pytest.approx(dict(zip(factors, [2.0, 3.0, 3.0, None, 1.7, 1.7], strict=True)))
    played[5] = replace(played[5], results=(*played[5].results, *opposite.results))
    of_each = promised.half_widths(replace(found, rehearsals=tuple(played)), "roll", "stiffness")
    assert of_each == pytest.approx(dict(zip(factors, [2.0, 3.0, 3.0, None, 2.5, 2.5], strict=True)))


def test_errors_of_both_feet_and_all_draws_tell_what_a_play_is_off_by() -> None:
    """Told 50, so 100 is true here: errors of 1, 1, 3 and 3 %, of which 1.96 times the root mean square."""
    one = drawn(101.0, 97.0, feet=("left", "right"))
    assert promised.errors(one, *ROLL, 50.0) == pytest.approx([1.0, -3.0])
    feet = ("left", "right")
    assert promised.error95(one, feet, "roll", "stiffness", 50.0) == pytest.approx(
        1.96 * np.sqrt(5.0), rel=1e-4
    )
    assert promised.error95(one, feet, "pitch", "stiffness", 50.0) is None


def test_a_number_is_usable_where_every_draw_says_so() -> None:
    assert promised.usable(drawn(100.0, 101.0), *ROLL)
    assert not promised.usable(drawn(100.0, None), *ROLL)
    weak = drawn(100.0, 101.0)
    weak.results[1].parameters[0].verdict = "weak"  # type: ignore[union-attr]
    assert not promised.usable(weak, *ROLL)
    assert not promised.usable(Rehearsal(1.0), *ROLL)


def test_the_delay_is_that_of_the_worst_draw() -> None:
    def late(value: float, std: float, measured: bool = True) -> Mock:
        return Mock(sensor_delay=Mock(wrench_delay=value, std=std, measured=measured))

    shown = Rehearsal(1.0, results=(late(LATE + 1e-4, 2e-4), late(LATE - 3e-4, 1e-4)))
    assert promised.delay(shown) == pytest.approx((1.96 * 2e-4, -3e-4), rel=1e-4)
    assert (
        promised.delay(replace(shown, results=(late(LATE, 1e-4), late(LATE, 1e-4, measured=False)))) is None
    )
    assert promised.delay(replace(shown, results=(late(LATE, 1e-4), None))) is None
    assert promised.delay(Rehearsal(1.0)) is None


def test_the_sum_of_vertical_compliances_is_that_of_the_worst_draw() -> None:
    """1/100 from both feet where 1/100 is true, and 2 % too little with 102; intervals of 4 in 100."""
    feet = ("left", "right")
    half, error = promised.vertical(drawn(100.0, 102.0, feet=feet, axis="z"), 100.0) or (0.0, 0.0)
    assert half == pytest.approx(50 * (1 / 96 - 1 / 104) * 100)
    assert error == pytest.approx(100 * (100 / 102 - 1))
    assert promised.vertical(drawn(100.0, axis="z"), 100.0) is None, "of one foot alone"
    with patch.object(Rehearsal, "feet_found", lambda *_: ()):
        assert promised.vertical(Rehearsal(1.0), 100.0) is None
