"""A mean over recordings, days and robots that differ by themselves: three levels of random effects.

Value of a recording = fleet's mean + robot + day + recording + its own error. How much each level differs is found by
R. C. Paule and J. Mandel's equation (J. Res. NBS 87, 1982), with one variance for all groups of a level; the mean's
interval is J. Hartung and G. Knapp's (Statistics in Medicine 20, 2001), which takes its width from the scatter that is
seen and Student's t for the few members of the top level.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.stats import t as student

from plantar.conventions import ROUNDING, Array

Labels = np.ndarray[tuple[int], np.dtype[np.intp]]


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
    squares = np.maximum(stds**2, ROUNDING * float(np.mean(values**2)))
    names = list(dict.fromkeys(units))
    day_of, of_days = _labelled(list(zip(units, days, strict=True)))
    recordings = _between(values, squares, day_of)
    day_values, day_squares = pooled(values, squares, recordings or 0.0, day_of)
    place = {unit: number for number, unit in enumerate(names)}
    unit_of = np.array([place[unit] for unit, _ in of_days])
    day_variance = _between(day_values, day_squares, unit_of)
    unit_values, unit_squares = pooled(day_values, day_squares, day_variance or 0.0, unit_of)
    unit_variance = _between(unit_values, unit_squares, np.zeros(len(names), dtype=int))
    own = [unit_of == number for number in range(len(names))]
    means = {
        unit: mean_of(day_values[of], day_squares[of], day_variance or 0.0)
        for unit, of in zip(names, own, strict=True)
    }
    fleet = mean_of(unit_values, unit_squares, unit_variance or 0.0)
    if len(means) == 1:
        fleet = means[names[0]]
    return NestedMeans(fleet, means, _root(recordings), _root(day_variance), _root(unit_variance))


def pooled(values: Array, variances: Array, between: float, group: Labels) -> tuple[Array, Array]:
    """The weighted mean of each group (g,) and its variance, where values (n,) of a group differ by a variance
    `between` beyond their own; `group` (n,) counts from 0."""
    weights = 1 / (variances + between)
    total = np.bincount(group, weights)
    return np.bincount(group, weights * values) / total, 1 / total


def mean_of(values: Array, variances: Array, between: float) -> Mean:
    """The mean of values (n,) with Hartung and Knapp's interval; of one value, from its own variance."""
    (value,), (variance,) = (
        part.tolist() for part in pooled(values, variances, between, np.zeros(len(values), int))
    )
    freedom = float(len(values) - 1)
    if freedom > 0:
        weights = 1 / (variances + between)
        variance = float(weights @ (values - value) ** 2 / weights.sum() / freedom)
    std = float(np.sqrt(variance))
    wide = std * float(student.ppf(0.975, freedom if freedom > 0 else np.inf))
    return Mean(value, std, freedom if freedom > 0 else np.inf, value - wide, value + wide, len(values))


def _between(values: Array, variances: Array, group: Labels) -> float | None:
    """The variance by which the members of each group differ, the same in all: Paule and Mandel's equation summed up.

    None where no group has two members.
    """
    freedom = len(values) - len(np.unique(group))
    if not freedom:
        return None

    def excess(between: float) -> float:
        means, _ = pooled(values, variances, between, group)
        return float(np.sum((values - means[group]) ** 2 / (variances + between))) - freedom

    if excess(0.0) <= 0:
        return 0.0
    plain, _ = pooled(values, np.ones(len(values)), 0.0, group)
    return float(brentq(excess, 0.0, float(np.sum((values - plain[group]) ** 2))))


def _labelled(labels: Sequence[Hashable]) -> tuple[Labels, list[Any]]:
    """Labels as numbers from 0 in the order of first appearance, and the labels."""
    known = {label: number for number, label in enumerate(dict.fromkeys(labels))}
    return np.array([known[label] for label in labels]), list(known)


def _root(variance: float | None) -> float | None:
    return None if variance is None else float(np.sqrt(variance))
