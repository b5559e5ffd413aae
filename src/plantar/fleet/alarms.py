"""Alarms in words: what changed in which foot of which robot, how sure that is, and what to do about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date
from typing import Final

import numpy as np

from plantar.fleet.series import Days, Series
from plantar.fleet.statistics.changes import Change, Kind

TOGETHER: Final = 7  # days within which changes of one robot may have one cause
NOTICEABLE: Final = 0.05  # share of K by which a controller notices


@dataclass(frozen=True)
class Alarm:
    """A change of one number: since when, when it was seen, by how many percent (a trend: a month) with 95 % interval.

    `groups`: of an outlier, the recordings of that day. `text` says it, `advice` what to do.
    """

    unit: str
    foot: str
    axis: str
    name: str
    kind: Kind
    since: date
    seen: date
    percent: float
    low: float | None
    high: float | None
    groups: tuple[str, ...]
    text: str
    advice: str = ""


def alarm_of(series: Series, days: Days, change: Change) -> Alarm:
    """A change of a series as an alarm, without advice yet."""
    percent, low, high = (percent_of(size) for size in (change.size, change.low, change.high))
    since, seen = days.date(change.first), days.date(change.seen)
    key = series.key
    what = f"{key.foot} {key.axis} {key.name} of {series.unit}"
    way = "up" if percent > 0 else "down"
    least, most = sorted((abs(low), abs(high)))
    known = bool(np.isfinite([low, high]).all())
    bounds: tuple[float | None, float | None] = (low, high) if known else (None, None)
    sure = f" ({least:.1f} to {most:.1f} %)" if known and low * high > 0 else ""
    text = {
        "step": f"{what} went {way} by {abs(percent):.1f} %{sure} on {since}, seen on {seen}",
        "trend": f"{what} goes {way} by {abs(percent):.2g} % a month since about {since}, seen on {seen}",
        "outlier": f"{what} is {abs(percent):.1f} % {'above' if percent > 0 else 'below'} the other days on {since}",
    }[change.kind]
    groups = days.groups[change.first] if change.kind == "outlier" else ()
    return Alarm(
        series.unit, key.foot, key.axis, key.name, change.kind, since, seen, percent, *bounds, groups, text
    )


def advice_for(alarm: Alarm, others: Sequence[Alarm]) -> str:
    """What to do about an alarm, with a look at the `others` of the same robot and about the same days."""
    near = [one for one in others if one.kind == alarm.kind and abs((one.seen - alarm.seen).days) <= TOGETHER]
    feet = {one.foot for one in near} | {alarm.foot}
    if alarm.kind == "outlier":
        named = ", ".join(alarm.groups[:3])
        return f"look at {named} with `plantar inspect`: another floor, load or temperature, or a fault of that day"
    if alarm.kind == "step":
        if len(feet) > 1:
            cause = "both feet changed: look for what they share, such as temperature, the IMU or a new robot file"
        elif near:
            cause = "all of this foot changed: a new sole or bush, or another gain of its force sensor"
        else:
            cause = "this axis alone changed: a sole or a bush that was changed, or that broke on one side"
        return f"{cause}. If nothing was serviced, inspect the foot; then export the new value"
    months = NOTICEABLE / max(abs(alarm.percent) / 100, 1e-9)
    pace = f"at this pace it is {100 * NOTICEABLE:.0f} % off within {months:.0f} months: export again by then"
    if len(feet) > 1:
        return f"both feet go the same way: the rubber's age, or the season; {pace}"
    return f"the rubber ages, or the force sensor's gain drifts (does it still read the weight?); {pace}"


def percent_of(size: float) -> float:
    """A difference of logarithms as percent."""
    return float(100 * np.expm1(size)) if np.isfinite(size) else float(size)
