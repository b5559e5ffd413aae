"""What Newton's law tells of sensors that read otherwise, as it is kept: every number of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import small_biped
from before_gears import before_gears
from kept_texts import assert_as_kept, described
from moments import fit_moments
from plantar.conventions import Array
from plantar.feet.prepare_log import checked
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors.bandwidth import fading, fading_notes
from plantar.sensors.delays.clock_drift import clock_drift
from plantar.sensors.delays.delays_by_log import delays_by_log
from plantar.sensors.delays.sensor_delay import estimate_wrench_delay, in_time
from plantar.sensors.moments.bent_joints import joint_bending, joint_bending_notes
from plantar.sensors.moments.moment_fit import MomentFit
from plantar.sensors.moments.sensor_errors import BENDING
from plantar.sensors.moments.sensor_turns import sensor_turn_notes
from plantar.sensors.moments.torque_delay import torque_delay_notes
from plantar.sensors.moments.torque_gains import torque_gain_notes, torque_gains
from plantar.sensors.newton_euler import NewtonEulerResidual, newton_euler_residuals
from plantar.signals.filters import low_pass

KEPT = Path(__file__).parent / "kept"
Change = Callable[[MotionLog], MotionLog]


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return replace(small_biped.robot(tmp_path_factory.mktemp("biped")), uncertainty=Uncertainty())


@pytest.fixture(scope="module")
def logs(robot: RobotModel) -> list[MotionLog]:
    """Of a robot whose links are a little lighter and heavier than the URDF says."""
    real = small_biped.truth(robot.floating_model, 1)
    for mine, told in zip(real.inertias, robot.floating_model.inertias, strict=True):
        mine.mass, mine.lever = (
            told.mass + 0.1 * (mine.mass - told.mass),
            told.lever + 0.1 * (mine.lever - told.lever),
        )
    return [small_biped.record(robot, real, name, seed, 16.0, 0.2) for name, seed in (("one", 1), ("two", 2))]


def of(part: str, change: Callable[[Array, Array], Array]) -> Change:
    """A change of columns (N,) whose names hold `part`, from their times and values."""
    return lambda log: log.with_columns(
        {name: change(log.time, values) for name, values in log.columns.items() if part in name}
    )


def late(part: str, seconds: float) -> Change:
    return of(part, lambda time, values: np.interp(time - seconds, time, values))


def turned(log: MotionLog) -> MotionLog:
    """The left force sensor by three degrees about its z."""
    read, turn = {}, Rotation.from_rotvec([0.0, 0.0, 0.05])
    for kind in ("force", "torque"):
        names = [f"wrench.left.{kind}.{axis}" for axis in "xyz"]
        read |= dict(zip(names, turn.apply(log.stack(names)).T, strict=True))
    return log.with_columns(read)


def second_alone(change: Change) -> Change:
    return lambda log: change(log) if log.name == "two" else log


CHANGES: dict[str, Change] = {
    "as they are": lambda log: log,
    "joints bend": lambda log: log,
    "wrenches late": late("wrench", 0.012),
    "one foot late": late("wrench.left", 0.02),
    "encoders late": late("joint", 0.015),
    "torques late": late(".torque", 0.02),
    "torques too large": of("wrench.right.torque.y", lambda _, values: 1.08 * values),
    "loads too large": of("wrench.left.force.z", lambda _, values: 1.05 * values),
    "turned": turned,
    "filtered": of("wrench", lambda time, values: low_pass(values, time[1], 2.5)),
    "clock": of("wrench", lambda time, values: np.interp(time * 1.002 - 0.01, time, values)),
    "one log late": second_alone(late("wrench", 0.03)),
    "accelerometer late": late("linear_acceleration", 0.02),
    "without accelerometer": lambda log: MotionLog(
        log.name, log.time, {name: v for name, v in log.columns.items() if "acceleration" not in name}
    ),
}  # fmt: skip


def of_moments(robot: RobotModel, fit: MomentFit | None) -> dict[str, object]:
    gains = torque_gains(robot, fit)
    return {
        "fit": fit, "gains": gains, "gain notes": torque_gain_notes(gains), "turns": sensor_turn_notes(robot, fit),
        "delays": torque_delay_notes(fit), "bending": (bending := joint_bending(robot, fit)),
        "bending notes": joint_bending_notes(robot, bending),
    }  # fmt: skip


@pytest.mark.parametrize("name", CHANGES)
def test_what_the_law_tells_is_as_it_is_kept(name: str, robot: RobotModel, logs: list[MotionLog]) -> None:
    legs = [f"{side}_{joint}" for side in robot.feet for joint in ("roll", "pitch", "ankle")]
    bend = [before_gears(robot, log, 2e-4, legs) for log in logs] if name == "joints bend" else logs
    changed = [checked(robot, CHANGES[name](log)) for log in bend]
    delay = estimate_wrench_delay(robot, changed)
    residuals: list[NewtonEulerResidual] = []
    for log in changed:
        residuals += newton_euler_residuals(robot, in_time(robot, log, delay))
    pairs = [one.pair for one in residuals]
    told = {
        "delay": delay, "residuals": residuals, "clock": clock_drift(pairs),
        "by log": delays_by_log(pairs, delay.delay), "fading": (filtered := fading(residuals)),
        "fading notes": fading_notes(filtered),
        "moments": of_moments(robot, fit_moments(robot, residuals, [])),
        "walking": of_moments(robot, fit_moments(robot, residuals, ["one"], BENDING)),
    }  # fmt: skip
    assert_as_kept(described(told), KEPT / f"{name.replace(' ', '_')}.txt", share=1e-4, least=1e-7)
