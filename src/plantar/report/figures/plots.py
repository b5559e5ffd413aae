"""The paper's figures as pictures, for a report (PNG or SVG) and for a paper (SVG and PDF).

Colours are the paper's: right foot red and left foot blue (figures 7 and 8), sensor red and reconstructed
blue (9 to 13), trace of the feet black, support polygon blue, ZMP red (4 and 6). Needs the extra `figures`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import ROTATIONAL_AXES, Array, Mask
from plantar.errors import DataError, needs
from plantar.files import atomic_write
from plantar.report.content import Figure, MediaType
from plantar.results.residuals import Track
from plantar.signals.segments import runs

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

Format = Literal["svg", "pdf", "png"]

RED: Final = "#c8470a"
BLUE: Final = "#0063b1"
FOOT_COLOURS: Final = {"right": RED, "left": BLUE}
LINE: Final = 0.9
GREY: Final = "#eceff2"
BAND: Final = 0.02
"""Shortest stretch that gets a grey band [s]."""
COLUMNS: Final = 900
"""Time bins of a line; each keeps its smallest and largest sample, so peaks stay and files stay small."""

STYLE: Final = {
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#e4e8ec",
    "axes.spines.top": False,
    "axes.spines.right": False,
}
_SAVED: Final = STYLE | {
    "svg.hashsalt": "plantar",  # the same figure is the same file
    "svg.fonttype": "path",
    "pdf.fonttype": 42,
}


def panels(
    rows: int, columns: int, size: tuple[float, float], share_x: bool | Literal["col"] = False
) -> tuple[Drawing, Any]:
    """A figure of `size` [inches] with (rows, columns) panels. Raises MissingExtra without matplotlib."""
    with needs("matplotlib", "figures", "drawing figures"):
        import matplotlib
        from matplotlib.figure import Figure as Drawing
    with matplotlib.rc_context(STYLE):
        drawing = Drawing(figsize=size, layout="constrained")
        grid = drawing.subplots(rows, columns, squeeze=False, sharex=share_x)
    return drawing, grid


def bush_angles(tracks: Sequence[Track], motion: str) -> Drawing:
    """Figures 7 and 8: pitch and roll of each bush over time in one motion, right red, left blue [mrad]."""
    chosen = _of_motion(tracks, motion)
    figure, rows = panels(len(ROTATIONAL_AXES), 1, (6.4, 4.0), share_x=True)
    for panel, axis in zip(rows[:, 0], ROTATIONAL_AXES, strict=True):
        for track in chosen:
            if f"{axis}.deflection" in track.values:
                colour = FOOT_COLOURS.get(track.foot, "black")
                time, angle = envelope(track.time, 1e3 * track.values[f"{axis}.deflection"])
                panel.plot(time, angle, color=colour, linewidth=LINE, label=track.foot)
        panel.set_ylabel(f"{axis} [mrad]")
    rows[0, 0].legend(frameon=False, ncols=2, loc="upper right")
    rows[-1, 0].set_xlabel("time [s]")
    return figure


def torques(tracks: Sequence[Track], motions: Sequence[str]) -> Drawing:
    """Figures 9 to 13: reconstructed torque (blue) over the sensor's (red), one panel per foot and axis
    [N·m]; grey where samples were left out.

    Several motions are set one after the other, as in the composed motion of figure 9.
    """
    chosen = [_of_motion(tracks, motion) for motion in motions]
    feet = list(dict.fromkeys(track.foot for group in chosen for track in group))
    figure, rows = panels(len(ROTATIONAL_AXES), len(feet), (7.2, 4.2), share_x=True)
    begin = 0.0
    for group in chosen:
        start = min(float(track.time[0]) for track in group)
        for track in group:
            for row, axis in enumerate(ROTATIONAL_AXES):
                panel = rows[row, feet.index(track.foot)]
                for first, last in left_out(track):
                    panel.axvspan(first - start + begin, last - start + begin, color=GREY, linewidth=0)
                for what, colour in (("torque", RED), ("predicted", BLUE)):
                    if f"{axis}.{what}" in track.values:
                        time, torque = envelope(track.time, track.values[f"{axis}.{what}"])
                        panel.plot(time - start + begin, torque, color=colour, linewidth=LINE)
        begin += max(float(track.time[-1]) for track in group) - start
    for column, foot in enumerate(feet):
        rows[0, column].set_title(f"{foot} foot", fontsize=9)
        rows[-1, column].set_xlabel("time [s]")
    for row, axis in enumerate(ROTATIONAL_AXES):
        rows[row, 0].set_ylabel(f"{axis} torque [N·m]")
    handles = [rows[0, 0].plot([], [], color=colour)[0] for colour in (RED, BLUE)]
    figure.legend(handles, ["sensor", "reconstructed"], frameon=False, ncols=2, loc="outside upper right")
    return figure


def zmp(points: Array, feet: Mapping[str, Array], support: Array | None = None) -> Drawing:
    """Figures 4 and 6: the ZMP's way (red) over the traces of the feet (black) and the support polygon (blue).

    `points` (N, 2), each foot's outline (n, 2) and the `support` polygon (m, 2) in the same horizontal frame [m], x
    forward, y left; forward points up in the picture. Rows of `points` that are not finite leave a gap.
    """
    figure, rows = panels(1, 1, (4.2, 4.2))
    panel = rows[0, 0]
    for name, outline in feet.items():
        panel.plot(*_closed(outline), color="black", linewidth=1.0)
        panel.annotate(name, (float(outline[:, 1].mean()), float(outline[:, 0].min())), ha="center", va="top",
                       xytext=(0, -4), textcoords="offset points")  # fmt: skip
    if support is not None:
        panel.plot(*_closed(support), color=BLUE, linewidth=1.2)
    panel.plot(points[:, 1], points[:, 0], color=RED, linewidth=LINE)
    panel.set_aspect("equal", adjustable="datalim")
    panel.invert_xaxis()
    panel.set_xlabel("y, left [m]")
    panel.set_ylabel("x, forward [m]")
    return figure


def left_out(track: Track) -> list[tuple[float, float]]:
    """First and last time [s] of each stretch of at least BAND of which no sample is used, for grey bands."""
    spans = [(float(track.time[run][0]), float(track.time[run][-1])) for run in runs(~track.used)]
    return [(first, last) for first, last in spans if last - first >= BAND]


def envelope(time: Array, values: Array, columns: int = COLUMNS) -> tuple[Array, Array]:
    """At most `4·columns` of the samples, (N,): in each of `columns` bins the first, smallest, largest and last.

    A gap (NaN) stays a gap: one of its samples is kept in each bin.
    """
    if time.size <= 4 * columns:
        return time, values
    edges = np.linspace(0, time.size, columns + 1).astype(np.intp)
    bins, gaps = np.repeat(np.arange(columns), np.diff(edges)), np.isnan(values)
    kept = [edges[:-1], edges[1:] - 1, _first_of_each(bins, gaps)]
    for extreme, none in ((np.minimum, np.inf), (np.maximum, -np.inf)):
        least = extreme.reduceat(np.where(gaps, none, values), edges[:-1])
        kept.append(_first_of_each(bins, values == least[bins]))
    rows = np.unique(np.concatenate(kept))
    return time[rows], values[rows]


def _first_of_each(bins: NDArray[np.intp], chosen: Mask) -> NDArray[np.intp]:
    """The first of the `chosen` rows (N,) in each bin that has one; `bins` (N,) rise."""
    rows = np.flatnonzero(chosen)
    return np.asarray(rows[np.unique(bins[rows], return_index=True)[1]])


def picture(drawing: Drawing, title: str, caption: str, media: MediaType = "image/png") -> Figure:
    """The drawing for a report; PNG by default, because many long lines are smaller as pixels."""
    content = _rendered(drawing, "png" if media == "image/png" else "svg")
    return Figure(title, caption, content, media)


def save(
    drawing: Drawing, directory: Path, name: str, formats: Sequence[Format] = ("svg", "pdf")
) -> list[Path]:
    """Write `<name>.svg` and `.pdf` (or the formats asked for), each whole or not at all; returns their paths."""
    paths = []
    for kind in formats:
        path = directory / f"{name}.{kind}"
        with atomic_write(path) as handle:
            handle.write(_rendered(drawing, kind))
        paths.append(path)
    return paths


def _rendered(drawing: Drawing, kind: Format) -> bytes:
    import matplotlib

    buffer = BytesIO()
    metadata: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}[kind]
    with matplotlib.rc_context(_SAVED):
        drawing.savefig(buffer, format=kind, dpi=140, metadata=metadata)
        # What is laid out once stays so, in every format, and is then drawn but once for each.
        drawing.set_layout_engine(None)
    return _few_colours(buffer) if kind == "png" else buffer.getvalue()


def _few_colours(png: BytesIO) -> bytes:
    """Line drawings need few colours: a palette makes the file several times smaller."""
    from PIL import Image

    small = BytesIO()
    with Image.open(png) as image:
        image.convert("RGB").quantize(48).save(small, format="png", optimize=True)
    return small.getvalue()


def _of_motion(tracks: Sequence[Track], motion: str) -> list[Track]:
    chosen = [track for track in tracks if track.motion == motion]
    if not chosen:
        raise DataError(f"the residuals hold no motion '{motion}'")
    return chosen


def _closed(outline: Array) -> tuple[Array, Array]:
    """A polygon (n, 2) of x forward, y left as the picture's closed line."""
    ring = np.vstack([outline, outline[:1]])
    return ring[:, 1], ring[:, 0]
