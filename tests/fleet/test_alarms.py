"""Alarms in words: what a change is called, and what it may come from."""

from __future__ import annotations

from dataclasses import replace
from datetime import date, timedelta

import numpy as np
import pytest

from plantar.fleet.alarms import Alarm, advice_for, alarm_of, percent_of
from plantar.fleet.series import Series, SeriesKey, by_day
from plantar.fleet.statistics.changes import Change

KEY = SeriesKey("left", "pitch", "stiffness", "N.m/rad")
TIMES = np.arange(20000.0, 20010.0)
SERIES = Series("A-7", KEY, tuple(f"g{k}" for k in range(10)), TIMES, np.full(10, 6.0), np.full(10, 0.01))


def alarm(change: Change) -> Alarm:
    return alarm_of(SERIES, by_day(SERIES), change)


def test_a_step_down_says_by_how_much_and_when() -> None:
    found = alarm(Change("step", 4, 6, -0.05, -0.06, -0.04))
    assert found.since == date(1970, 1, 1) + timedelta(days=20004)
    assert found.percent == pytest.approx(100 * np.expm1(-0.05))
    assert "left pitch stiffness of A-7 went down by 4.9 % (3.9 to 5.8 %)" in found.text
    assert found.text.endswith(f"seen on {found.seen}")


def test_a_step_of_unknown_size_has_no_interval() -> None:
    found = alarm(Change("step", 4, 4, 0.1, -np.inf, np.inf))
    assert (found.low, found.high) == (None, None)
    assert "(" not in found.text
    assert percent_of(np.inf) == np.inf


def test_an_outlier_names_its_recordings() -> None:
    found = alarm(Change("outlier", 3, 3, 0.2, 0.18, 0.22))
    assert found.groups == ("g3",)
    assert "look at g3 with `plantar inspect`" in advice_for(found, [])


def test_what_changes_together_has_one_cause() -> None:
    step = alarm(Change("step", 4, 6, 0.05, 0.04, 0.06))
    assert "this axis alone changed" in advice_for(step, [])
    assert "all of this foot changed" in advice_for(step, [replace(step, axis="roll")])
    assert "both feet changed" in advice_for(step, [replace(step, foot="right")])
    for days, cause in ((7, "both feet changed"), (8, "this axis alone changed")):
        for sign in (1, -1):
            other = replace(step, foot="right", seen=step.seen + sign * timedelta(days=days))
            assert cause in advice_for(step, [other])


def test_a_trend_says_when_to_export_again() -> None:
    found = alarm(Change("trend", 0, 9, np.log1p(0.01), 0.008, 0.012))
    assert "goes up by 1 % a month" in found.text
    assert "5 % off within 5 months" in advice_for(found, [])
