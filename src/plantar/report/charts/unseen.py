"""Walks that the fit has not seen: measured torque beside what the model says of it, one row a walk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.report.charts.chart import Chart, Panel, Scale, Text, ends, frame, line, thinned
from plantar.results.feet import FeetResult
from plantar.results.numbers import number
from plantar.results.residuals import Track

WIDTH = 600.0
LEFT, TOP, ROW, ROOM, BELOW = 62.0, 22.0, 78.0, 24.0, 36.0  # pixels: room above each row for its name
ACROSS: Final = 528.0
MOST_ROWS: Final = 6
MOST_POINTS: Final = 1500  # of each line


def unseen_charts(result: FeetResult, tracks: Sequence[Track]) -> list[Chart]:
    """A chart for each foot and axis that steps in a recording to validate with."""
    steps = {(row.motion, row.foot) for row in result.stances if row.role == "validate"}
    walks = [track for track in tracks if (track.motion, track.foot) in steps]
    charts = []
    for foot in dict.fromkeys(track.foot for track in walks):
        for axis in ROTATIONAL_AXES:
            own = [track for track in walks if track.foot == foot and f"{axis}.predicted" in track.values]
            own = [track for track in own if np.isfinite(track.values[f"{axis}.predicted"][track.used]).any()]
            if own:
                charts.append(_chart(result, own, axis))
    return charts


def _chart(result: FeetResult, tracks: Sequence[Track], axis: Axis) -> Chart:
    """`tracks` of one foot."""
    foot, drawn = tracks[0].foot, tracks[:MOST_ROWS]
    times = [track.time - track.time[track.used][0] for track in drawn]
    longest = max(time[track.used][-1] for time, track in zip(times, drawn, strict=True))
    x = Scale(0.0, float(longest), 0.0, ACROSS)
    shown = [np.where(track.used, track.values[f"{axis}.torque"], np.nan) for track in drawn]
    y = Scale(*ends(np.concatenate(shown)), ROW, 0.0)
    panels = []
    for place, (track, time, measured) in enumerate(zip(drawn, times, shown, strict=True)):
        top = TOP + place * (ROW + ROOM)
        model = np.where(track.used, track.values[f"{axis}.predicted"], np.nan)
        marks = [
            line(*thinned(x(time), y(values), MOST_POINTS), kind)
            for values, kind in ((measured, "measured"), (model, "model"))
        ]
        last = place == len(drawn) - 1
        where = (LEFT, top, ACROSS, ROW)
        paths, texts = frame(where, x, y, "time [s]" if last else "", "[N·m]", numbers=last)
        name = Text(track.motion, LEFT, top - 7, "start", kind="name")
        score = Text(_score(result, track.motion, foot, axis), LEFT + ACROSS, top - 7, "end")
        panels.append(Panel(*where, paths, (*texts, name, score), tuple(marks)))
    rest = len(tracks) - len(drawn)
    return Chart(
        title=f"{foot} {axis}: torque of unseen walks",
        legend=(("measured", "measured"), ("predicted", "model")),
        description=f"{foot} {axis}: measured and predicted torque over time in walks that the fit has not seen",
        width=WIDTH,
        height=TOP + len(drawn) * (ROW + ROOM) - ROOM + BELOW,
        panels=tuple(panels),
        remark=f"{rest} further unseen walks stand under Motions." if rest else "",
    )


def _score(result: FeetResult, motion: str, foot: str, axis: Axis) -> str:
    """What the model misses, and how much of what the offset alone does."""
    for row in result.validation:
        if (row.motion, row.foot, row.axis) == (motion, foot, axis) and row.zero_mean_abs > 0:
            share = number(row.mean_abs_error / row.zero_mean_abs, 2)
            return f"mean |error| {number(row.mean_abs_error, 3)} N·m, {share} of the offset's alone"
    return ""
