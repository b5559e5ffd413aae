"""Feet whose pitch or roll differ may differ in z, where the heights show the sum of both compliances alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import record, sway
from biped_robot import FEET
from feet_trials import LINEAR, noisy
from plantar.conventions import Axis
from plantar.feet.fit.compliances import Compliances, share_apart
from plantar.feet.fit.vertical_stiffness import VerticalStiffness, _of_both
from plantar.feet.identify import identify_feet
from plantar.results.feet import Parameter
from plantar.robot.model import RobotModel

SUM_ALONE = Compliances(8e-6, 0.0, np.diag([(1e-7) ** 2, 1.0]), 1e9, np.array([1e-9, 1e-9]))


def stiffness(foot: str, axis: Axis, interval: tuple[float, float] | None) -> Parameter:
    value = None if interval is None else sum(interval) / 2
    return Parameter(foot, axis, "stiffness", "N.m/rad", value, 1.0, interval, 1.0, "usable", "", None)


@pytest.mark.parametrize(("left", "right", "share"), [
    ((95.0, 105.0), (300.0, 320.0), 195 / 405), ((300.0, 320.0), (95.0, 105.0), 195 / 405),
    ((90.0, 210.0), (200.0, 320.0), 0.0), ((-20.0, -5.0), (200.0, 320.0), 0.0), (None, (200.0, 320.0), 0.0),
])  # fmt: skip
def test_feet_differ_by_what_their_intervals_leave(
    left: tuple[float, float] | None, right: tuple[float, float], share: float
) -> None:
    pitch = [stiffness("left", "pitch", left), stiffness("right", "pitch", right)]
    roll = [stiffness("left", "roll", (100.0, 120.0)), stiffness("right", "roll", (100.0, 120.0))]
    assert share_apart([*pitch, *roll]) == pytest.approx(share)
    assert share_apart([*roll, *pitch]) == pytest.approx(share)


@pytest.mark.parametrize(("share", "unsure", "verdict"), [(0.0, 0.15, "weak"), (0.5, 0.5, "unidentifiable")])
def test_the_sum_is_told_and_each_foot_is_as_unsure_as_feet_differ(
    share: float, unsure: float, verdict: str
) -> None:
    found = _of_both(SUM_ALONE, dict.fromkeys(FEET, 0.0)).of_feet_that_differ(share)
    for foot, row in zip(FEET, found.parameters, strict=True):
        assert found.compliance[foot] == 4e-6
        assert found.compliance_std[foot] == pytest.approx(0.5 * np.hypot(1e-7, unsure * 8e-6), rel=1e-3)
        assert row.verdict == verdict
        assert ("pitch or roll of the feet differ" in row.reason) == (share > 0)


def test_feet_that_were_told_apart_stay_as_they_were() -> None:
    told = replace(SUM_ALONE, difference=2e-6, covariance=np.diag([(1e-7) ** 2, (1e-7) ** 2]))
    found = _of_both(told, dict.fromkeys(FEET, 0.0))
    for foot, row in zip(FEET, found.of_feet_that_differ(0.5).parameters, strict=True):
        assert row.value == pytest.approx(found.parameters[FEET.index(foot)].value, rel=0.01)
        assert row.verdict == "usable"
    assert VerticalStiffness((), (), {}, {}, np.inf).of_feet_that_differ(0.5).parameters == ()


def test_a_foot_that_is_three_times_stiffer_makes_z_unsure(robot: RobotModel) -> None:
    """Its torques read three times as much: z, of which the sum alone shows, may differ as well."""
    log = noisy(record(sway(seed=1, duration=40.0)), 1)
    moved = {name: 3.0 * log.column(name) for name in log.columns if name.startswith("wrench.left.torque")}
    alike, unlike = (identify_feet(robot, [one], settings=LINEAR) for one in (log, log.with_columns(moved)))
    for foot in FEET:
        one, other = (found.parameter(foot, "z", "stiffness") for found in (alike, unlike))
        assert one.verdict == "weak"
        assert (other.value, other.verdict) == (None, "unidentifiable")
        assert other.reason == "only the sum of both compliances shows, and pitch or roll of the feet differ"
