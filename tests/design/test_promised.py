"""What is promised of a number: the worst of all draws of the sensors, and of the neighbouring rehearsals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any
from unittest.mock import Mock, patch

import numpy as np
import pytest

import design_samples
from plantar.design.paper_motions import PaperMotions
from plantar.design.rehearsals.rehearsal import Rehearsal
from plantar.design.writing import promised
from plantar.motions.select_motions import Choice, Selection

LATE = 0.005  # s, in the preset of the rehearsals
ROLL = ("left", "roll", "stiffness")


def drawn(*values: float | None, feet: Sequence[str] = ("left",), axis: str = "roll") -> Rehearsal:
    """At twice the stiffness told, a result of each draw; None is one in which nothing was found."""
    results = []
    for value in values:
        rows = [Mock(foot=foot, axis=axis, value=value, verdict="usable") for foot in feet]
        for row in rows:
            row.name, row.interval95 = "stiffness", value and (value - 4.0, value + 4.0)
        results.append(None if value is None else Mock(parameters=rows))
    return Rehearsal(2.0, results=tuple(results))


def wide(*draws: tuple[float, float] | None, verdict: str = "usable") -> Rehearsal:
    """Half widths of the left and the right foot in each draw [%]."""
    results = []
    for draw in draws:
        rows = [
            Mock(
                foot=foot, axis="roll", value=100.0, interval95=(100.0 - half, 100.0 + half), verdict=verdict
            )
            for foot, half in zip(("left", "right"), draw or (), strict=draw is not None)
        ]
        for row in rows:
            row.name = "stiffness"
        results.append(None if draw is None else Mock(parameters=rows))
    return Rehearsal(1.0, results=tuple(results))


@pytest.mark.parametrize(
    ("played", "widths"),
    [
        (
            [wide((1.0, 1.5), (2.0, 1.0)), wide((3.0, 4.0)), wide((1.0, 1.0)), wide((1.0, 0.5))],
            [4.0, 4.0, 4.0, 1.0],
        ),
        ([wide((1.0, 1.0)), wide((1.0, 1.0), (9.0, 1.0), verdict="weak"), wide((2.0, 2.0))], [1.0, 9.0, 2.0]),
        ([wide((1.0, 1.0)), wide((5.0, 1.0), None), wide((2.0, 2.0)), wide(None)], [1.0, 5.0, 2.0, None]),
    ],
    ids=[
        "the widest of draws, feet and neighbours",
        "weak neighbours lend none",
        "nor those found in some draws",
    ],
)
def test_half_widths_are(played: list[Rehearsal], widths: list[float | None]) -> None:
    rehearsals = tuple(replace(one, factor=float(place)) for place, one in enumerate(played))
    found = promised.half_widths(
        replace(design_samples.unplayed(), rehearsals=rehearsals), "roll", "stiffness"
    )
    assert list(found.values()) == pytest.approx(widths)


def test_errors_of_both_feet_and_all_draws_tell_what_a_play_is_off_by() -> None:
    """Told 50, so 100 is true here: errors of 1, 1, 3 and 3 %, of which 1.96 times the root mean square."""
    one = drawn(101.0, 97.0, feet=("left", "right"))
    assert promised.errors(one, *ROLL, 50.0) == pytest.approx([1.0, -3.0])
    feet = ("left", "right")
    assert promised.error95(one, feet, "roll", "stiffness", 50.0) == pytest.approx(
        1.96 * np.sqrt(5.0), rel=1e-4
    )
    assert promised.error95(one, feet, "pitch", "stiffness", 50.0) is None


def test_a_floor_that_gives_way_in_rehearsals_is_no_error() -> None:
    """Spring and floor in series are softer by what the floor tilts for each radian of the spring."""
    one = replace(drawn(100.0 / 1.01), yields={("left", "roll"): 0.01})
    assert promised.errors(one, *ROLL, 50.0) == pytest.approx([0.0], abs=1e-9)


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


def test_of_the_papers_motions_the_best_is_written_to_its_end_and_promised_alone_and_with_others() -> None:
    """A plan of 2 s at 200 Hz, at 50 Hz; half widths of one axis of one foot and of the best set."""
    time = np.arange(401) / 200
    plan: Any = Mock(time=time, joints=("hip", "knee"), positions=np.column_stack([time, 3 - time]))
    plan.name = "tilt_A"
    keys = [("left", axis, name) for axis in ("pitch", "roll") for name in ("stiffness", "damping")]
    alone, pair = (
        Choice(motions, {key: percent + place for place, key in enumerate(keys)}, 1.0)
        for motions, percent in ((("tilt_A",), 5.0), (("sway", "tilt_A"), 1.0))
    )
    other = Choice(("sway",), dict.fromkeys(keys, 9.0), 1.0)
    found = PaperMotions(Selection((other, alone), (alone, pair), pair, None), {}, plan)
    log = found.log(50.0)
    assert log.name == "tilt_A"
    np.testing.assert_allclose(log.time, np.arange(101) / 50)
    np.testing.assert_allclose(log.column("joint.knee.position"), 3 - log.time)
    assert found.half_widths() == [
        {"foot": foot, "axis": axis, "name": name, "percent": 5.0 + place, "best_set_percent": 1.0 + place}
        for place, (foot, axis, name) in enumerate(keys)
    ]
