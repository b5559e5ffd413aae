"""A simulator's answer over what was recorded, and the way of the zero-moment point as planned and measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from plantar.conventions import Array
from plantar.report.figures.panels import panels
from plantar.report.figures.plots import BLUE, LINE, RED, envelope, zmp

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

GREEN: Final = "#5d7a00"
VIOLET: Final = "#7b5ea7"
OTHERS: Final = (GREEN, VIOLET, "#9a6a00", "#3d7ea6", "#a8b0b8")


@dataclass(frozen=True)
class MotionReplayed:
    """One motion for the figure: quantities over `time` (N,) as `recorded` and, by simulation, as `simulated`."""

    motion: str
    time: Array = field(repr=False)
    recorded: Mapping[str, Array] = field(repr=False)
    simulated: Mapping[str, Mapping[str, Array]] = field(repr=False)


def replays(
    motions: Sequence[MotionReplayed], quantities: Sequence[tuple[str, str, float]], first: str
) -> Drawing:
    """Simulated over recorded: one column a motion, one row a quantity (its name, label and factor).

    Recorded red, the simulation named `first` blue and on top of the others, which may leave the plot.
    """
    figure, rows = panels(len(quantities), len(motions), (3.1 * len(motions), 1.9 * len(quantities)), "col")
    names = [name for name in dict.fromkeys(n for one in motions for n in one.simulated) if name != first]
    colours = {name: OTHERS[place % len(OTHERS)] for place, name in enumerate(names)} | {first: BLUE}
    for column, one in enumerate(motions):
        rows[0, column].set_title(one.motion, fontsize=9)
        rows[-1, column].set_xlabel("time [s]")
        for row, (quantity, label, factor) in enumerate(quantities):
            panel = rows[row, column]
            for name in names:
                if name in one.simulated:
                    way = envelope(one.time, factor * one.simulated[name][quantity])
                    panel.plot(*way, color=colours[name], linewidth=LINE)
            panel.plot(*envelope(one.time, factor * one.recorded[quantity]), color=RED, linewidth=1.6)
            if first in one.simulated:
                panel.plot(
                    *envelope(one.time, factor * one.simulated[first][quantity]), color=BLUE, linewidth=LINE
                )
            panel.set_ylim(*_range(factor * one.recorded[quantity]))
            if column == 0:
                panel.set_ylabel(label)
    handles = [
        rows[0, 0].plot([], [], color=colour)[0] for colour in (RED, *(colours[n] for n in (first, *names)))
    ]
    figure.legend(
        handles, ["recorded", first, *names], frameon=False, ncols=len(handles), loc="outside upper right"
    )
    return figure


def _range(recorded: Array) -> tuple[float, float]:
    """The recorded range and half as much on either side: a simulation that stamps must not set the scale."""
    low, high = float(np.nanmin(recorded)), float(np.nanmax(recorded))
    margin = 0.5 * max(high - low, 1e-6)
    return low - margin, high + margin


def zmp_planned(points: Array, planned: Array, feet: Mapping[str, Array], support: Array) -> Drawing:
    """Figures 4 and 6 with the plan beside: measured ZMP (N, 2) red, planned (M, 2) green, [m], x forward."""
    figure = zmp(points, feet, support)
    (panel,) = figure.axes
    line = panel.plot(planned[:, 1], planned[:, 0], color=GREEN, linewidth=LINE, marker=".", markersize=2)[0]
    lines = [panel.lines[-2], line]
    figure.legend(lines, ["measured", "planned"], frameon=False, ncols=2, loc="outside upper center")
    return figure
