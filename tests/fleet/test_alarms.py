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


def test_a_step_that_may_be_none_has_no_interval_in_words() -> None:
    found = alarm(Change("step", 4, 6, 0.05, -0.01, 0.11))
    assert (found.low, found.high) == pytest.approx((100 * np.expm1(-0.01), 100 * np.expm1(0.11)))
    assert found.text == ("left pitch stiffness of A-7 went up by 5.1 % on 2024-10-08, seen on 2024-10-10")


def test_an_outlier_names_its_recordings() -> None:
    found = alarm(Change("outlier", 3, 5, 0.2, 0.18, 0.22))
    assert found.groups == ("g3",)
    assert found.text == "left pitch stiffness of A-7 is 22.1 % above the other days on 2024-10-07"
    assert advice_for(found, []) == (
        "look at g3 with `plantar inspect`: another floor, load or temperature, or a fault of that day"
    )
    below = alarm(Change("outlier", 3, 3, -0.2, -0.22, -0.18))
    assert below.text == "left pitch stiffness of A-7 is 18.1 % below the other days on 2024-10-07"


def test_what_changes_together_has_one_cause() -> None:
    step = alarm(Change("step", 4, 6, 0.05, 0.04, 0.06))
    then = ". If nothing was serviced, inspect the foot; then export the new value"
    for others, cause in (
        ([], "this axis alone changed: a sole or a bush that was changed, or that broke on one side"),
        ([replace(step, axis="roll")],
         "all of this foot changed: a new sole or bush, or another gain of its force sensor"),
        ([replace(step, foot="right")],
         "both feet changed: look for what they share, such as temperature, the IMU or a new robot file"),
        ([replace(step, foot="right", kind="trend")],
         "this axis alone changed: a sole or a bush that was changed, or that broke on one side"),
    ):  # fmt: skip
        assert advice_for(step, others) == cause + then
    for days, cause in ((7, "both feet changed"), (8, "this axis alone changed")):
        for sign in (1, -1):
            other = replace(step, foot="right", seen=step.seen + sign * timedelta(days=days))
            assert cause in advice_for(step, [other])


def test_a_trend_says_when_to_export_again() -> None:
    found = alarm(Change("trend", 0, 9, np.log1p(0.01), 0.008, 0.012))
    assert found.text == (
        "left pitch stiffness of A-7 goes up by 1 % a month since about 2024-10-04, seen on 2024-10-13"
    )
    pace = "at this pace it is 5 % off within 5 months: export again by then"
    assert advice_for(found, []) == (
        f"the rubber ages, or the force sensor's gain drifts (does it still read the weight?); {pace}"
    )
    assert advice_for(found, [replace(found, foot="right")]) == (
        f"both feet go the same way: the rubber's age, or the season; {pace}"
    )
