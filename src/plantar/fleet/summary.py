"""A fleet's tables looked at together: how feet, days and robots differ, what changes over time, what failed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from datetime import date
from typing import Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from plantar import __version__
from plantar.choices import number_in
from plantar.conventions import NORMAL95
from plantar.fleet.alarms import Alarm, advice_for, alarm_of, percent_of
from plantar.fleet.series import Days, Series, SeriesKey, by_day, series_of
from plantar.fleet.statistics.changes import History, history_of
from plantar.fleet.statistics.random_effects import Mean, NestedMeans, nested_means

SCHEMA: Final = "plantar.fleet/1"
FALSE_ALARMS: Final = 1.0  # a unit and year
WATCHED: Final = "stiffness"  # of what alarms are told: damping follows it, and depends on delays
NUMBERS = re.compile(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", re.IGNORECASE)


@dataclass(frozen=True)
class Effect:
    """One parameter over the fleet: its mean with 95 % interval for robots like these, and by how many percent
    recordings of a day, days of a robot, and robots differ; None where nothing shows it."""

    foot: str
    axis: str
    name: str
    unit_of_value: str
    value: float
    low: float
    high: float
    units: int
    recordings: int
    recordings_percent: float | None
    days_percent: float | None
    units_percent: float | None


@dataclass(frozen=True)
class Level:
    """One parameter of one unit since it last stepped: its value, with the interval of the mean as days scatter
    (`low`, `high`), and the interval that also allows for what all recordings of the robot share
    (`sure_low`, `sure_high`); its trend in percent a month."""

    unit: str
    foot: str
    axis: str
    name: str
    unit_of_value: str
    value: float
    low: float
    high: float
    sure_low: float
    sure_high: float
    recordings: int
    since: date | None
    trend: float | None
    trend_low: float | None
    trend_high: float | None


@dataclass(frozen=True)
class Reason:
    """Failures that are alike: how many, and one of them."""

    reason: str
    count: int
    example: str


@dataclass(frozen=True)
class FleetSummary:
    """What `plantar fleet report` writes; `series` and `days` stand behind `levels`, in their order."""

    groups: int
    false_alarms: float
    effects: tuple[Effect, ...]
    levels: tuple[Level, ...]
    alarms: tuple[Alarm, ...]
    failures: tuple[Reason, ...]
    series: tuple[Series, ...]
    days: tuple[Days, ...]

    def to_dict(self) -> dict[str, Any]:
        """The content of `fleet.json`."""
        parts: dict[str, list[dict[str, Any]]] = {
            "effects": [asdict(row) for row in self.effects],
            "levels": [asdict(row) for row in self.levels],
            "alarms": [asdict(row) for row in self.alarms],
            "failures": [asdict(row) for row in self.failures],
        }
        for rows in parts.values():
            for row in rows:
                row |= {key: str(value) for key, value in row.items() if isinstance(value, date)}
        head = {"schema": SCHEMA, "plantar": __version__, "groups": self.groups}
        return {**head, "false_alarms_per_unit_and_year": self.false_alarms, **parts}


def summary_of(results: pa.Table, failures: pa.Table, false_alarms: float) -> FleetSummary:
    """The summary of a fleet's tables, with `false_alarms` a unit and year where nothing changes.

    Raises SettingsError for a rate that is not between 0.001 and 100.
    """
    number_in("false alarms", false_alarms, 1e-3, 100.0, "a robot and year")
    series = series_of(results)
    days = [by_day(one) for one in series]
    of_unit = Counter(one.unit for one in series if one.key.name == WATCHED)
    scatter = {key: _nested(own) for key, own in _by_key(series).items()}
    histories: list[History] = []
    for one, own in zip(series, days, strict=True):
        rate = false_alarms / max(of_unit[one.unit], 1)
        weights = own.weights(scatter[one.key].recordings_std, scatter[one.key].days_std)
        histories.append(history_of(own.day, own.values, weights, rate))
    effects, means = _effects(series, days, histories)
    levels = tuple(
        _level(one, own, history, means[one.key].units[one.unit])
        for one, own, history in zip(series, days, histories, strict=True)
    )
    alarms = [
        alarm_of(one, own, change)
        for one, own, history in zip(series, days, histories, strict=True)
        if one.key.name == WATCHED
        for change in history.changes
    ]
    names = pa.chunked_array([*results["group"].chunks, *failures["group"].chunks], pa.string())
    return FleetSummary(
        len(pc.unique(names)), false_alarms, effects, levels,
        _advised(alarms), reasons_of(failures), tuple(series), tuple(days),
    )  # fmt: skip


def reasons_of(failures: pa.Table) -> tuple[Reason, ...]:
    """Failures counted by what they say without places and numbers, the most frequent first."""
    examples: dict[str, str] = {}
    counts: Counter[str] = Counter()
    for row in failures.to_pylist():
        said = row["error"].replace(row["log"], "") if row["log"] else row["error"]
        reason = NUMBERS.sub("#", said.lstrip(" :,"))
        examples.setdefault(reason, row["error"])
        counts[reason] += 1
    return tuple(Reason(reason, count, examples[reason]) for reason, count in counts.most_common())


def _effects(
    series: Sequence[Series], days: Sequence[Days], histories: Sequence[History]
) -> tuple[tuple[Effect, ...], dict[SeriesKey, NestedMeans]]:
    """Each parameter's effects, from the recordings since each unit last stepped."""
    recent = [_since_step(one, own, hist) for one, own, hist in zip(series, days, histories, strict=True)]
    means = {key: _nested(own) for key, own in _by_key(recent).items()}
    effects = []
    for key, found in means.items():
        own = [one for one in recent if one.key == key]
        mean = found.fleet
        half = _with_shared(mean, own[0]) if len(own) == 1 else (mean.high - mean.low) / 2
        value, low, high = (float(np.exp(mean.value + side * half)) for side in (0, -1, 1))
        recordings = sum(len(one.values) for one in own)
        shares = (found.recordings_std, found.days_std, found.units_std)
        effects.append(
            Effect(
                key.foot, key.axis, key.name, key.unit_of_value, value, low, high, len(found.units), recordings,
                *(None if share is None else 100 * share for share in shares),
            )
        )  # fmt: skip
    return tuple(effects), means


def _since_step(series: Series, days: Days, history: History) -> Series:
    """The values from the last step on; those without a time stay."""
    if history.start == 0:
        return series
    kept = ~(series.times < days.day[history.start])
    groups = tuple(group for group, keep in zip(series.groups, kept, strict=True) if keep)
    times, values, stds = (part[kept] for part in (series.times, series.values, series.stds))
    return replace(series, groups=groups, times=times, values=values, stds=stds)


def _by_key(series: Sequence[Series]) -> dict[SeriesKey, list[Series]]:
    found: dict[SeriesKey, list[Series]] = {}
    for one in series:
        found.setdefault(one.key, []).append(one)
    return found


def _nested(series: Sequence[Series]) -> NestedMeans:
    """Means of one parameter from how its values scatter.

    Reported deviations are left out: most of them is what a robot's recordings share, which does not scatter.
    """
    values = np.concatenate([one.values for one in series])
    days = [day for one in series for day in one.days]
    units = [one.unit for one in series for _ in one.values]
    return nested_means(values, np.zeros(len(values)), days, units)


def _level(series: Series, days: Days, history: History, mean: Mean) -> Level:
    """The parameter of one unit now."""
    sure = _with_shared(mean, series)
    recent = _since_step(series, days, history)
    line, key = history.trend, series.key
    bounds = (mean.value, mean.low, mean.high, mean.value - sure, mean.value + sure)
    value, low, high, sure_low, sure_high = (float(np.exp(bound)) for bound in bounds)
    return Level(
        series.unit, key.foot, key.axis, key.name, key.unit_of_value, value, low, high, sure_low, sure_high,
        recordings=len(recent.values), since=days.date(history.start) if len(days.day) else None,
        trend=None if line is None else percent_of(line.slope),
        trend_low=None if line is None else percent_of(line.low),
        trend_high=None if line is None else percent_of(line.high),
    )  # fmt: skip


def _with_shared(mean: Mean, series: Series) -> float:
    """Half of a mean's 95 % interval together with what its recordings share, at most what each of them reports."""
    return float(np.hypot((mean.high - mean.low) / 2, NORMAL95 * float(np.median(series.stds))))


def _advised(alarms: Sequence[Alarm]) -> tuple[Alarm, ...]:
    """Alarms with advice, the latest first, outliers behind what lasts."""
    of_unit: dict[str, list[Alarm]] = {}
    for alarm in alarms:
        of_unit.setdefault(alarm.unit, []).append(alarm)
    advised = [
        replace(alarm, advice=advice_for(alarm, [one for one in of_unit[alarm.unit] if one is not alarm]))
        for alarm in alarms
    ]
    advised.sort(key=lambda alarm: (alarm.kind == "outlier", -alarm.seen.toordinal(), alarm.text))
    return tuple(advised)
