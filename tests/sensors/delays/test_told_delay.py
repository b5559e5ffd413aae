"""What becomes of a delay that the logs show: drawn to what is usual, corrected or only allowed for, and told."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors.delays.clock_drift import ClockDrift
from plantar.sensors.delays.refined_delays import RefinedDelays
from plantar.sensors.delays.sensor_delay import _told

PRIOR = 0.0075  # s


@pytest.fixture
def usual(robot: RobotModel) -> RobotModel:
    return replace(robot, uncertainty=Uncertainty(wrench_delay=PRIOR))


def shown(value: float, std: float, slowest: float = 0.005) -> RefinedDelays:
    return RefinedDelays(np.array([value, value, 0.0]), std, 20.0, False, False, np.array([True]), slowest)


@pytest.mark.parametrize(
    ("value", "std", "delay", "wide", "code"),
    [
        # Two normal distributions multiplied: means by their precision, precisions add; and 0.3 ms of no model.
        (0.004, 0.0004, 0.0040 / (1 + (4 / 75) ** 2), np.hypot(0.0004 / np.hypot(1, 4 / 75), 0.0003), "delay"),
        (0.020, 0.0050, 0.0200 / (1 + 4 / 9), np.hypot(0.0050 / np.hypot(1, 2 / 3), 0.0003), "delay_poorly_known"),
        (0.050, 0.0020, 0.0500, np.hypot(0.0020, 0.0003), "delay_poorly_known"),  # unusual: drawn to nothing
    ],
)  # fmt: skip
def test_a_delay_is_drawn_to_what_is_usual_and_corrected(
    usual: RobotModel, value: float, std: float, delay: float, wide: float, code: str
) -> None:
    found = _told(usual, shown(value, std))
    assert (found.delay, found.std) == pytest.approx((delay, wide), rel=1e-6)
    assert (found.measured, found.freedom, found.note.code) == (True, 20.0, code)
    assert f"{1e3 * delay:+.1f} ± {1e3 * 1.96 * wide:.1f} ms late (95 %)" in found.note.text


def test_one_that_may_be_none_is_only_allowed_for(usual: RobotModel) -> None:
    """What is left uncorrected is an error of its own."""
    corrected = 0.002 / (1 + (4 / 7.5) ** 2)
    unsure = np.hypot(0.004 / np.hypot(1, 4 / 7.5), 0.0003)
    found = _told(usual, shown(0.002, 0.004))
    assert found.delay == 0.0
    assert found.std == pytest.approx(np.hypot(corrected, unsure))
    assert "not corrected" in found.note.text


def test_nobody_knows_when_within_a_slow_period_a_sample_was_taken(usual: RobotModel) -> None:
    assert _told(usual, shown(0.004, 1e-6, slowest=0.02)).std == pytest.approx(0.06 * 0.02, rel=1e-3)


def test_sensors_that_differ_have_delays_of_their_own(usual: RobotModel) -> None:
    apart = replace(shown(0.0, 0.001), values=np.array([0.003, 0.005, 0.002]))
    feet = _told(usual, replace(apart, feet_differ=True, encoders_differ=True))
    assert (feet.feet, feet.encoders) == ({"left": 0.003, "right": 0.005}, 0.002)
    assert (feet.delay, feet.std) == pytest.approx((0.004, 0.001))
    assert (feet.measured, feet.freedom, feet.doubtful) == (True, 20.0, False)
    assert "wrenches left +3.0, right +5.0 ms, encoders +2.0 ms (± 2.0 ms, 95 %)" in feet.note.text
    alike = replace(apart, values=np.array([0.004, 0.004, 0.002]), encoders_unsure=0.0004)
    encoders = _told(usual, replace(alike, encoders_differ=True))
    assert (encoders.feet, encoders.encoders_std) == ({}, 0.0004)
    assert "wrenches +4.0 ms, encoders +2.0 ms" in encoders.note.text


def test_small_differences_are_corrected_without_a_warning(usual: RobotModel) -> None:
    few = replace(shown(0.004, 1e-6), values=np.array([0.0042, 0.0038, 0.0005]))
    found = _told(usual, replace(few, feet_unsure=0.0004, encoders_unsure=0.0003))
    assert found.feet == pytest.approx({"left": 0.0042, "right": 0.0038})
    assert (found.encoders, found.encoders_std) == (0.0005, 0.0003)
    assert found.std == pytest.approx(0.0005, rel=1e-4), "0.3 ms of no model and 0.4 ms"
    assert found.note.severity == "info"
    unsure = _told(usual, replace(few, std=0.01, encoders_unsure=0.0003))
    assert (unsure.delay, unsure.feet, unsure.encoders) == (0.0, {}, 0.0)
    assert unsure.encoders_std == pytest.approx(np.hypot(0.0005, 0.0003)), "what is left uncorrected"


def test_clocks_that_run_apart_widen_by_what_they_do(usual: RobotModel) -> None:
    drift = ClockDrift(1e-4, 60.0)
    found = _told(usual, replace(shown(0.004, 0.001), unsteady=drift))
    assert (found.delay, found.std) == pytest.approx((0.004, np.hypot(0.001, 0.006 / np.sqrt(12))))
    assert found.doubtful
    assert found.note == drift.note


@pytest.mark.parametrize(
    ("accelerated", "more"), [((), 0.0), ((True,), 0.0), ((False, True), 0.0), ((False, False), 0.0005)]
)
def test_what_soles_alone_tell_is_half_a_millisecond_less_sure(
    usual: RobotModel, accelerated: tuple[bool, ...], more: float
) -> None:
    told: Any = tuple(SimpleNamespace(accelerated=each) for each in accelerated)
    found = _told(usual, replace(shown(0.02, 0.0004), residuals=told))
    same = _told(usual, shown(0.02, float(np.hypot(0.0004, more))))
    assert (found.delay, found.std) == pytest.approx((same.delay, same.std))
    assert found.residuals == told
