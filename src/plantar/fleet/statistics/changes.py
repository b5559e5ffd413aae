"""What changed in one number over the days: steps, trends and outliers, told apart, with one false-alarm rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, Literal

import numpy as np
from scipy.special import stdtrit

from plantar.conventions import MONTH, NORMAL95, YEAR, Array
from plantar.fleet.statistics.control_chart import BASELINE, Limits, limits_of, watch
from plantar.fleet.statistics.trend import Trend, trend_of

Kind = Literal["step", "trend", "outlier"]

KINDS: Final = 3  # that share the false alarms
WINDOW: Final = 3 * MONTH  # days that a trend is looked for in, once a month
SHORTEST: Final = MONTH  # days: in less, a trend and a step are one
BESIDE: Final = 60.0  # days before and behind a step that its size is taken from
AGAIN: Final = 2.1 * MONTH  # days within which another trend of the same direction is the same one
BENDS: Final = 25  # places where a line may begin
LARGEST_SHARE: Final = 0.2  # of days that may be called one thing, where days are few and alarms many


@dataclass(frozen=True)
class Change:
    """One change: the places of the first day that it concerns and of the day on which it was seen.

    `size`, `low`, `high`: of a step, behind less before; of a trend, a month; of an outlier, beside the others (its
    interval is the others' scatter). In the unit of the values.
    """

    kind: Kind
    first: int
    seen: int
    size: float
    low: float
    high: float


@dataclass(frozen=True)
class History:
    """All changes in the order in which they were seen; `start`: the place from which on nothing stepped, and the line
    through the days from there (None where they are too few)."""

    changes: tuple[Change, ...]
    start: int
    trend: Trend | None


def history_of(time: Array, values: Array, weights: Array, rate: float) -> History:
    """Changes of values (n,) at days `time` (n,), increasing, with `rate` false alarms a year where nothing changes.

    weights: (n,), one over the variance of each value up to one factor. Noise is taken as normal and independent from
    day to day; how large it is comes from the values.

    Example:
        >>> import numpy as np
        >>> from plantar.fleet.statistics.changes import history_of
        >>> noise = np.random.default_rng(0).normal(0, 0.01, 60)
        >>> softer = noise - 0.05 * (np.arange(60) >= 40)
        >>> [(change.kind, change.first) for change in history_of(np.arange(60.0), softer, np.ones(60), 0.1).changes]
        [('step', 40)]
    """
    if len(time) < BASELINE or time[-1] <= time[0]:
        return History((), 0, None)
    a_year = YEAR * (len(time) - 1) / float(time[-1] - time[0])
    share = min(rate / KINDS / a_year, LARGEST_SHARE)
    limits = limits_of(share, share)
    found = watch(values, weights, limits)
    steps, slow = _told_apart(found.steps, time, values, weights)
    starts = [0, *(first for first, _ in steps)]
    alone = [place for place in found.outliers if _is_outlier(place, starts, time, values, weights, limits)]
    trends = _trends(time, values, weights, steps, alone, rate)
    changes = [_step(step, starts, time, values, weights) for step in steps]
    changes += _merged([*slow, *trends], time)
    changes += [_outlier(place, starts, values) for place in alone]
    kept = np.setdiff1d(np.arange(starts[-1], len(time)), alone)
    trend = trend_of(time[kept], values[kept], weights[kept])
    return History(tuple(sorted(changes, key=lambda change: (change.seen, change.first))), starts[-1], trend)


def _told_apart(
    steps: Sequence[tuple[int, int]], time: Array, values: Array, weights: Array
) -> tuple[list[tuple[int, int]], list[Change]]:
    """The steps that are such, and those that are the chart's words for a slow change: where a level that turns into a
    line explains the days around some of them, all in one direction, better than as many levels do."""
    real: list[tuple[int, int]] = []
    slow: list[Change] = []
    place = 0
    while place < len(steps):
        start = real[-1][0] if real else 0
        for count in range(len(steps) - place, 0, -1):
            run, after = steps[place : place + count], steps[place + count : place + count + 1]
            end = after[0][0] if after else len(time)
            own = slice(start, max(end, run[-1][1] + 1))
            change = _slow_change(run, own, time, values, weights)
            if change is not None:
                slow.append(change)
                place += count
                break
        else:
            real.append(steps[place])
            place += 1
    return real, slow


def _slow_change(
    run: Sequence[tuple[int, int]], own: slice, time: Array, values: Array, weights: Array
) -> Change | None:
    """A run of steps as one slow change, where that is what they are: fewer parameters count (G. Schwarz, 1978)."""
    t, y, w = time[own], values[own], weights[own]
    bounds = [0, *(first - own.start for first, _ in run), len(y)]
    sides = [slice(*bound) for bound in pairwise(bounds) if bound[1] > bound[0]]
    levels = [float(np.average(y[side], weights=w[side])) for side in sides]
    if len(np.unique(np.sign(np.diff(levels)))) > 1:
        return None
    of_levels = sum(
        float(w[side] @ (y[side] - level) ** 2) for side, level in zip(sides, levels, strict=True)
    )
    bend, of_line = _bend(t, y, w)
    # A level and a place for each step, and a level; the line has a slope and a place.
    fewer = 2 * len(run) + 1 - 3
    if not of_line < of_levels * len(y) ** (fewer / len(y)):
        return None
    line = trend_of(t[bend:], y[bend:], w[bend:])
    if line is None:
        return None
    return Change("trend", own.start + bend, run[0][1], line.slope, line.low, line.high)


def _bend(time: Array, values: Array, weights: Array) -> tuple[int, float]:
    """Where a level turns into a line that lasts a month or more, and what both miss; infinite with too few days."""
    best = (0, np.inf)
    last = int(np.searchsorted(time, time[-1] - SHORTEST, side="right"))
    for bend in np.unique(np.linspace(0, last - 1, BENDS).astype(int)) if last > 0 else ():
        ramp = np.maximum(time - time[bend], 0.0)
        ramp -= weights @ ramp / weights.sum()
        level = values - weights @ values / weights.sum()
        slope = float(weights @ (ramp * level)) / max(float(weights @ ramp**2), np.finfo(float).tiny)
        missed = float(weights @ (level - slope * ramp) ** 2)
        if missed < best[1]:
            best = (int(bend), missed)
    return best


def _is_outlier(
    place: int, starts: Sequence[int], time: Array, values: Array, weights: Array, limits: Limits
) -> bool:
    """Whether a day stands apart from the line through the others, not only from those before it."""
    own = _segment(place, starts, len(time))
    others = np.setdiff1d(own, [place])
    line = trend_of(time[others], values[others], weights[others])
    if line is None:
        return True
    missed = values[own] - line.slope * time[own] / MONTH
    missed = missed - np.median(missed)
    usual = float(np.median(np.abs(missed))) / 0.6745  # a normal deviation by its quartiles
    return usual == 0 or abs(float(missed[own == place][0])) > 0.8 * limits.outlier * usual


def _trends(
    time: Array,
    values: Array,
    weights: Array,
    steps: Sequence[tuple[int, int]],
    alone: Sequence[int],
    rate: float,
) -> list[Change]:
    """A look at the last three months each month, behind the last step that was seen by then."""
    probability = min(rate / KINDS / 12, LARGEST_SHARE)
    found = []
    for tick in np.arange(time[0] + MONTH, time[-1] + MONTH / 2, MONTH):
        end = int(np.searchsorted(time, tick, side="right"))
        start = max((first for first, seen in steps if seen < end), default=0)
        own = np.setdiff1d(np.flatnonzero((time > tick - WINDOW) & (time <= tick)), alone)
        own = own[own >= start]
        if len(own) <= BASELINE or time[own[-1]] - time[own[0]] < 0.9 * SHORTEST:
            continue
        line = trend_of(time[own], values[own], weights[own])
        if line is not None and line.probability < probability:
            found.append(Change("trend", int(own[0]), int(own[-1]), line.slope, line.low, line.high))
    return found


def _merged(trends: Sequence[Change], time: Array) -> list[Change]:
    """Trends that go on are one: seen when the first was seen, of the size of the last, which has most days."""
    merged: list[Change] = []
    last_seen = 0
    for change in sorted(trends, key=lambda one: one.seen):
        again = time[change.seen] - time[last_seen] < AGAIN
        last_seen = change.seen
        if merged and again and np.sign(merged[-1].size) == np.sign(change.size):
            before = merged.pop()
            change = replace(change, first=min(before.first, change.first), seen=before.seen)
        merged.append(change)
    return merged


def _step(step: tuple[int, int], starts: Sequence[int], time: Array, values: Array, weights: Array) -> Change:
    """A step with its size, from the days beside it up to the next ones."""
    first, seen = step
    before = _segment(first - 1, starts, len(time)) if first else np.arange(0)
    behind = _segment(first, starts, len(time))
    before = before[time[before] > time[first] - BESIDE]
    behind = behind[time[behind] < time[first] + BESIDE]
    if len(before) < 2 or len(behind) < 2:
        return Change("step", first, seen, float(values[seen] - values[max(first - 1, 0)]), -np.inf, np.inf)
    sides = [(values[own], weights[own]) for own in (before, behind)]
    means = [float(np.average(y, weights=w)) for y, w in sides]
    missed = sum(float(w @ (y - mean) ** 2) for (y, w), mean in zip(sides, means, strict=True))
    freedom = len(before) + len(behind) - 2
    std = np.sqrt(missed / freedom * sum(1 / float(w.sum()) for _, w in sides))
    size, wide = means[1] - means[0], float(stdtrit(freedom, 0.975) * std)
    return Change("step", first, seen, size, size - wide, size + wide)


def _outlier(place: int, starts: Sequence[int], values: Array) -> Change:
    others = np.setdiff1d(_segment(place, starts, len(values)), [place])
    size = float(values[place] - np.median(values[others]))
    scatter = NORMAL95 * float(np.std(values[others]))
    return Change("outlier", place, place, size, size - scatter, size + scatter)


def _segment(place: int, starts: Sequence[int], count: int) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """The days between the steps around a day."""
    start = max(first for first in starts if first <= place)
    end = min((first for first in starts if first > place), default=count)
    return np.arange(start, end)
