"""The charts of walks: every stance and walk at its stiffness, every swing at its zero, unseen walks by row."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from plantar.report.charts import strips, unseen, zeros
from plantar.report.charts.chart import Band, Chart, Dot, Path
from plantar.report.charts.strips import strip_charts
from plantar.report.charts.unseen import unseen_charts
from plantar.report.charts.zeros import zero_charts
from report_walks import STANCES, STIFFNESS, standing_result, walk_result, walk_tracks


def dots(chart: Chart, kind: str) -> list[Dot]:
    return [mark for mark in chart.panels[0].marks if isinstance(mark, Dot) and mark.kind == kind]


def number_at(chart: Chart, y: float) -> float:
    """The number at a height of the first panel, by the texts beside its grid."""
    panel = chart.panels[0]
    texts = [text for text in panel.texts if text.x < panel.left and text.anchor == "end" and not text.turned]
    ticks = sorted((text.y - 4 - panel.top, float(text.text.replace("−", "-"))) for text in texts)
    return float(np.interp(y, [at for at, _ in ticks], [value for _, value in ticks]))


def test_stances_walks_and_all_together_stand_at_their_stiffness() -> None:
    pitch, roll = strip_charts(walk_result())
    assert [chart.title.split(":")[0] for chart in (pitch, roll)] == ["left pitch", "left roll"]
    fitted, not_seen = dots(pitch, "stance fit"), dots(pitch, "stance validate")
    assert (len(fitted), len(not_seen)) == (2 * STANCES, STANCES)
    assert [number_at(pitch, dot.y) for dot in fitted[:STANCES]] == pytest.approx(
        [STIFFNESS + 10 * k for k in range(STANCES)], abs=0.5
    )
    says = [row.share for row in walk_result().stances if (row.foot, row.axis) == ("left", "pitch")][:STANCES]
    assert says[4] > says[0]
    areas = [dot.radius**2 for dot in fitted[:STANCES]]  # one that says more is larger by as much
    assert [area / areas[0] for area in areas] == pytest.approx([share / says[0] for share in says])
    assert fitted[4].hover == "walk_1, 4.00 to 4.49 s: K = 540.0 N·m/rad"
    walks = dots(pitch, "walk fit") + dots(pitch, "walk validate")
    assert [number_at(pitch, dot.y) for dot in walks] == pytest.approx(3 * [STIFFNESS + 5], abs=0.5)
    assert walks[0].hover == "walk_1 alone, 5 stances: K = 505 ± 20 N·m/rad"
    (band,) = (mark for mark in pitch.panels[0].marks if isinstance(mark, Band))
    assert number_at(pitch, band.y) == pytest.approx(STIFFNESS + 8, abs=0.5)
    assert number_at(pitch, band.y + band.height) == pytest.approx(STIFFNESS - 8, abs=0.5)
    assert ("all together: 500 ± 8 N·m/rad", "pooled") in pitch.legend


def test_a_stance_that_says_little_does_not_set_the_scale() -> None:
    result = walk_result()
    wild = replace(result.stances[0], stiffness=-9000.0, share=1e-4)
    chart = strip_charts(replace(result, stances=(wild, *result.stances[1:])))[0]
    assert number_at(chart, chart.panels[0].height) > STIFFNESS - 30
    lowest = max(dots(chart, "stance fit"), key=lambda dot: dot.y)
    assert lowest.y == pytest.approx(chart.panels[0].height - 2)
    assert "−9000" in lowest.hover
    assert chart.remark == "Stances whose K is beyond the scale of this plot, drawn at its edge: 1."


def test_a_walk_that_says_little_does_not_set_the_scale_either() -> None:
    result = walk_result()
    wide = replace(result.walks[0], interval95=(STIFFNESS - 9000, STIFFNESS + 9000))
    chart = strip_charts(replace(result, walks=(wide, *result.walks[1:])))[0]
    height = chart.panels[0].height
    assert number_at(chart, height) > STIFFNESS - 60, "as far as stances scatter: by 40 N·m/rad"
    assert number_at(chart, 0.0) < STIFFNESS + 60
    bars = [
        mark.points for mark in chart.panels[0].marks if isinstance(mark, Path) and mark.kind == "walk fit"
    ]
    assert bars[0].endswith(f" {height + 9:.1f}V-9.0"), "cut off at both edges"


def test_strips_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strips, "MOST_STANCES", 6)
    monkeypatch.setattr(strips, "MOST_WALKS", 2)
    chart = strip_charts(walk_result())[0]
    assert len(dots(chart, "stance fit")) <= 6
    assert "The first 2 of 3 recordings." in chart.remark
    assert "The 6 stances that say most, of 15." in chart.remark


def test_zeros_of_swings_stand_where_they_were_read() -> None:
    force, torque = zero_charts(walk_result().swing_zeros)
    vertical = dots(force, "component z")
    assert [number_at(force, dot.y) for dot in vertical[:STANCES]] == pytest.approx(
        [-40.0 + k for k in range(STANCES)], abs=0.5
    )
    assert np.all(np.diff([dot.x for dot in vertical]) > 0), "recordings stand one after the other"
    assert len(dots(torque, "component x")) == 3 * STANCES
    assert vertical[0].hover.endswith("s: −40.0 N")
    assert all(dot.hover.endswith(" N·m") for dot in dots(torque, "component x"))
    for chart, unit in ((force, "[N]"), (torque, "[N·m]")):
        assert any(text.text.endswith(unit) for text in chart.panels[0].texts)
    taken = [mark for mark in force.panels[0].marks if isinstance(mark, Path) and mark.kind == "component z"]
    assert len(taken) == 3
    assert number_at(force, float(taken[0].points[1:].split("l")[0].split()[1])) == pytest.approx(
        -38.0, abs=0.5
    )
    assert zero_charts([]) == []


def test_lines_part_the_recordings() -> None:
    (force, _) = zero_charts(walk_result().swing_zeros)
    at = [dot.x for dot in dots(force, "component z")]
    lines = [
        float(mark.points[1:].split()[0])
        for mark in force.panels[0].marks
        if getattr(mark, "kind", "") == "grid"
    ]
    parted = [[line for line in lines if before < line < after] for before, after in pairwise(at)]
    assert [len(each) for each in parted] == [int((place + 1) % STANCES == 0) for place in range(len(at) - 1)]
    for (line,), place in zip(
        (each for each in parted if each), range(STANCES - 1, len(at) - 1, STANCES), strict=True
    ):
        assert line == pytest.approx((at[place] + at[place + 1]) / 2), "in the middle of the gap"


def test_of_many_swings_every_few_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = walk_result().swing_zeros
    monkeypatch.setattr(zeros, "MOST_SWINGS", len(rows) - 1)
    (force, _) = zero_charts(rows)
    assert len(dots(force, "component z")) == (len(rows) + 1) // 2
    assert dots(force, "component z")[-1].hover.startswith(f"{rows[-1].motion}, ")


def test_each_recording_begins_where_the_one_before_it_ends_whatever_its_clock_says() -> None:
    """Of two that last 4 s and 2 s, the gap between them a share of both: 6 % of 6 s."""
    first = walk_result().swing_zeros[0]
    rows = [
        replace(first, motion=motion, time=time)
        for motion, times in (("a", (100.0, 101.0, 104.0)), ("b", (7.0, 9.0)))
        for time in times
    ]
    (force, _) = zero_charts(rows)
    at = np.array([dot.x for dot in dots(force, "component z")])
    seconds = np.array([0.0, 1.0, 4.0, 4.36, 6.36])
    np.testing.assert_allclose((at - at[0]) / (at[-1] - at[0]), seconds / 6.36, atol=1e-3)


def test_one_swing_is_a_chart_too() -> None:
    (force, _) = zero_charts(walk_result().swing_zeros[:1])
    assert len(dots(force, "component y")) == 1


def test_unseen_walks_alone_are_drawn_with_their_score() -> None:
    charts = unseen_charts(walk_result(), walk_tracks())
    assert [chart.title for chart in charts] == [
        f"left {axis}: torque of unseen walks" for axis in ("pitch", "roll")
    ]
    (panel,) = charts[0].panels
    texts = [text.text for text in panel.texts]
    assert "walk_3" in texts
    assert "mean |error| 0.500 N·m, 0.10 of the offset's alone" in texts
    assert [mark.kind for mark in panel.marks] == ["measured", "model"]
    measured, model = (mark.points.count("M") for mark in panel.marks)
    assert measured == model == STANCES, "the air is a gap"
    assert unseen_charts(walk_result(), walk_tracks(motions=["walk_1", "walk_2"])) == []
    assert unseen_charts(standing_result(), walk_tracks()) == []


def test_unseen_walks_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unseen, "MOST_ROWS", 1)
    result = walk_result()
    twice = [
        *walk_tracks(motions=["walk_3"]),
        *(replace(t, motion="walk_4") for t in walk_tracks(motions=["walk_3"])),
    ]
    more = [replace(row, motion="walk_4") for row in result.stances if row.role == "validate"]
    charts = unseen_charts(replace(result, stances=(*result.stances, *more)), twice)
    assert [len(chart.panels) for chart in charts] == [1, 1]
    assert charts[0].remark == "1 further unseen walks stand under Motions."


def test_an_edge_parts_fitted_walks_from_unseen_ones() -> None:
    result = walk_result()
    for kept in (("walk_2", "walk_3"), ("walk_1", "walk_2", "walk_3")):
        stances = [row for row in result.stances if row.motion in kept]
        chart = strip_charts(replace(result, stances=tuple(stances)))[0]
        (edge,) = (mark for mark in chart.panels[0].marks if isinstance(mark, Path) and mark.kind == "edge")
        at = float(edge.points[1:].split()[0])
        assert max(dot.x for dot in dots(chart, "stance fit")) < at
        assert at < min(dot.x for dot in dots(chart, "stance validate"))
