"""Zeros of the force sensors over time: what each swing read in the air, and what was taken off."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

import numpy as np

from plantar.report.charts.chart import Chart, Dot, Panel, Path, Scale, ends, frame, line, room_below, slanted
from plantar.results.numbers import number
from plantar.results.walk_rows import SwingZero

WIDTH = 600.0
PLACE: Final = (62.0, 10.0, 528.0, 160.0)
COMPONENTS: Final = ("x", "y", "z")
UNITS: Final = {"force": "N", "torque": "N·m"}
MOST_SWINGS: Final = 1000  # in one chart
GAP: Final = 0.06  # of all time, between two recordings
ZERO_REMARK: Final = (
    "Disc: what the sensor read in the middle of one swing, in its own frame. Line: what was taken off as its zero. "
    "Recordings stand one after the other, as they were given."
)


def zero_charts(rows: Sequence[SwingZero]) -> list[Chart]:
    """Force and torque of each foot with swings."""
    feet = dict.fromkeys(row.foot for row in rows)
    return [
        _chart([row for row in rows if row.foot == foot], foot, quantity)
        for foot in feet
        for quantity in ("force", "torque")
    ]


def _chart(rows: Sequence[SwingZero], foot: str, quantity: Literal["force", "torque"]) -> Chart:
    rows = rows[:: -(-len(rows) // MOST_SWINGS)]
    motions = list(dict.fromkeys(row.motion for row in rows))
    groups = [[row for row in rows if row.motion == motion] for motion in motions]
    read = np.array([getattr(row, quantity) for row in rows])
    zero = np.array([getattr(row, f"{quantity}_zero") for row in rows])
    left, top, width, height = PLACE
    spans = [group[-1].time - group[0].time for group in groups]
    gap = GAP * (sum(spans) or 1.0)
    begins = np.cumsum([0.0, *(span + gap for span in spans)])
    x = Scale(-gap / 2, float(begins[-1]) - gap / 2, 0.0, width)
    y = Scale(*ends(np.vstack([read, zero])), height, 0.0)
    between = x(begins[1:-1] - gap / 2)
    marks: list[Path | Dot] = [Path("grid", f"M{at:.1f} 0v{height:.1f}") for at in between]
    texts, first = [], 0
    for group, begin, end, motion in zip(groups, begins[:-1], begins[1:], motions, strict=True):
        own = slice(first, first + len(group))
        first = own.stop
        at = x(np.array([row.time for row in group]) - group[0].time + begin)
        for place, name in enumerate(COMPONENTS):
            marks.append(line(at, y(zero[own, place]), f"component {name}"))
            for px, value, row in zip(at, read[own, place], group, strict=True):
                hover = f"{motion}, {row.time:.2f} s: {number(value, 3)} {UNITS[quantity]}"
                marks.append(Dot(f"component {name}", float(px), float(y(value)), 2.5, hover))
        if float(x(end) - x(begin)) > 11:
            texts.append(slanted(motion, left + float(x((begin + end - gap) / 2)), top + height))
    paths, around = frame(PLACE, x, y, "", f"{quantity} [{UNITS[quantity]}]", numbers=False)
    return Chart(
        title=f"{foot} foot: zero of the {quantity} sensor",
        legend=tuple((name, f"component {name}") for name in COMPONENTS),
        description=f"{foot} foot: what the sensor's {quantity} read in each swing, in the order of time",
        width=WIDTH,
        height=top + height + room_below(motions),
        panels=(Panel(left, top, width, height, paths, (*around, *texts), tuple(marks)),),
    )
