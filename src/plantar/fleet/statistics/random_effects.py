"""A mean over recordings, days and robots that differ by themselves: three levels of random effects.

Value of a recording = fleet's mean + robot + day + recording + its own error. How much each level differs is found by
R. C. Paule and J. Mandel's equation (J. Res. NBS 87, 1982), with one variance for all groups of a level; the mean's
interval is J. Hartung and G. Knapp's (Statistics in Medicine 20, 2001), which takes its width from the scatter that is
seen and Student's t for the few members of the top level.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import brentq
from scipy.stats import t as student

from plantar.conventions import Array

LEVEL: Final = 0.95
LEAST: Final = 1e-12  # of the mean square, so that values without any deviation of their own can be weighed


@dataclass(frozen=True)
class Mean:
    """A mean of `members`, its standard deviation, degrees of freedom and 95 % interval."""

    value: float
    std: float
    freedom: float
    low: float
    high: float
    members: int


@dataclass(frozen=True)
class NestedMeans:
    """The fleet's mean and each unit's, and the deviations between recordings of a day, days of a unit, and units.

    A deviation is None where nothing shows it: no day with two recordings, no unit with two days, one unit only.
    """

    fleet: Mean
    units: dict[Hashable, Mean]
    recordings_std: float | None
    days_std: float | None
    units_std: float | None


def nested_means(
    values: Array, stds: Array, days: Sequence[Hashable], units: Sequence[Hashable]
) -> NestedMeans:
    """Means over recordings (N,) with standard deviations (N,) of their own, on days of units (N labels each).

    The deviations need not be right: what all recordings of a unit share does not show in their scatter and makes them
    too large; what they miss is found as a difference between recordings or days.

    Example:
        >>> import numpy as np
        >>> from plantar.fleet.statistics.random_effects import nested_means
        >>> found = nested_means(np.array([1.0, 1.2, 2.0, 2.2]), np.full(4, 0.01), [1, 1, 2, 2], ["a", "a", "b", "b"])
        >>> round(found.fleet.value, 2), found.fleet.members, round(found.units["a"].value, 2)
        (1.6, 2, 1.1)
    """
    squares = np.maximum(stds**2, LEAST * float(np.mean(values**2)))
    by_day = _positions(list(zip(units, days, strict=True)))
    recordings = _between([(values[own], squares[own]) for own in by_day.values()])
    of_days = {key: pooled(values[own], squares[own], recordings or 0.0) for key, own in by_day.items()}
    by_unit: dict[Hashable, list[tuple[float, float]]] = {}
    for (unit, _), summary in of_days.items():
        by_unit.setdefault(unit, []).append(summary)
    day_sets = [(np.array([y for y, _ in own]), np.array([v for _, v in own])) for own in by_unit.values()]
    day_variance = _between(day_sets)
    summaries = [pooled(y, v, day_variance or 0.0) for y, v in day_sets]
    unit_set = (np.array([y for y, _ in summaries]), np.array([v for _, v in summaries]))
    unit_variance = _between([unit_set])
    means = {unit: mean_of(y, v, day_variance or 0.0) for unit, (y, v) in zip(by_unit, day_sets, strict=True)}
    fleet = mean_of(*unit_set, unit_variance or 0.0)
    if len(means) == 1:
        fleet = next(iter(means.values()))
    return NestedMeans(fleet, means, _root(recordings), _root(day_variance), _root(unit_variance))


def pooled(values: Array, variances: Array, between: float) -> tuple[float, float]:
    """The weighted mean of values (n,) and its variance, where they differ by a variance `between` beyond their own."""
    weights = 1 / (variances + between)
    return float(weights @ values / weights.sum()), float(1 / weights.sum())


def mean_of(values: Array, variances: Array, between: float) -> Mean:
    """The mean of values (n,) with Hartung and Knapp's interval; of one value, from its own variance."""
    value, variance = pooled(values, variances, between)
    freedom = float(len(values) - 1)
    if freedom > 0:
        weights = 1 / (variances + between)
        variance = float(weights @ (values - value) ** 2 / weights.sum() / freedom)
    std = float(np.sqrt(variance))
    wide = std * float(student.ppf((1 + LEVEL) / 2, freedom if freedom > 0 else np.inf))
    return Mean(value, std, freedom if freedom > 0 else np.inf, value - wide, value + wide, len(values))


def _between(groups: Sequence[tuple[Array, Array]]) -> float | None:
    """The variance by which the members of each group differ, the same in all: Paule and Mandel's equation summed up.

    None where no group has two members.
    """
    groups = [(y, v) for y, v in groups if len(y) > 1]
    freedom = sum(len(y) - 1 for y, _ in groups)
    if not freedom:
        return None

    def excess(between: float) -> float:
        total = 0.0
        for y, v in groups:
            mean, _ = pooled(y, v, between)
            total += float(np.sum((y - mean) ** 2 / (v + between)))
        return total - freedom

    if excess(0.0) <= 0:
        return 0.0
    high = sum(float(np.sum((y - y.mean()) ** 2)) for y, _ in groups)
    return float(brentq(excess, 0.0, high))


def _positions(labels: Sequence[tuple[Hashable, Hashable]]) -> dict[tuple[Hashable, Hashable], list[int]]:
    found: dict[tuple[Hashable, Hashable], list[int]] = {}
    for place, label in enumerate(labels):
        found.setdefault(label, []).append(place)
    return found


def _root(variance: float | None) -> float | None:
    return None if variance is None else float(np.sqrt(variance))
