"""Torque over angle of one foot and axis, all fitted motions over each other: the picture beside a verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.models import KelvinVoigt
from plantar.report.charts.chart import Chart, Panel, Scale, ends, frame, line, thinned
from plantar.results.feet import FeetResult
from plantar.results.residuals import Track

WIDTH, HEIGHT = 300.0, 240.0
PLACE: Final = (50.0, 8.0, 240.0, 190.0)  # left, top, width, height of the panel
LINEAR, NEAREST = "K", "linear K"  # names of the straight line
RATE: Final = 50.0  # Hz of the samples that are drawn: the fit's filter has left nothing faster
MOST_POINTS: Final = 2500  # of the measured torque, and as many of the model's


def loop_charts(result: FeetResult, tracks: Sequence[Track]) -> dict[tuple[str, str], Chart]:
    """A chart for each foot and axis of which a fitted motion has samples, by foot and axis."""
    made: dict[tuple[str, str], Chart] = {}
    for foot in dict.fromkeys(track.foot for track in tracks):
        for axis in ROTATIONAL_AXES:
            chart = _chart(result, [track for track in tracks if track.foot == foot], axis)
            if chart is not None:
                made[foot, axis] = chart
    return made


def _chart(result: FeetResult, tracks: Sequence[Track], axis: Axis) -> Chart | None:
    """`tracks` of one foot."""
    foot = tracks[0].foot
    offsets = {row.motion: row.value for row in result.offsets if (row.foot, row.axis) == (foot, axis)}
    loops = [loop for track in tracks for loop in _loop(track, axis, offsets)]
    if not loops:
        return None
    angle, measured, model = (np.concatenate(column) for column in zip(*loops, strict=True))
    left, top, width, height = PLACE
    x, y = Scale(*ends(angle), 0.0, width), Scale(*ends(measured), height, 0.0)
    marks = [
        line(*thinned(x(angle), y(values), MOST_POINTS), kind)
        for values, kind in ((model, "model many"), (measured, "measured many"))
    ]
    legend = [("measured", "measured"), ("model", "model")]
    slope, name = _straight(result, foot, axis)
    if slope is not None:
        reach = np.array([x.low, x.high])
        # Not through zero: a bush that is put right turns by its load as well, beside the angle.
        through = float(np.nanmean(angle)), float(np.nanmean(measured))
        marks.append(line(x(reach), y(through[1] + 1e-3 * slope * (reach - through[0])), "straight"))
        legend.append((name, "straight"))
    steps = any((row.foot, row.axis) == (foot, axis) for row in result.stances)
    paths, texts = frame(PLACE, x, y, f"{axis} angle [mrad]", "torque [N·m]")
    return Chart(
        title=f"Each {'stance' if steps else 'motion'} less its offset",
        legend=tuple(legend),
        description=f"{foot} {axis}: torque over angle of all fitted motions, measured and by the model",
        width=WIDTH,
        height=HEIGHT,
        panels=(Panel(left, top, width, height, paths, texts, tuple(marks)),),
    )


def _loop(track: Track, axis: Axis, offsets: Mapping[str, float]) -> list[tuple[Array, Array, Array]]:
    """Angle [mrad], measured and reconstructed torque [N·m] of a fitted motion's used samples, a gap between its runs;
    both torques without the offset. Empty where the motion was not fitted."""
    values = track.values
    if track.role == "validate" or f"{axis}.torque" not in values or f"{axis}.deflection" not in values:
        return []
    nothing = np.full(len(track.time), offsets.get(track.motion, np.nan))
    offset = values.get(f"{axis}.offset", nothing)
    angle, torque = 1e3 * values[f"{axis}.deflection"], values[f"{axis}.torque"] - offset
    shown = track.used & np.isfinite(angle + torque)
    if not shown.any():
        return []
    model = values.get(f"{axis}.predicted", np.full(len(track.time), np.nan))
    every = max(1, round(len(track.time) / (RATE * max(float(np.ptp(track.time)), 1e-9))))
    first, second, third = (
        np.append(np.where(shown, column, np.nan)[::every], np.nan)
        for column in (angle, torque, model - offset)
    )
    return [(first, second, third)]


def _straight(result: FeetResult, foot: str, axis: Axis) -> tuple[float | None, str]:
    """Slope [N·m/rad] of the line to draw and its name: K, or that of the spring and damper which come nearest to a
    richer model. None where K may not be used."""
    key = (foot, axis)
    rows = [row for row in result.parameters if (row.foot, row.axis) == key and row.name == "stiffness"]
    if not rows or rows[0].verdict == "unidentifiable":
        return None, LINEAR
    richer = [row for row in result.models if (row.foot, row.axis) == key and row.model != KelvinVoigt.name]
    return (richer[0].linear_equivalent.stiffness, NEAREST) if richer else (rows[0].value, LINEAR)
