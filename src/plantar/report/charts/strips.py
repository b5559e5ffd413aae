"""Stiffness of one foot and axis by stance and by walk, beside what all of them say together: a strip plot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plantar.report.charts.chart import Band, Chart, Dot, Panel, Path, Scale, ends, frame, room_below, slanted
from plantar.results.feet import FeetResult, Parameter
from plantar.results.numbers import number, unit, with_uncertainty
from plantar.results.walk_rows import StanceStiffness, WalkStiffness

WIDTH = 600.0
PLACE: Final = (62.0, 10.0, 528.0, 240.0)
MOST_WALKS: Final = 30  # in one chart
MOST_STANCES: Final = 1000  # in one chart: those that say most
LARGEST, SMALLEST = 6.0, 1.5  # pixels, radius of a stance's dot
USUAL: Final = 0.9  # of the stances' shares, that set the scale beside walks and band
STRIP_REMARK: Final = (
    "Bar: the recording fitted alone, with its 95 % interval from the scatter of its own stances. Disc: one stance, "
    "the larger the more it says; damping and load as in the whole fit. Hollow: not seen by the fit. Band: the whole "
    "fit and its 95 % interval, which also holds what all recordings share."
)


def strip_charts(result: FeetResult) -> list[Chart]:
    """A chart for each foot and axis with stances; none where no foot steps."""
    keys = dict.fromkeys((row.foot, row.axis) for row in result.stances)
    charts = []
    for foot, axis in keys:
        stances = [row for row in result.stances if (row.foot, row.axis) == (foot, axis)]
        walks = [row for row in result.walks if (row.foot, row.axis) == (foot, axis)]
        known = (
            row for row in result.parameters if (row.foot, row.axis, row.name) == (foot, axis, "stiffness")
        )
        pooled = next(known, _UNKNOWN)
        charts.append(_chart(f"{foot} {axis}", stances, walks, pooled))
    return charts


_UNKNOWN: Final = Parameter("", "z", "stiffness", "", None, None, None, None, "unidentifiable", "")


def _chart(
    subject: str, stances: Sequence[StanceStiffness], walks: Sequence[WalkStiffness], pooled: Parameter
) -> Chart:
    motions = list(dict.fromkeys(row.motion for row in stances))
    drawn = motions[:MOST_WALKS]
    left, top, width, height = PLACE
    x = Scale(0.0, float(len(drawn)), 0.0, width)
    y = Scale(*_range(stances, walks, pooled), height, 0.0)
    marks: list[Band | Path | Dot] = []
    if pooled.value is not None:
        low, high = pooled.interval95 or (pooled.value, pooled.value)
        edges = np.clip([float(y(high)), float(y(low))], -9.0, height + 9.0)
        marks.append(Band("pooled", 0.0, float(edges[0]), width, float(edges[1] - edges[0])))
        marks.append(Path("pooled", f"M0 {float(y(pooled.value)):.1f}h{width:.1f}"))
    unseen = {row.motion for row in stances if row.role == "validate"}
    if (first := next((k for k, motion in enumerate(drawn) if motion in unseen), 0)) > 0:
        marks.append(Path("edge", f"M{float(x(first)):.1f} 0v{height:.1f}"))
    heaviest = sorted(stances, key=lambda row: -row.share)[:MOST_STANCES]
    largest, least = heaviest[0].share, heaviest[-1].share
    names = []
    for place, motion in enumerate(drawn):
        middle = float(x(place + 0.5))
        own = [row for row in stances if row.motion == motion and row.share >= least]
        for row, at in zip(own, np.linspace(place + 0.15, place + 0.85, len(own)), strict=True):
            marks.append(_dot(row, float(x(at)), y, np.sqrt(row.share / largest)))
        marks += [mark for row in walks if row.motion == motion for mark in _bar(row, middle, y)]
        names.append(slanted(motion, left + middle, top + height))
    paths, texts = frame(PLACE, x, y, "", "K [N·m/rad]", numbers=False)
    away = sum(not y.low <= row.stiffness <= y.high for row in heaviest if row.motion in drawn)
    remarks = (
        [f"Stances whose K is beyond the scale of this plot, drawn at its edge: {away}."] if away else []
    )
    remarks += [f"The first {MOST_WALKS} of {len(motions)} recordings."] if len(drawn) < len(motions) else []
    if len(heaviest) < len(stances):
        remarks.append(f"The {MOST_STANCES} stances that say most, of {len(stances)}.")
    kinds = [("fitted walk", "walk fit"), ("unseen walk", "walk validate"), ("stance", "stance")]
    roles = {f"walk {row.role}" for row in stances}
    together = f"all together: {with_uncertainty(pooled.value, pooled.half_width)} {unit(pooled.unit)}"
    return Chart(
        title=f"{subject}: K by stance and by walk",
        legend=(*(kind for kind in kinds if kind[1] in roles or kind[1] == "stance"), (together, "pooled")),
        description=f"{subject}: stiffness by each stance and by each recording alone, beside the whole fit's",
        width=WIDTH,
        height=top + height + room_below(drawn),
        panels=(Panel(left, top, width, height, paths, (*texts, *names), tuple(marks)),),
        remark=" ".join(remarks),
    )


def _range(
    stances: Sequence[StanceStiffness], walks: Sequence[WalkStiffness], pooled: Parameter
) -> tuple[float, float]:
    """Of the scale: band, walks and the stances that say most of all; a stance that hardly moves may be anywhere."""
    weighty, said = [], 0.0
    for row in sorted(stances, key=lambda row: -row.share):
        weighty.append(row.stiffness)
        said += row.share
        if said > USUAL * sum(row.share for row in stances):
            break
    bounds = [end for row in walks for end in _within(row, weighty)]
    return ends(np.array([*weighty, *bounds, *(pooled.interval95 or ()), *(row.stiffness for row in walks)]))


def _within(row: WalkStiffness, weighty: Sequence[float]) -> tuple[float, float]:
    """A walk's interval, no further from it than the stances scatter: a wide one is cut off at the edge."""
    reach = float(np.ptp(weighty)) if weighty else 0.0
    low, high = row.interval95
    return max(low, row.stiffness - reach), min(high, row.stiffness + reach)


def _dot(row: StanceStiffness, x: float, y: Scale, size: float) -> Dot:
    at = float(np.clip(y(row.stiffness), 2.0, y.start - 2.0))
    hover = f"{row.motion}, {row.start:.2f} to {row.end:.2f} s: K = {number(row.stiffness)} N·m/rad"
    return Dot(f"stance {row.role}", x, at, max(SMALLEST, LARGEST * size), hover)


def _bar(row: WalkStiffness, x: float, y: Scale) -> list[Path | Dot]:
    low, high = (float(np.clip(y(end), -9.0, y.start + 9.0)) for end in row.interval95)
    half = (row.interval95[1] - row.interval95[0]) / 2
    hover = f"{row.motion} alone, {row.stances} stances: K = {with_uncertainty(row.stiffness, half)} N·m/rad"
    kind = f"walk {row.role}"
    return [Path(kind, f"M{x:.1f} {low:.1f}V{high:.1f}"), Dot(kind, x, float(y(row.stiffness)), 4.5, hover)]
