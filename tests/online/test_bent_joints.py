"""Joints that bend beyond their encoders, in the control loop: a walk of the twin, read before gears."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from before_gears import before_gears
from plantar.feet.interval_width.joint_compliance import NAME
from plantar.logs.motion_log import MotionLog
from plantar.online.estimator import FootEstimator
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import AxisModel, DelayEstimate, Diagnosis, LinearEquivalent, Parameter
from plantar.robot.model import RobotModel
from plantar.sensors.delays.refined_delays import read_in_time
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2

COMPLIANCE = 2e-4  # rad/(N.m)
LEGS = [f"{side}LEG_JOINT{place}" for side in "LR" for place in range(6)]
LATE = 0.02  # s


@pytest.fixture(scope="module")
def twin() -> RobotModel:
    return hrp2.robot()


@pytest.fixture(scope="module")
def sweep(twin: RobotModel) -> MotionLog:
    return play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log


def result(bends: float, delay: float = 0.0, **more: object) -> FeetResult:
    told = DelayEstimate(delay, 0.0, True)
    compliances = dict.fromkeys(LEGS, bends) if bends else {}
    plain = FeetResult("hrp2_like", (), {}, "kelvin_voigt", (), (), (), (), (), sensor_delay=told)
    return replace(plain, joint_compliance=compliances, **more)


@pytest.mark.parametrize(("compliance", "left"), [(COMPLIANCE, 0.03), (1e-8, 1e-5)])
def test_angles_are_those_of_encoders_behind_the_gears(
    twin: RobotModel, sweep: MotionLog, compliance: float, left: float
) -> None:
    """Against the same log before its joints bent, by Pinocchio; by the feet alone; what is left is of second order."""
    bent = before_gears(twin, sweep, compliance, LEGS, links=False)
    straight, read, told = (
        FootEstimator(twin, result(bends)).replay(log)
        for log, bends in ((sweep, 0.0), (bent, 0.0), (bent, compliance))
    )
    for foot in twin.feet:
        for axis in ("pitch", "roll"):
            right, wrong, now = (one.column(foot, f"{axis}.deflection") for one in (straight, read, told))
            assert np.abs(now - right).max() < left * np.abs(wrong - right).max()


@pytest.mark.parametrize("late", [0.0, LATE])
def test_stiffness_and_damping_are_those_of_the_rubber(
    twin: RobotModel, sweep: MotionLog, late: float
) -> None:
    """Of forces that are late, the torques of the same moment bend the joints."""
    bent = before_gears(twin, sweep, COMPLIANCE, LEGS)
    log = read_in_time(twin, bent, np.array([-late, -late, 0.0]))
    straight = FootEstimator(twin, result(0.0)).replay(sweep)
    told = FootEstimator(twin, result(COMPLIANCE, late)).replay(log)
    for foot in twin.feet:
        for name, within in (("pitch.stiffness", 0.01), ("pitch.damping", 0.02)):
            right, now = (one.column(foot, name)[-1] for one in (straight, told))
            assert now == pytest.approx(right, rel=within)


def test_what_a_batch_fit_leaves_open_widens_intervals(twin: RobotModel, sweep: MotionLog) -> None:
    values = (("stiffness", 0.25, 0.05), ("damping", 0.64, 0.08))
    rows = [
        Parameter("left", "pitch", name, "", 100.0, 10.0, None, None, "usable", "") for name, *_ in values
    ]
    limits = [Diagnosis("left", "pitch", name, "", {NAME: part}, 1.0, "") for name, part, _ in values]
    models = (AxisModel("left", "pitch", "kelvin_voigt", "", LinearEquivalent(100.0, 10.0)),)
    wide = result(1e-9, parameters=tuple(rows), diagnosis=tuple(limits), models=models)
    known, unsure = (FootEstimator(twin, each).replay(sweep) for each in (result(1e-9), wide))
    for name, _, share in values:
        value = known.column("left", f"pitch.{name}")[-1]
        less, more = (each.column("left", f"pitch.{name}.std")[-1] for each in (known, unsure))
        assert np.sqrt(more**2 - less**2) == pytest.approx(share * value, rel=1e-6)
        assert (
            unsure.column("right", f"pitch.{name}.std")[-1] == known.column("right", f"pitch.{name}.std")[-1]
        )
