"""A replayed log as a picture: deflection, stiffness and damping of each foot and axis over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from plantar.conventions import ROTATIONAL_AXES
from plantar.online.replay import Replay
from plantar.report.figures.plots import BLUE, COLUMNS, GREY, LINE, envelope, panels
from plantar.signals.segments import runs

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

KNOWN: Final = 0.5  # half width over the stiffness, below which numbers are drawn: wider bands hide the rest


def replay_picture(replay: Replay) -> Drawing:
    """Deflections [mrad], stiffness [N·m/rad] and damping [N·m·s/rad] with their 95 % bands over time [s].

    A column for each foot and axis; grey where the foot does not stand.
    """
    columns = [(foot, axis) for foot in replay.feet for axis in ROTATIONAL_AXES]
    stride = max(1, len(replay.time) // COLUMNS)  # numbers change slowly
    time = replay.time[::stride]
    figure, rows = panels(3, len(columns), (2.6 * len(columns), 6.0), share_x=True)
    for place, (foot, axis) in enumerate(columns):
        stands = replay.stands(foot)
        deflection = np.where(stands, 1e3 * replay.column(foot, f"{axis}.deflection"), np.nan)
        rows[0, place].plot(*envelope(replay.time, deflection), color=BLUE, linewidth=LINE)
        for away in runs(~stands):
            rows[0, place].axvspan(
                replay.time[away.start], replay.time[away.stop - 1], color=GREY, linewidth=0
            )
        rows[0, place].set_title(f"{foot} {axis}", fontsize=9)
        stiffness, width = (replay.column(foot, f"{axis}.stiffness{part}") for part in ("", ".half_width"))
        known = width < KNOWN * stiffness  # and above zero: before anything is known, it is anywhere
        for row, name in enumerate(("stiffness", "damping"), 1):
            value = replay.column(foot, f"{axis}.{name}")
            half = replay.column(foot, f"{axis}.{name}.half_width")
            value, half = (np.where(known, one, np.nan)[::stride] for one in (value, half))
            rows[row, place].fill_between(
                time, value - half, value + half, color=BLUE, alpha=0.2, linewidth=0
            )
            rows[row, place].plot(time, value, color=BLUE, linewidth=LINE)
        rows[-1, place].set_xlabel("time [s]")
    for row, label in enumerate(("deflection [mrad]", "K [N·m/rad]", "C [N·m·s/rad]")):
        rows[row, 0].set_ylabel(label)
    return figure
