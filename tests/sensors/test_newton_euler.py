"""Delays from Newton-Euler residuals: the slowest clock bounds what is known, and every run of a log takes part."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import make_robot
from feet_trials import without
from plantar.dynamics.inertial_motion import InertialSignals
from plantar.estimation.delays.delay import Pair, estimate_delay
from plantar.feet.prepare_log import checked
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT
from plantar.sensors.delays.refined_delays import read_in_time
from plantar.sensors.delays.sensor_delay import estimate_wrench_delay
from plantar.sensors.newton_euler import NewtonEulerResidual, newton_euler_residuals, with_gyroscope
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import interpolate, shifted
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2
from twin_samples import planned_part

CLOCK = 0.06

PERIOD = 0.005

SAMPLES = 8000


def late_pair(delay: float, seed: int, push: float = 0.0) -> Pair:
    """A random wrench below 1.5 Hz, measured `delay` late, noise on both sides; `push`: an operator's share."""
    random = np.random.default_rng(seed)
    time = PERIOD * np.arange(SAMPLES)
    true = 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5)
    hand = push * 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5)
    late = np.nan_to_num(
        np.column_stack([interpolate(time - delay, time, column, 1.0) for column in (true + hand).T])
    )
    measured = low_pass(late + random.standard_normal(late.shape), PERIOD, 8.0)
    predicted = low_pass(true + random.standard_normal(true.shape), PERIOD, 8.0)
    rate = differentiate(measured, PERIOD)
    return Pair("sweep", measured[100:-100], rate[100:-100], predicted[100:-100], PERIOD)


def closed(pair: Pair, feet: int = 1) -> NewtonEulerResidual:
    """The pair as the closure of feet that carry the same, under still joints."""
    flat = 0 * pair.predicted
    still = InertialSignals(flat[:, :0], flat[:, :3], flat[:, :3], PERIOD)
    measured, rate = (np.repeat(own[None] / feet, feet, axis=0) for own in (pair.measured, pair.rate))
    rows, readings = slice(len(flat)), np.hstack(feet * [flat])
    return NewtonEulerResidual(pair, measured, rate, flat, readings, still, rows, np.zeros(0), readings, True)


@pytest.mark.parametrize("slow_first", [True, False])
def test_the_slowest_clock_bounds_what_is_known(slow_first: bool, tmp_path: Path) -> None:
    """Whichever log comes first; one that says nothing of the delay does not count."""
    periods = [0.02, PERIOD] if slow_first else [PERIOD, 0.02]
    logs = [MotionLog(str(period), period * np.arange(100), {}) for period in (*periods, 0.1)]
    residuals = [[closed(late_pair(0.0, seed), feet=2).with_bands()] for seed in (1, 2)] + [[]]
    found = estimate_wrench_delay(make_robot(tmp_path), logs, as_recorded=residuals)
    assert CLOCK * 0.02 <= found.std < CLOCK * 0.1


def test_a_rope_that_holds_the_robot_for_a_while_is_left_out() -> None:
    """A quarter of the weight, for ten seconds of 40: before and after, the ground's force is all that acts."""
    twin = hrp2.robot()
    sweep = checked(twin, play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log)
    rope = 1 - 0.25 * ((sweep.time > 12) & (sweep.time < 22))
    held = sweep.with_columns(
        {name: rope * sweep.column(name) for name in sweep.columns if "force.z" in name}
    )
    first, last = newton_euler_residuals(twin, held)
    assert 8 < len(first.signals.positions) * held.period < 12
    assert len(last.signals.positions) * held.period > 14
    found = estimate_wrench_delay(twin, [held])
    assert found.measured
    assert found.delay == pytest.approx(0.0, abs=0.002), "sensors of this preset are in time"


def test_a_rope_in_a_log_that_never_closes_says_nothing_of_moments() -> None:
    """Wrenches of another motion cannot follow: that is doubted, but where the robot was held for a while."""
    twin = hrp2.robot()
    sweep = checked(twin, play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log)
    names = [name for name in sweep.columns if name.startswith("wrench.")]
    other = sweep.with_columns({name: sweep.column(name)[::-1].copy() for name in names})
    rope = 1 - 0.25 * ((sweep.time > 12) & (sweep.time < 22))
    held = other.with_columns({name: rope * other.column(name) for name in names if "force.z" in name})
    free, found = (estimate_wrench_delay(twin, [log]) for log in (other, held))
    assert free.doubtful
    assert not found.doubtful
    assert not found.measured


def test_a_log_with_gaps_shows_its_delay_in_every_run() -> None:
    """One run of nine seconds alone, the first one of a motion that begins slowly, may be off by 10 ms."""
    twin = hrp2.robot()
    sweep = checked(twin, play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log)
    gone = sweep.time % 10 < 1
    names = [name for name in sweep.columns if name.startswith("wrench.")]
    late = shifted(sweep.stack(names), sweep.period, -0.006)
    late[gone] = np.nan
    residuals = newton_euler_residuals(twin, log := sweep.with_columns(dict(zip(names, late.T, strict=True))))
    assert [round(len(one.signals.positions) * log.period) for one in residuals] == [9, 9, 9, 9]
    apart = newton_euler_residuals(twin, replace(log, left_out=((9.0, 10.0),)))
    assert (
        len({one.pair.label for one in apart}) == 4
    )  # hours may be left out: each may have a delay of its own
    assert {one.pair.label for one in residuals} == {log.name}
    found = estimate_wrench_delay(twin, [log])
    assert abs(found.encoders) < 2 * found.encoders_std
    assert found.delay == pytest.approx(0.006, abs=0.001)
    assert found.std < 0.001


def test_encoders_that_are_read_late_move_what_the_feet_read_too() -> None:
    """Joints say where a foot pushes: where legs move, that is more than what their inertia makes of a delay."""
    twin, late = hrp2.robot(), 0.002
    squat = checked(twin, play_all([planned_part("Squat", twin)], twin, PAPER, "ideal", [0])[0][0].log)
    (before,) = newton_euler_residuals(twin, squat)
    assert before.pair.model_errors.shape == (48, *before.pair.predicted.shape), "every drawn URDF takes part"
    (after,) = newton_euler_residuals(twin, read_in_time(twin, squat, np.array([0.0, 0.0, late])))
    count = min(len(before.by_encoders), len(after.by_encoders))
    missing = [(one.pair.predicted - one.measured.sum(axis=0))[:count] for one in (before, after)]
    slopes, moved = before.by_encoders[:count], missing[1] - missing[0]
    for row in (0, 2, 4):  # of a squat: what moves in the sagittal plane
        assert slopes[:, row] @ moved[:, row] == pytest.approx(late * np.sum(slopes[:, row] ** 2), rel=0.05)


def test_newtons_law_takes_its_turns_from_the_orientation_where_there_is_no_gyroscope(
    robot: RobotModel,
) -> None:
    log = record(sway(duration=8.0))
    assert with_gyroscope(robot, log) is log
    found = with_gyroscope(robot, without(log, "angular_velocity"))
    assert found is not None
    inner = slice(10, -10)
    turned, true = (each.angular_velocity("chest")[inner] for each in (found, log))
    assert np.abs(turned - true).max() < 2e-3 * np.abs(true).max()
    still = without(log, "linear_acceleration")
    assert with_gyroscope(robot, still) is still, "soles that stand say how it accelerates"
    for missing in (("linear_acceleration", "orientation"), ("angular_velocity", "orientation")):
        assert with_gyroscope(robot, without(log, *missing)) is None
    left = replace(robot.feet["left"], contact="always")
    assert with_gyroscope(replace(robot, feet={**robot.feet, "left": left}), log) is None, "zeroed under load"


@pytest.mark.parametrize("late", [0.004, 0.12])
def test_standing_soles_tell_delays_where_no_accelerometer_is_recorded(late: float) -> None:
    """Also one that only a search over lags finds; encoders by themselves move the acceleration as well."""
    twin = hrp2.robot()
    sweep = checked(twin, play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log)
    blind = without(sweep, "linear_acceleration")
    found = estimate_wrench_delay(twin, [read_in_time(twin, blind, np.array([-late, -late, 0.0]))])
    assert found.delay == pytest.approx(late, abs=3 * found.std)
    assert 0.0005 < found.std < 0.001, "no floor is so hard"
    by_encoders = estimate_wrench_delay(twin, [read_in_time(twin, blind, np.array([0.0, 0.0, -late]))])
    assert by_encoders.encoders == pytest.approx(late, abs=0.001)
    assert by_encoders.delay == pytest.approx(0.0, abs=0.002)


def test_a_hand_that_pushes_is_seen_without_an_accelerometer() -> None:
    """Forces that sway by more than what the robot's motion needs: nothing is told of the sensors there."""
    twin = hrp2.robot()
    sweep = checked(twin, play_all(["Myrand5"], twin, PAPER, "ideal", [0])[0][0].log)
    blind = without(sweep, "linear_acceleration")
    assert newton_euler_residuals(twin, blind)
    push = 30 * np.sin(2 * np.pi * 0.4 * sweep.time)
    names = [f"wrench.{foot.wrench.name}.force.x" for foot in twin.feet.values()]
    assert not newton_euler_residuals(
        twin, blind.with_columns({name: blind.column(name) + push for name in names})
    )


@pytest.mark.parametrize("about", [0, 1])
def test_a_turned_mount_is_allowed_for_in_a_delay_that_soles_tell(about: int) -> None:
    """As the trunk turns, a chest IMU that leans in its mount moves otherwise than soles say: it passes for a delay."""
    twin = hrp2.robot()
    sweep = checked(twin, play_all(["Myrand5"], twin, PAPER, "ideal", [0])[0][0].log)
    placement = twin.required_imu.placement
    rpy = placement.rpy + 0.02 * np.eye(3)[about]
    told = replace(twin, imu=replace(twin.required_imu, placement=replace(placement, rpy=rpy)))
    stds = []
    for mount in (0.0, 0.02):
        unsure = replace(told, uncertainty=replace(EXACT, imu_mount=mount))
        [residual] = newton_euler_residuals(unsure, without(sweep, "linear_acceleration"))
        found = estimate_delay([residual.pair])
        assert found is not None
        stds.append(found.std)
    assert abs(found.value) < 2.5 * stds[1]
    assert stds[1] > 1.1 * stds[0]
