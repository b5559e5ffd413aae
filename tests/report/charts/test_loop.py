"""Torque over angle beside a verdict: without offsets, of fitted motions alone, with the line of K."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from plantar.report.charts.chart import Chart
from plantar.report.charts.loop import MOST_POINTS, loop_charts
from plantar.results.feet import AxisModel, Offset
from plantar.results.feet_rows import LinearEquivalent
from report_walks import STIFFNESS, standing_result, walk_result, walk_tracks


def points(chart: Chart, kind: str) -> np.ndarray:
    """Where a line of a chart goes, in pixels, (n, 2)."""
    (panel,) = chart.panels
    at, found = np.zeros(2), []
    for letter, x, y in re.findall(
        r"([Ml])(\S+?) ([-\d.e]+)", next(m.points for m in panel.marks if m.kind == kind)
    ):
        at = np.array([float(x), float(y)]) + (at if letter == "l" else 0)
        found.append(at)
    return np.array(found)


def slope(place: np.ndarray, chart: Chart) -> float:
    """Of a line in a chart [N·m/mrad], by the texts beside the grid."""
    (panel,) = chart.panels
    numbers = [
        (float(t.text.replace("−", "-")), t.x, t.y) for t in panel.texts if re.fullmatch(r"−?[\d.]+", t.text)
    ]
    across = [(value, x) for value, x, y in numbers if y > panel.top + panel.height + 5]
    up = [(value, y) for value, x, y in numbers if x < panel.left]
    per_x, per_y = ((b[0] - a[0]) / (b[1] - a[1]) for a, b in ((across[0], across[-1]), (up[0], up[-1])))
    return float(np.polyfit(place[:, 0], place[:, 1], 1)[0] * per_y / per_x)


def test_stances_lie_over_each_other_without_their_offsets() -> None:
    chart = loop_charts(walk_result(), walk_tracks())["left", "pitch"]
    assert chart.title == "Each stance less its offset"
    for kind in ("measured many", "model many", "straight"):
        assert slope(points(chart, kind), chart) == pytest.approx(1e-3 * STIFFNESS, rel=0.02), kind
    for kind in ("measured many", "model many"):
        place = points(chart, kind)
        away = place[:, 1] - np.polyval(np.polyfit(place[:, 0], place[:, 1], 1), place[:, 0])
        assert np.abs(away).max() < 1.0, f"{kind}: offsets would set stances apart by many pixels"


def test_a_foot_is_drawn_without_the_other() -> None:
    """The other one bends five times as far."""
    other = [
        replace(track, values={name: 5 * values for name, values in track.values.items()})
        for track in walk_tracks("right")
    ]
    alone, both = (loop_charts(walk_result(), tracks) for tracks in (walk_tracks(), [*walk_tracks(), *other]))
    assert both["left", "pitch"] == alone["left", "pitch"]


def test_what_was_not_fitted_or_not_used_is_not_drawn() -> None:
    tracks = walk_tracks()
    wild = replace(
        tracks[2], values=tracks[2].values | {"pitch.deflection": np.full(len(tracks[2].time), 5.0)}
    )
    assert loop_charts(walk_result(), [*tracks[:2], wild]) == loop_charts(walk_result(), tracks[:2])
    assert loop_charts(walk_result(), [wild]) == {}
    nothing = [replace(track, used=np.zeros(len(track.time), dtype=bool)) for track in tracks]
    assert loop_charts(walk_result(), nothing) == {}


def test_residuals_without_offsets_take_those_of_the_result() -> None:
    (track,) = walk_tracks(motions=["walk_1"])
    first = track.time < 0.5  # one stance: its offset is the motion's
    values = {key: column for key, column in track.values.items() if not key.endswith("offset")}
    bare = replace(track, used=track.used & first, values=values)
    result = replace(standing_result(), offsets=(Offset("left", "pitch", "walk_1", "N.m", 3.0, 0.1),))
    charts = loop_charts(result, [bare])
    assert list(charts) == [("left", "pitch")], "nothing is known of the roll offset"
    assert charts["left", "pitch"].title == "Each motion less its offset"
    kept = replace(track, used=track.used & first)
    assert points(charts["left", "pitch"], "model many") == pytest.approx(
        points(loop_charts(result, [kept])["left", "pitch"], "model many"), abs=0.11
    )


def test_k_that_may_not_be_used_has_no_line_and_a_richer_model_the_nearest_one() -> None:
    result = walk_result()
    unknown = [replace(row, verdict="unidentifiable") for row in result.parameters]
    chart = loop_charts(replace(result, parameters=tuple(unknown)), walk_tracks())["left", "pitch"]
    assert "straight" not in [mark.kind for mark in chart.panels[0].marks]
    richer = AxisModel("left", "pitch", "elastoplastic", "", LinearEquivalent(900.0, 1.0))
    chart = loop_charts(replace(result, models=(richer,)), walk_tracks())["left", "pitch"]
    assert slope(points(chart, "straight"), chart) == pytest.approx(0.9, rel=0.02)
    assert chart.legend[-1] == ("linear K", "straight")


def test_the_line_of_k_lies_in_loops_that_a_load_beside_the_centre_shifts() -> None:
    torques = ("pitch.torque", "pitch.predicted")
    tracks = [
        replace(track, values=track.values | {name: track.values[name] + 7.0 for name in torques})
        for track in walk_tracks()
    ]
    chart = loop_charts(walk_result(), tracks)["left", "pitch"]
    loop, straight = (points(chart, kind) for kind in ("measured many", "straight"))
    level = np.interp(loop[:, 0], *straight.T)
    assert abs(np.mean(level - loop[:, 1])) < 1.0


def test_a_long_campaign_stays_within_its_points() -> None:
    (track,) = walk_tracks(motions=["walk_1"])
    time = np.arange(0, 600, 0.005)
    angle = 0.02 * np.sin(time) * np.sin(0.1 * time)
    values = {"pitch.deflection": angle, "pitch.torque": 500 * angle, "pitch.predicted": 500 * angle,
              "pitch.offset": 0 * time}  # fmt: skip
    long = replace(track, time=time, used=np.ones(len(time), dtype=bool), values=values)
    chart = loop_charts(walk_result(), [long])["left", "pitch"]
    assert 300 < len(points(chart, "measured many")) <= MOST_POINTS


def test_a_track_that_lacks_torques_or_angles_of_an_axis_has_no_loop() -> None:
    (track,) = walk_tracks(motions=["walk_1"])
    for missing in ("pitch.torque", "pitch.deflection"):
        less = replace(track, values={name: one for name, one in track.values.items() if name != missing})
        assert ("left", "pitch") not in loop_charts(walk_result(), [less])
