"""A fleet's tables looked at together: alarms with words, effects, failures by reason, and the page."""

from __future__ import annotations

import json
from dataclasses import asdict
from datetime import date, timedelta

import numpy as np
import pytest

from fleet_tables import START, STEP_DAY, changing_fleet, failures, results, row
from plantar.errors import SettingsError
from plantar.fleet.alarms import Alarm
from plantar.fleet.series import Series, SeriesKey, by_day, series_of
from plantar.fleet.statistics.changes import History
from plantar.fleet.statistics.random_effects import Mean
from plantar.fleet.summary import (
    FALSE_ALARMS,
    FleetSummary,
    _advised,
    _since_step,
    _with_shared,
    reasons_of,
    summary_of,
)
from plantar.fleet.tables import GroupRow
from plantar.report.fleet import fleet_page


@pytest.fixture(scope="module")
def summary() -> FleetSummary:
    """Three robots over 120 days: one whose left foot got a new sole, one whose rubber ages."""
    return summary_of(changing_fleet(), failures(("x", "/a.csv", "/a.csv: t = 3.5 s: bad")), 0.1)


def test_the_changes_that_are_there_are_the_alarms(summary: FleetSummary) -> None:
    kinds = {(alarm.unit, alarm.foot, alarm.axis, alarm.kind) for alarm in summary.alarms}
    expected = {("new sole", "left", axis, "step") for axis in ("pitch", "roll")}
    expected |= {("ageing", foot, axis, "trend") for foot in ("left", "right") for axis in ("pitch", "roll")}
    assert kinds == expected
    step = next(alarm for alarm in summary.alarms if alarm.kind == "step")
    assert abs((step.since - (START + timedelta(days=STEP_DAY)).date()).days) <= 1
    assert step.percent == pytest.approx(6.2, abs=0.5)
    assert "new sole" in step.text
    assert "all of this foot changed" in step.advice
    trend = next(alarm for alarm in summary.alarms if alarm.kind == "trend")
    assert trend.percent == pytest.approx(2.0, abs=0.3)
    assert "both feet go the same way" in trend.advice


def test_forty_steady_robots_give_forty_alarms_a_year() -> None:
    """The rate is a robot's, over all its feet and axes; a log a week."""
    random = np.random.default_rng(11)
    places = [(foot, axis) for foot in ("left", "right") for axis in ("pitch", "roll")]
    rows = [
        row(f"u{unit}", 7 * week, foot, axis, 400 * np.exp(0.01 * random.normal()))
        for unit in range(40)
        for week in range(52)
        for foot, axis in places
    ]
    assert 0.5 < len(summary_of(results(rows), failures(), 1.0).alarms) / 40 < 1.5


def test_the_level_is_that_since_the_step(summary: FleetSummary) -> None:
    level = next(
        one for one in summary.levels if (one.unit, one.foot, one.axis) == ("new sole", "left", "roll")
    )
    assert level.value == pytest.approx(400 * np.exp(0.06), rel=0.005)
    assert level.recordings in range(58, 63)
    assert level.sure_low < level.low < level.value < level.high < level.sure_high
    assert level.sure_high / level.value == pytest.approx(1.02, abs=0.002)


def test_the_trend_is_told_with_its_interval(summary: FleetSummary) -> None:
    for level in summary.levels:
        assert level.trend_low < level.trend < level.trend_high
        true = 2.0 if level.unit == "ageing" else 0.0  # percent a month
        assert level.trend_low - 0.1 < true < level.trend_high + 0.1, level
        assert (level.trend_low > 0) == (level.unit == "ageing")


def test_plain_data_say_the_same(summary: FleetSummary) -> None:
    content = json.loads(json.dumps(summary.to_dict()))
    assert content["schema"] == "plantar.fleet/1"
    assert len(content["levels"]) == 12
    assert {alarm["seen"][:4] for alarm in content["alarms"]} == {"2026"}
    assert content["effects"][0]["units"] == 3
    assert content["failures"] == [asdict(one) for one in summary.failures]
    assert content["failures"][0]["count"] == 1
    assert (content["groups"], len(content["alarms"])) == (summary.groups, len(summary.alarms))


def test_the_page_shows_alarms_first_and_escapes_names(summary: FleetSummary) -> None:
    odd = [GroupRow("<b>g</b>", "<script>u</script>", START, "ab" * 32)]
    page = fleet_page(summary, odd, {"done": 12, "seconds": 6.0, "reused": 2})
    assert page.index("goes up by") < page.index("Stiffness of each robot") < page.index("Failures by reason")
    assert "<script>u" not in page
    assert "<b>g" not in page
    assert 'http-equiv="Content-Security-Policy"' in page
    assert "7200 groups an hour" in page or "7.2e+03 groups an hour" in page
    assert "src=" not in page.replace("img-src", "").replace("script-src", "").replace("style-src", "")


def test_a_page_of_nothing_is_a_page() -> None:
    empty = summary_of(results([]), failures(), false_alarms=FALSE_ALARMS)
    page = fleet_page(empty, groups=(), run=None)
    assert "None." in page
    assert "none is watched" in page
    assert "<table" not in page, "no heads without rows"


def test_only_usable_positive_values_count() -> None:
    rows = [
        row("u", 0, "left", "pitch", 400.0),
        row("u", 1, "left", "pitch", 400.0, verdict="weak"),
        row("u", 2, "left", "pitch", -3.0),
        row("u", 3, "left", "pitch", 400.0) | {"value": None, "std": None},
        row("u", 4, "left", "pitch", 400.0, name="slip_angle"),
        row("u", 5, "left", "pitch", 410.0, time=None),
        row("u", 6, "left", "pitch", 420.0),
        row("u", 6, "left", "pitch", 440.0),
    ]
    (series,) = series_of(results(rows))
    assert np.exp(series.values) == pytest.approx([400, 420, 440, 410])
    days = by_day(series)
    assert list(days.counts) == [1, 2]
    assert np.exp(days.values[1]) == pytest.approx(np.sqrt(420 * 440))
    assert days.groups == (("u-0",), ("u-6", "u-6"))
    assert series.days[-1] == "u-5"


def test_series_stand_by_robot_foot_axis_and_stiffness_before_damping() -> None:
    places = [("b", "left", "pitch"), ("a", "right", "roll"), ("a", "right", "pitch"), ("a", "left", "roll")]
    rows = [
        row(*place[:1], 0, *place[1:], 400.0, name=name)
        for place in places
        for name in ("damping", "stiffness")
    ]
    found = [(one.unit, one.key.foot, one.key.axis, one.key.name) for one in series_of(results(rows))]
    assert found == [(*place, name) for place in sorted(places) for name in ("stiffness", "damping")]


def test_values_without_a_time_stay_behind_a_step() -> None:
    rows = [row("u", day, "left", "pitch", 400.0 + day) for day in range(4)]
    (series,) = series_of(results([*rows, row("u", 9, "left", "pitch", 500.0, time=None)]))
    days = by_day(series)
    recent = _since_step(series, days, History((), 2, None))
    assert recent.groups == ("u-2", "u-3", "u-9")
    assert np.exp(recent.values) == pytest.approx([402.0, 403.0, 500.0])
    assert recent.stds == pytest.approx([0.01] * 3)
    assert _since_step(series, days, History((), 0, None)) is series


def test_one_robot_alone_is_as_unsure_as_what_its_recordings_share() -> None:
    """Ten days that agree to 0.1 %, each with a deviation of 5 % that is the same in all."""
    rows = [row("u", day, "left", "pitch", 400 * 1.001 ** (-1) ** day, std=20.0) for day in range(10)]
    (effect,) = summary_of(results(rows), failures(), FALSE_ALARMS).effects
    assert (effect.units, effect.recordings) == (1, 10)
    assert effect.low == pytest.approx(400 * np.exp(-1.96 * 0.05), rel=2e-3)
    assert effect.high == pytest.approx(400 * np.exp(1.96 * 0.05), rel=2e-3)


def test_failures_are_counted_by_what_they_say() -> None:
    alike = [
        (name, f"/{name}.csv", f"/{name}.csv: t = {time} s: bad") for name, time in (("a", 3.5), ("b", 9))
    ]
    found = reasons_of(failures(("c", "", "no memory"), *alike))
    assert [(one.reason, one.count) for one in found] == [("t = # s: bad", 2), ("no memory", 1)]
    assert found[0].example == "/a.csv: t = 3.5 s: bad"


def test_a_rate_that_cannot_be_is_refused() -> None:
    with pytest.raises(
        SettingsError,
        match=r"^value 0\.0: false alarms is not valid \(valid: 0\.001 to 100 a robot and year\)$",
    ):
        summary_of(results([]), failures(), 0.0)


def test_effects_are_told_in_percent() -> None:
    """Robots that differ by 3 %, days by 1 %, recordings by 0.5 %."""
    random = np.random.default_rng(4)
    rows = []
    for unit in range(20):
        own = 0.03 * random.normal()
        for day in range(10):
            mine = own + 0.01 * random.normal()
            for _ in range(3):
                value = 400 * np.exp(mine + 0.005 * random.normal())
                rows.append(row(f"u{unit}", day, "left", "pitch", value))
    (effect,) = summary_of(results(rows), failures(), false_alarms=FALSE_ALARMS).effects
    assert (effect.units, effect.recordings) == (20, 600)
    assert effect.recordings_percent == pytest.approx(0.5, rel=0.15)
    assert effect.days_percent == pytest.approx(1.0, rel=0.2)
    assert effect.units_percent == pytest.approx(3.0, rel=0.4)
    assert effect.low < 400 * 1.02
    assert effect.high > 400 * 0.98


def test_what_recordings_share_is_what_most_of_them_report() -> None:
    """One of five that is unsure of its number does not make the robot's unsure."""
    key = SeriesKey("left", "pitch", "stiffness", "N.m/rad")
    stds = np.array([0.01, 0.01, 0.01, 0.012, 0.9])
    series = Series("a", key, tuple("abcde"), np.arange(5.0), np.zeros(5), stds)
    mean = Mean(0.0, 0.0, np.inf, -0.03, 0.03, 5)
    assert _with_shared(mean, series) == pytest.approx(np.hypot(0.03, 1.96 * 0.01))


def test_the_latest_alarms_come_first_and_outliers_behind_them() -> None:
    def alarm(kind: str, day: int, text: str) -> Alarm:
        seen = date(2026, 1, day)
        return Alarm("a", "left", "pitch", "stiffness", kind, seen, seen, 1.0, None, None, ("g",), text)  # type: ignore[arg-type]

    told = [alarm("outlier", 9, "a"), alarm("step", 2, "c"), alarm("step", 5, "e"), alarm("step", 5, "d")]
    assert [one.text for one in _advised(told)] == ["d", "e", "c", "a"]
    assert all(one.advice for one in _advised(told))


def test_what_other_robots_do_is_no_cause() -> None:
    """A left foot of one robot and a right foot of another change on one day."""
    day = date(2026, 1, 5)
    told = [
        Alarm(unit, foot, "pitch", "stiffness", "step", day, day, 1.0, None, None, (), unit)
        for unit, foot in (("a", "left"), ("b", "right"), ("b", "left"))
    ]
    advice = {(one.unit, one.foot): one.advice for one in _advised(told)}
    assert advice["a", "left"].startswith("this axis alone changed")
    assert advice["b", "left"].startswith("both feet changed")
