"""The results of a fleet as series over time: one for each robot, foot, axis and parameter."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from datetime import UTC, date, datetime, timedelta
from typing import Any, Final

import numpy as np

from plantar.conventions import Array

SECONDS: Final = 86400.0
EPOCH: Final = date(1970, 1, 1)
USED: Final = ("stiffness", "damping")


@dataclass(frozen=True)
class SeriesKey:
    """What a series is of: a parameter of a bush, the same for all units."""

    foot: str
    axis: str
    name: str
    unit_of_value: str


@dataclass(frozen=True)
class Series:
    """The usable values of one parameter of one unit, in time's order, those without a time last.

    `times` (N,) [days since 1970-01-01 UTC], NaN where the manifest has none; `values` (N,) are logarithms, so that
    differences are shares; `stds` (N,) are shares as well: as reported, what all recordings of a robot share included.
    """

    unit: str
    key: SeriesKey
    groups: tuple[str, ...]
    times: Array
    values: Array
    stds: Array

    @property
    def days(self) -> list[Hashable]:
        """The day (UTC) of each value; a group without time is a day of its own."""
        return [
            group if np.isnan(time) else int(time)
            for group, time in zip(self.groups, self.times, strict=True)
        ]


@dataclass(frozen=True)
class Days:
    """A series by its days: (M,) each: the day since 1970, the mean, how many recordings, and their groups' names."""

    day: Array
    values: Array
    counts: Array
    groups: tuple[tuple[str, ...], ...]

    def weights(self, recordings_std: float | None, days_std: float | None) -> Array:
        """One over the variance of each day's mean, up to one factor, where recordings and days differ by so much."""
        variance = (days_std or 0.0) ** 2 + (recordings_std or 0.0) ** 2 / self.counts
        return np.ones(len(self.day)) if not variance.all() else 1 / variance

    def date(self, place: int) -> date:
        return EPOCH + timedelta(days=int(self.day[place]))


def series_of(rows: Sequence[dict[str, Any]]) -> list[Series]:
    """The series in rows of `results.parquet`; values that are not usable or not positive are left out."""
    found: dict[tuple[str, SeriesKey], list[tuple[float, str, float, float]]] = {}
    for row in rows:
        value, std = row["value"], row["std"]
        if row["name"] not in USED or row["verdict"] != "usable" or not value or value <= 0:
            continue
        key = SeriesKey(row["foot"], row["axis"], row["name"], row["unit_of_value"])
        entry = (_days_since(row["time"]), row["group"], float(np.log(value)), (std or 0.0) / value)
        found.setdefault((row["unit"], key), []).append(entry)
    return [_series(unit, key, entries) for (unit, key), entries in sorted(found.items(), key=_order)]


def by_day(series: Series) -> Days:
    """The series' values that have a time, a mean for each day."""
    known = ~np.isnan(series.times)
    days, place = np.unique(np.floor(series.times[known]), return_inverse=True)
    counts = np.bincount(place, minlength=len(days)).astype(float)
    values = np.bincount(place, series.values[known], minlength=len(days)) / np.maximum(counts, 1)
    groups: list[list[str]] = [[] for _ in days]
    for day, group in zip(place, np.array(series.groups, dtype=object)[known], strict=True):
        groups[day].append(str(group))
    return Days(days, values, counts, tuple(map(tuple, groups)))


def _series(unit: str, key: SeriesKey, entries: list[tuple[float, str, float, float]]) -> Series:
    ordered = sorted(entries, key=lambda entry: (np.isnan(entry[0]), entry[0]))
    times, groups, values, stds = zip(*ordered, strict=True)
    return Series(unit, key, groups, np.array(times), np.array(values), np.array(stds))


def _days_since(time: datetime | None) -> float:
    return np.nan if time is None else time.astimezone(UTC).timestamp() / SECONDS


def _order(entry: tuple[tuple[str, SeriesKey], Any]) -> tuple[str, ...]:
    unit, key = entry[0]
    return unit, key.foot, key.axis, key.name[::-1]  # stiffness before damping
