"""Days of one number watched one after the other: outliers and steps, with the false-alarm rate that is asked for.

A self-starting chart (D. M. Hawkins, The Statistician 36, 1987): each day is compared with the mean and the scatter of
those before it. Where nothing changes, Student's t makes of this a standard normal number, independent of the others,
however few days there were, so that no baseline has to be declared good. An outlier is one such number beyond a limit;
a step, their cumulative sum beyond another (E. S. Page, Biometrika 41, 1954).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtri, stdtr

from plantar.conventions import ROUNDING, Array

BASELINE: Final = 4  # days that are compared with none: with fewer, Student's t has tails that hide any step
ALLOWANCE: Final = 0.5  # deviations of a day: half of the smallest step that is worth finding quickly
CLIP: Final = 3.0  # deviations by which one day may count towards a step: an outlier alone is none
# D. Siegmund's correction for sums that end beyond their limit (Sequential Analysis, 1985).
OVERSHOOT: Final = 1.166
SURE: Final = 1e-14  # probabilities below it are all the same


@dataclass(frozen=True)
class Limits:
    """What counts as an outlier [deviations], and how large a cumulative sum is a step."""

    outlier: float
    step: float


@dataclass(frozen=True)
class Found:
    """What the chart saw: days (by their place) that stand alone, and steps: first day after it, day it was seen."""

    outliers: tuple[int, ...]
    steps: tuple[tuple[int, int], ...]


def limits_of(outliers: float, steps: float) -> Limits:
    """Limits for false alarms: the share of days that may be called outliers, and that of days on which a step is seen.

    Both above 0 and below 1. The cumulative sum's mean time to a false alarm is Siegmund's approximation.
    """
    length = 2 / steps  # of one side of two

    def excess(limit: float) -> float:
        reach = 2 * ALLOWANCE * (limit + OVERSHOOT)
        return float((np.exp(reach) - reach - 1) / (2 * ALLOWANCE**2) - length)

    step = brentq(excess, 0.0, 60.0) if excess(0.0) < 0 else 0.0
    return Limits(float(-ndtri(outliers / 2)), float(step))


def watch(values: Array, weights: Array, limits: Limits) -> Found:
    """Outliers and steps among values (n,) in time's order.

    weights: (n,), one over the variance of each value up to one factor. After a step the chart starts anew with the
    days behind it; a day that is called an outlier is compared with others, but they are not compared with it.
    """
    outliers: list[int] = []
    steps: list[tuple[int, int]] = []
    start = 0
    while True:
        alone, step = _until_step(values, weights, limits, start)
        if step is None:
            return Found((*outliers, *alone), tuple(steps))
        outliers += [place for place in alone if place < step[0]]
        steps.append(step)
        start = step[0]


def _until_step(
    values: Array, weights: Array, limits: Limits, start: int
) -> tuple[list[int], tuple[int, int] | None]:
    """Outliers up to the first step after `start`, and the step."""
    count, total, mean, square = 0, 0.0, 0.0, 0.0
    upward = downward = 0.0
    alone: list[int] = []
    for place in range(start, len(values)):
        value, weight = float(values[place]), float(weights[place])
        if count >= BASELINE and square > total * (ROUNDING * mean) ** 2:
            scatter = square / (count - 1) * (1 / weight + 1 / total)
            number = _normal((value - mean) / scatter**0.5, count - 1)
            counted = min(max(number, -CLIP), CLIP)
            upward = max(0.0, upward + counted - ALLOWANCE)
            downward = max(0.0, downward - counted - ALLOWANCE)
            if max(upward, downward) > limits.step:
                calm = np.setdiff1d(np.arange(start, place), alone)
                # An outlier with usual days behind it is none of the step's own days.
                aside = [day for day in alone if np.sum(calm > day) >= BASELINE]
                return alone, (_change_point(values, weights, aside, start, place), place)
            if abs(number) > limits.outlier:
                alone.append(place)
                continue
        count += 1
        total += weight
        share = weight / total
        square += weight * (1 - share) * (value - mean) ** 2
        mean += share * (value - mean)
    return alone, None


def _change_point(values: Array, weights: Array, aside: list[int], start: int, seen: int) -> int:
    """The first day behind a step that is seen on the day `seen`: two levels parted there miss least.

    aside: outliers from before, which count for neither level.
    """
    counted = weights.copy()
    counted[aside] = 0.0
    y, w = values[start : seen + 1], counted[start : seen + 1]
    before, total = np.cumsum(w)[:-1], float(w.sum())
    part = np.cumsum(w * y)[:-1]
    behind = total - before
    gap = part / before - (float(w @ y) - part) / behind
    gain = before * behind * gap**2
    gain[: BASELINE - 1] = -1.0  # where there is no level before it yet
    return start + 1 + int(np.argmax(gain))


def _normal(t: float, freedom: int) -> float:
    """Student's t as the standard normal number of the same probability."""
    tail = max(float(stdtr(freedom, -abs(t))), SURE)
    return float(np.copysign(-ndtri(tail), t))
