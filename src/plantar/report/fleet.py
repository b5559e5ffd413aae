"""The report of a fleet: alarms first, then every robot with its stiffness over time; one page that opens offline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from plantar import __version__
from plantar.conventions import Array
from plantar.fleet.series import Days, Series
from plantar.fleet.summary import WATCHED, FleetSummary, Level
from plantar.fleet.tables import GroupRow
from plantar.report.content import Cell, Column, Table
from plantar.report.page import render
from plantar.results.numbers import number, unit

POINTS: Final = 150  # days drawn of one series; more become means of neighbours
SHOWN: Final = 200  # alarms on the page: more of them are in fleet.json


def fleet_page(summary: FleetSummary, groups: Sequence[GroupRow], run: Mapping[str, Any] | None) -> str:
    """`fleet.html` of a summary.

    groups: for links to each group's result. run: what `plantar fleet run` counted, in `run.json`.
    """
    units = _units(summary, groups)
    return render(
        "fleet.html.j2",
        styles=["uPlot.min.css", "report.css"],
        scripts=["uPlot.iife.min.js", "payload.js", "colours.js", "plots.js", "fleet.js"],
        title="Fleet",
        result={"version": __version__, "created": ""},
        verdict=_verdict(summary, len(units), run or {}),
        alarms=summary.alarms[:SHOWN],
        more_alarms=max(0, len(summary.alarms) - SHOWN),
        rate=f"{summary.false_alarms:.3g}",
        tables=[one for one in (_robots(summary), _effects(summary), _trends(summary)) if one.rows],
        failures=_failures(summary),
        units=units,
    )


def _verdict(summary: FleetSummary, units: int, run: Mapping[str, Any]) -> list[str]:
    failed = sum(reason.count for reason in summary.failures)
    counts = {"group": summary.groups, "robot": units, "failure": failed, "alarm": len(summary.alarms)}
    groups, *rest = (f"{count} {what}{'' if count == 1 else 's'}" for what, count in counts.items())
    sentences = [f"{groups} of {'; '.join(rest)}."]
    if not summary.levels:
        sentences.append(
            "No number is usable, so none is watched and no alarm can come. `plantar report` of a group says why."
        )
    done, seconds = run.get("done"), run.get("seconds")
    if isinstance(done, int) and isinstance(seconds, float) and done and seconds > 0:
        reused = run.get("reused", 0)
        pace = f"{number(3600 * done / seconds, 3)} groups an hour"
        sentences.append(
            f"The last run computed {done} groups in {number(seconds, 3)} s ({pace}); {reused} were there already."
        )
    return sentences


def _robots(summary: FleetSummary) -> Table:
    """A row for each robot: stiffness of each foot and axis, alarms."""
    levels = [level for level in summary.levels if level.name == WATCHED]
    places = list(dict.fromkeys((level.foot, level.axis, level.unit_of_value) for level in levels))
    of_unit: dict[str, dict[tuple[str, str, str], Level]] = {}
    for level in levels:
        of_unit.setdefault(level.unit, {})[level.foot, level.axis, level.unit_of_value] = level
    alarmed = {alarm.unit for alarm in summary.alarms if alarm.kind != "outlier"}
    rows = []
    for name, own in of_unit.items():
        count = sum(alarm.unit == name for alarm in summary.alarms)
        most = max(level.recordings for level in own.values())
        cells = [_level_cell(own.get(place)) for place in places]
        mark = Cell(str(count), "weak" if name in alarmed else "")
        rows.append([Cell(name), Cell(str(most)), *cells, mark])
    columns = [Column("robot", numeric=False), Column("recordings")]
    columns += [Column(f"{foot} {axis}", unit(of)) for foot, axis, of in places]
    remark = "Since the last step; ± holds 95 % and allows for what all recordings of a robot share."
    return Table.of("Stiffness of each robot", [*columns, Column("alarms")], rows, remark=remark)


def _level_cell(level: Level | None) -> Cell:
    if level is None:
        return Cell("–")
    half = (level.sure_high - level.sure_low) / 2
    hover = (
        f"mean of {level.recordings} recordings; as days scatter {number(level.low)} to {number(level.high)}"
    )
    return Cell(f"{number(level.value)} ± {number(half, 2)}", hover=hover)


def _effects(summary: FleetSummary) -> Table:
    rows = [
        (row.foot, row.axis, row.name, unit(row.unit_of_value), number(row.value),
         f"{number(row.low)} to {number(row.high)}", str(row.units), str(row.recordings),
         *(_percent(share) for share in (row.recordings_percent, row.days_percent, row.units_percent)))
        for row in summary.effects
    ]  # fmt: skip
    columns = Column.words("foot", "axis", "parameter", "unit")
    columns += [
        Column("mean"),
        Column("95 % interval", numeric=False),
        Column("robots"),
        Column("recordings"),
    ]
    columns += [Column(f"{who} differ", "%") for who in ("recordings of a day", "days of a robot", "robots")]
    remark = "Random effects: the interval is for the mean of such robots; a dash: nothing shows that part."
    return Table.of("The fleet", columns, rows, remark=remark)


def _trends(summary: FleetSummary) -> Table:
    rows = [
        (level.unit, level.foot, level.axis, level.name, str(level.since), _percent(level.trend),
         f"{_percent(level.trend_low)} to {_percent(level.trend_high)}")
        for level in summary.levels
        if level.trend is not None
    ]  # fmt: skip
    columns = Column.words("robot", "foot", "axis", "parameter", "since")
    columns += [Column("trend", "% a month"), Column("95 % interval", numeric=False)]
    return Table.of("Trends since the last step", columns, rows, folded=True)


def _failures(summary: FleetSummary) -> Table | None:
    if not summary.failures:
        return None
    rows = [(str(row.count), row.reason, row.example) for row in summary.failures]
    columns = [
        Column("failures"),
        Column("reason (# for numbers)", numeric=False),
        Column("one of them", numeric=False),
    ]
    return Table.of("Failures by reason; failures.parquet has each", columns, rows)


def _units(summary: FleetSummary, groups: Sequence[GroupRow]) -> list[dict[str, Any]]:
    """What the page draws when a robot is opened."""
    found: dict[str, dict[str, Any]] = {}
    for level, series, days in zip(summary.levels, summary.series, summary.days, strict=True):
        own = found.setdefault(level.unit, {"name": level.unit, "series": [], "groups": []})
        if level.name == WATCHED and len(days.day) > 1:
            own["series"].append(_drawn(level, series, days))
    for row in groups:
        own = found.setdefault(row.unit, {"name": row.unit, "series": [], "groups": []})
        day = "" if row.time is None else str(row.time.date())
        own["groups"].append([row.group, day, row.key])
    for name, own in found.items():
        own["alarms"] = sum(alarm.unit == name for alarm in summary.alarms)
    return list(found.values())


def _drawn(level: Level, series: Series, days: Days) -> dict[str, Any]:
    """One series, thinned: days [s since 1970] and values, and the level with its bounds."""
    parts = np.array_split(np.arange(len(days.day)), min(POINTS, len(days.day)))
    time, values = (np.array([of[part].mean() for part in parts]) for of in (days.day, np.exp(days.values)))
    return {
        "foot": series.key.foot,
        "title": f"{series.key.foot} {series.key.axis} {series.key.name} [{unit(series.key.unit_of_value)}]",
        "time": _rounded(86400 * time, 0),
        "values": _rounded(values, 4 - int(np.ceil(np.log10(values.max())))),
        "since": 86400 * (level.since.toordinal() - EPOCH) if level.since else None,
        "bounds": [float(f"{one:.5g}") for one in (level.low, level.high, level.sure_low, level.sure_high)],
    }


def _rounded(values: Array, digits: int) -> list[float]:
    return [float(value) for value in np.round(values, digits)]


def _percent(share: float | None) -> str:
    return "–" if share is None else f"{share:.2g}".replace("-", "−")


EPOCH: Final = 719163  # `toordinal` of 1970-01-01
