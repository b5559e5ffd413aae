"""A simulator's answer over what was recorded, and the way of the zero-moment point as planned and measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from plantar.conventions import Array
from plantar.report.figures.plots import BLUE, LINE, RED, envelope, panels, zmp
from plantar.twin.replay import Replayed

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

GREEN: Final = "#5d7a00"
VIOLET: Final = "#7b5ea7"
CHEST: Final = ("chest pitch", "chest roll")
OTHERS: Final = (GREEN, VIOLET, "#9a6a00", "#3d7ea6", "#a8b0b8")
LEAST_WIDTH: Final = 9.0  # inches: the legend of four kinds of feet beside the record, on one line


def replays(found: Sequence[Replayed], first: str) -> Drawing:
    """Simulated over recorded: one column a motion, one row for each angle of the chest and each torque of a foot.

    Recorded red, the simulation on the feet named `first` blue and on top of the others, which may leave the plot.
    """
    labels = [f"{name}\n[mrad]" for name in CHEST]
    labels += [f"{foot} {axis}\ntorque [N·m]" for foot, axis in found[0].torque]
    motions = list(dict.fromkeys(one.motion for one in found))
    size = max(3.1 * len(motions), LEAST_WIDTH), 1.9 * len(labels)
    figure, rows = panels(len(labels), len(motions), size, "col")
    names = [name for name in dict.fromkeys(one.feet for one in found) if name != first]
    colours = {name: OTHERS[place % len(OTHERS)] for place, name in enumerate(names)} | {first: BLUE}
    for column, motion in enumerate(motions):
        rows[0, column].set_title(motion, fontsize=9)
        rows[-1, column].set_xlabel("time [s]")
        group = {one.feet: one for one in found if one.motion == motion}
        record = next(iter(group.values()))  # the same beside all feet
        time, recorded = record.time, _quantities(record.recorded_chest, record.recorded_torque)
        simulated = {name: _quantities(one.chest, one.torque) for name, one in group.items()}
        for row, label in enumerate(labels):
            panel = rows[row, column]
            for name in names:
                if name in simulated:
                    panel.plot(*envelope(time, simulated[name][row]), color=colours[name], linewidth=LINE)
            panel.plot(*envelope(time, recorded[row]), color=RED, linewidth=1.6)
            if first in simulated:
                panel.plot(*envelope(time, simulated[first][row]), color=BLUE, linewidth=LINE)
            panel.set_ylim(*_range(recorded[row]))
            if column == 0:
                panel.set_ylabel(label)
    drawn = (RED, *(colours[n] for n in (first, *names)))
    handles = [rows[0, 0].plot([], [], color=colour)[0] for colour in drawn]
    figure.legend(
        handles, ["recorded", first, *names], frameon=False, ncols=len(handles), loc="outside upper right"
    )
    return figure


def _quantities(chest: Array, torque: Mapping[tuple[str, str], Array]) -> list[Array]:
    """Pitch and roll of the chest [mrad], then the feet's torques [N·m], (N,) each."""
    return [*(1e3 * chest.T), *torque.values()]


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
