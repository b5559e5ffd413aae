"""What a chart is made of: panels in pixels, with scales, lines, dots and bands; a template turns them into SVG."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.conventions import Array

TICKS: Final = 5  # about so many on a scale from left to right
TICK_ROOM: Final = 30.0  # pixels, about so much between those of a scale that goes up
NAME: Final = 18  # characters of a motion's name below a panel
SLANT: Final = -35.0  # degrees, of names below a panel
LETTER: Final = 4.0  # pixels of height that a slanted letter takes
MARGIN: Final = 0.05  # of the data's range, around it


@dataclass(frozen=True)
class Path:
    """A line in pixels; `kind` is its class in the style sheet."""

    kind: str
    points: str


@dataclass(frozen=True)
class Dot:
    """A disc of some radius at a place in pixels; `hover` says what it is."""

    kind: str
    x: float
    y: float
    radius: float
    hover: str


@dataclass(frozen=True)
class Band:
    """A rectangle in pixels."""

    kind: str
    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Text:
    """A text at a place in pixels, `turned` by degrees about it; `anchor` is start, middle or end."""

    text: str
    x: float
    y: float
    anchor: str = "middle"
    turned: float = 0.0
    kind: str = ""


@dataclass(frozen=True)
class Panel:
    """A frame at (`left`, `top`) of `width` x `height` pixels; `marks` are cut off at its edges, `frame` and `texts`
    stand around it."""

    left: float
    top: float
    width: float
    height: float
    frame: tuple[Path, ...]
    texts: tuple[Text, ...]
    marks: tuple[Band | Path | Dot, ...]


@dataclass(frozen=True)
class Chart:
    """One figure: title, what its colours mean as (text, class), a description to be read out, and its panels."""

    title: str
    legend: tuple[tuple[str, str], ...]
    description: str
    width: float
    height: float
    panels: tuple[Panel, ...]
    remark: str = ""


@dataclass(frozen=True)
class Scale:
    """From numbers `low` to `high` to pixels `start` to `end`; `end` lies before `start` where numbers grow upwards."""

    low: float
    high: float
    start: float
    end: float

    def __call__(self, values: Array | float) -> Array:
        return self.start + (np.asarray(values) - self.low) * (self.end - self.start) / (self.high - self.low)

    def ticks(self, count: int = TICKS) -> list[tuple[float, str]]:
        """Pixels and texts of round numbers, about `count` of them."""
        step = round_step((self.high - self.low) / count)
        decimals = max(0, -math.floor(math.log10(step) + 1e-9))
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        values = [place * step for place in range(first, last + 1)]
        return [(float(self(value)), f"{value:.{decimals}f}".replace("-", "−")) for value in values]


def round_step(least: float) -> float:
    """The next of 1, 2, 5, 10, ... that is not below `least` > 0."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(factor * power for factor in (1, 2, 5, 10) if factor * power >= least * (1 - 1e-9))


def ends(values: Array) -> tuple[float, float]:
    """Where a scale begins and ends that shows all finite values; -1 and 1 where there is none."""
    known = values[np.isfinite(values)]
    if not known.size:
        return -1.0, 1.0
    low, high = float(known.min()), float(known.max())
    reach = MARGIN * (high - low) or 0.1 * abs(high) or 1.0
    return low - reach, high + reach


def frame(
    panel: tuple[float, float, float, float],
    x: Scale,
    y: Scale,
    x_label: str,
    y_label: str,
    numbers: bool = True,
) -> tuple[tuple[Path, ...], tuple[Text, ...]]:
    """Grid and texts of a panel (left, top, width, height); without `numbers` nothing is written below it."""
    left, top, width, height = panel
    bottom = top + height
    paths, texts = [], []
    for at, text in y.ticks(max(2, round(height / TICK_ROOM))):
        paths.append(Path("grid", f"M{left:.1f} {top + at:.1f}h{width:.1f}"))
        texts.append(Text(text, left - 6, top + at + 4, "end"))
    for at, text in x.ticks() if numbers else []:
        paths.append(Path("grid", f"M{left + at:.1f} {top:.1f}v{height:.1f}"))
        texts.append(Text(text, left + at, bottom + 15))
    if x_label:
        texts.append(Text(x_label, left + width / 2, bottom + 31))
    if y_label:
        texts.append(Text(y_label, 11, top + height / 2, turned=-90))
    return tuple(paths), tuple(texts)


def slanted(name: str, middle: float, bottom: float) -> Text:
    """A motion's name that ends below the `middle` of its part of a panel."""
    return Text(name if len(name) <= NAME else f"{name[: NAME - 1]}…", middle + 4, bottom + 14, "end", SLANT)


def room_below(names: Sequence[str]) -> float:
    """Pixels that `slanted` names need below a panel."""
    return 20.0 + LETTER * min(max(map(len, names), default=0), NAME)


def line(x: Array, y: Array, kind: str) -> Path:
    """A line through points in pixels, (n,) each, with gaps where one is not finite; in steps of a tenth of a pixel."""
    tenths = np.round(10 * np.column_stack([x, y]))
    known = np.isfinite(x + y)
    begins = (known & ~np.concatenate([[False], known[:-1]]))[known]
    tenths = tenths[known]
    steps = np.where(begins[:, None], tenths, np.diff(tenths, axis=0, prepend=0.0)) / 10
    # A step from the point before is shorter to write than a place.
    return Path(kind, "".join(np.where(begins, "M%g %g", "l%g %g").tolist()) % tuple(steps.ravel().tolist()))


def thinned(x: Array, y: Array, most: int) -> tuple[Array, Array]:
    """A line in pixels, (n,) each, without points that lie in the square of the one before: squares of half a pixel,
    or larger ones until `most` points are left. Gaps (NaN) stay gaps."""
    side = 0.5
    while (keep := _moves(x, y, side)).sum() > most and side <= 1e3:
        side *= 1.5
    return x[keep], y[keep]


def _moves(x: Array, y: Array, side: float) -> Array:
    """Whether a point lies in another square than the one before it, (n,)."""
    known = np.isfinite(x + y)
    column, row = (np.where(known, np.round(along / side), np.inf) for along in (x, y))
    moved = np.ones(len(x), dtype=bool)
    moved[1:] = (column[1:] != column[:-1]) | (row[1:] != row[:-1])
    return moved
