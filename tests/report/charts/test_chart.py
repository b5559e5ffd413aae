"""Scales, ticks and lines of charts, by value."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.report.charts.chart import Scale, ends, line, room_below, round_step, slanted, thinned


@pytest.mark.parametrize(
    ("least", "step"), [(0.7, 1.0), (1.0, 1.0), (1.2, 2.0), (2.1, 5.0), (37.0, 50.0), (0.011, 0.02)]
)
def test_steps_of_a_scale_are_round(least: float, step: float) -> None:
    assert round_step(least) == pytest.approx(step)


def test_ticks_stand_where_their_numbers_are() -> None:
    scale = Scale(-1.0, 3.0, 200.0, 0.0)
    assert [text for _, text in scale.ticks(4)] == ["−1", "0", "1", "2", "3"]
    assert {text: at for at, text in scale.ticks(4)}["2"] == pytest.approx(50.0)
    assert [text for _, text in Scale(0.0, 0.1, 0.0, 1.0).ticks(5)] == [
        "0.00",
        "0.02",
        "0.04",
        "0.06",
        "0.08",
        "0.10",
    ]


def test_a_scale_shows_all_that_is_finite() -> None:
    low, high = ends(np.array([np.nan, 2.0, 4.0, np.inf]))
    assert 1.8 < low < 2.0
    assert 4.0 < high < 4.2
    for values in ([], [np.nan], [0.0], [5.0, 5.0]):
        low, high = ends(np.array(values))
        assert low < high


def test_a_line_has_gaps_where_nothing_is_known() -> None:
    x, y = np.array([1.0, 2.0, 3.0, 4.04, 5.0]), np.array([1.0, 1.5, np.nan, -3.0, -3.0])
    assert line(x, y, "model").points == "M1 1l1 0.5M4 -3l1 0"
    assert line(x[:0], y[:0], "model").points == ""


def test_steps_of_a_line_do_not_add_up_their_rounding() -> None:
    x = np.linspace(0.0, 100.0, 3001)
    numbers = line(x, x, "model").points.replace("M", "").split("l")
    assert sum(float(step.split()[0]) for step in numbers) == pytest.approx(100.0, abs=0.06)


def test_thinned_lines_keep_their_shape_and_their_bound() -> None:
    angle = np.linspace(0, 40 * np.pi, 50_000)
    x, y = 100 * np.cos(angle), 100 * np.sin(angle)
    x[20_000:20_010] = np.nan
    few_x, few_y = thinned(x, y, 900)
    assert 300 < len(few_x) <= 900
    known = np.isfinite(few_x)
    assert np.count_nonzero(~known) == 1, "one gap stays one gap"
    assert np.hypot(few_x, few_y)[known] == pytest.approx(100.0)
    assert np.nanmin(few_x) < -95
    same = thinned(x[::4777], y[::4777], 900)
    assert len(same[0]) == len(x[::4777])


def test_level_and_upright_lines_keep_the_points_of_each_square() -> None:
    """Of four points in each square of half a pixel one is left, whichever way the line goes."""
    goes, stays = 0.5 * np.repeat(np.arange(20.0), 4), np.full(80, 3.0)
    for x, y in ((goes, stays), (stays, goes), (goes, goes)):
        left, right = thinned(x, y, 100)
        np.testing.assert_array_equal([left, right], [x[::4], y[::4]])


def test_a_long_name_is_cut_and_has_its_room() -> None:
    assert slanted("step_12_no_fall_1_again", 0.0, 0.0).text == "step_12_no_fall_1…"
    assert (
        room_below(["walk", "a"])
        < room_below(["a_walk_of_ten"])
        < room_below(["x" * 18])
        == room_below(["x" * 90])
    )
