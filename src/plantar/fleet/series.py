"""The results of a fleet as series over time: one for each robot, foot, axis and parameter."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from datetime import date, timedelta
from typing import Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from plantar.conventions import Array

MICROSECONDS: Final = 86400e6
"""Of a day."""
EPOCH: Final = date(1970, 1, 1)
USED: Final = ("stiffness", "damping")
KEY: Final = ("unit", "foot", "axis", "name", "unit_of_value")


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


def series_of(results: pa.Table) -> list[Series]:
    """The series in `results.parquet`; values that are not usable or not positive are left out."""
    used = pc.is_in(results["name"], value_set=pa.array(USED, pa.string()))
    used = pc.and_(used, pc.equal(results["verdict"], "usable"))
    table = results.filter(pc.and_(used, pc.fill_null(pc.greater(results["value"], 0.0), False)))
    if not len(table):
        return []
    codes, names = zip(*(_coded(table[name]) for name in KEY), strict=True)
    whole = table["time"].cast(pa.int64()).cast(pa.float64(), safe=False)
    times = np.asarray(whole.to_numpy()) / MICROSECONDS
    values = table["value"].to_numpy()
    stds = pc.fill_null(table["std"], 0.0).to_numpy() / values
    group, group_names = _coded(table["group"])
    found, which = np.unique(np.column_stack(codes), axis=0, return_inverse=True)
    order = np.lexsort((times, which))  # NaN stands last
    parts = np.split(order, np.cumsum(np.bincount(which))[:-1])
    series = []
    for code, rows in zip(found, parts, strict=True):
        unit, foot, axis, name, unit_of_value = (texts[k] for texts, k in zip(names, code, strict=True))
        key = SeriesKey(foot, axis, name, unit_of_value)
        of = tuple(group_names[k] for k in group[rows])
        series.append(Series(unit, key, of, times[rows], np.log(values[rows]), stds[rows]))
    return sorted(series, key=_order)


def _coded(column: pa.ChunkedArray) -> tuple[np.ndarray[tuple[int], np.dtype[np.intp]], list[str]]:
    """A text column as numbers, and the texts: a fleet has few texts and many rows."""
    coded = column.combine_chunks().dictionary_encode()
    return np.asarray(coded.indices, dtype=np.intp), coded.dictionary.to_pylist()


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


def _order(series: Series) -> tuple[str, str, str, int]:
    key = series.key
    return series.unit, key.foot, key.axis, USED.index(key.name)
