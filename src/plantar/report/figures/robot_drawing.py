"""A robot drawn as boxes, seen from the front and from the side: figures 3 and 5 of the paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from plantar.contact.polygon import convex_hull
from plantar.conventions import Array
from plantar.report.figures.plots import BLUE, RED, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

SIDES: Final = {"right": RED, "left": BLUE, "": "#aab4bd"}
LIGHT: Final = 0.55  # how far a side's colour is mixed with white
VIEWS: Final = (("from the front", (1, 2), 0, "y, left [m]"), ("from its left", (0, 2), 1, "x, forward [m]"))


@dataclass(frozen=True)
class Box:
    """A box by its corners (8, 3) in the world [m], of a robot's side: "right", "left" or ""."""

    corners: Array
    side: str


def stances(named: Sequence[tuple[str, Sequence[Box]]]) -> Drawing:
    """Postures side by side, each from the front (above) and from its left (below), the floor at z = 0."""
    figure, rows = panels(len(VIEWS), len(named), (1.9 * len(named), 5.6))
    low, high = _extent([box.corners for _, boxes in named for box in boxes])
    for row, (view, axes, depth, label) in enumerate(VIEWS):
        for column, (name, boxes) in enumerate(named):
            panel = rows[row, column]
            # what is nearer to the eye is drawn last; the eye is in front, then on the left
            for box in sorted(boxes, key=lambda box: float(box.corners[:, depth].mean())):
                outline = convex_hull(box.corners[:, axes])
                panel.fill(
                    *outline.T, facecolor=_light(SIDES[box.side]), edgecolor=SIDES[box.side], linewidth=0.8
                )
            panel.axhline(0, color="black", linewidth=1.0)
            panel.set_axisbelow(True)
            panel.set_aspect("equal")
            panel.set_ylim(low[2] - 0.03, high[2] + 0.03)
            panel.set_xlim(low[axes[0]] - 0.03, high[axes[0]] + 0.03)
            if axes[0] == 1:
                panel.invert_xaxis()
                panel.set_title(name, fontsize=9)
            panel.set_xlabel(label)
        rows[row, 0].set_ylabel(f"{view}, z [m]")
    return figure


def _extent(corners: Sequence[Array]) -> tuple[Array, Array]:
    every = np.vstack(corners)
    return every.min(axis=0), every.max(axis=0)


def _light(colour: str) -> tuple[float, ...]:
    parts = [int(colour[place : place + 2], 16) / 255 for place in (1, 3, 5)]
    return tuple(LIGHT + (1 - LIGHT) * part for part in parts)
