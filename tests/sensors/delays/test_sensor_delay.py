"""Newton's law along an arm sweep of the twin: delays found end to end, impacts passed by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from plantar.estimation.delays.lag_search import search_lags
from plantar.feet.prepare_log import checked
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors.delays import sensor_delay
from plantar.sensors.delays.lagged_log import lagged_log
from plantar.sensors.delays.refined_delays import APART, refined_delays
from plantar.sensors.delays.sensor_delay import estimate_wrench_delay
from plantar.signals.resampling import shifted
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2
from twin_samples import plan, short

STEP = 0.05


@pytest.fixture(scope="module")
def twin() -> RobotModel:
    return hrp2.robot()


@pytest.fixture(scope="module")
def sweep(twin: RobotModel) -> MotionLog:
    """The middle of the sweep, which other tests play, too."""
    log = play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log
    part = log.select((log.time >= 10.0) & (log.time < 32.0))
    return checked(twin, MotionLog(part.name, part.time - part.time[0], part.columns))


def late(log: MotionLog, columns: str, delay: float) -> MotionLog:
    names = [name for name in log.columns if name.startswith(columns)]
    moved = shifted(log.stack(names), log.period, -delay)
    return log.with_columns(dict(zip(names, moved.T, strict=True)))


def test_one_foot_and_the_encoders_may_lag(twin: RobotModel, sweep: MotionLog) -> None:
    assert estimate_wrench_delay(twin, [sweep]).delay == pytest.approx(0.0, abs=1e-3)
    lagging = estimate_wrench_delay(twin, [late(late(sweep, "wrench.left", 0.010), "joint.", 0.005)])
    assert lagging.feet == pytest.approx({"left": 0.010, "right": 0.0}, abs=1e-3)
    assert lagging.encoders == pytest.approx(0.005, abs=1e-3)


def test_without_a_gyroscope_the_orientation_tells(twin: RobotModel, sweep: MotionLog) -> None:
    blind = MotionLog(
        sweep.name, sweep.time, {k: v for k, v in sweep.columns.items() if "angular_velocity" not in k}
    )
    found = estimate_wrench_delay(twin, [late(blind, "wrench.", 0.006)])
    assert found.measured
    assert found.delay == pytest.approx(0.006, abs=2e-3)


def test_what_an_impact_leaves_behind_is_passed_by(twin: RobotModel, sweep: MotionLog) -> None:
    """A sole slaps the floor three times in seven seconds, and the force there is late for another reason."""
    random = np.random.default_rng(0)
    spoiled = late(sweep, "wrench.", 0.012)
    behind = sweep.time > 15.0
    struck = np.zeros(len(sweep), dtype=bool)
    for moment in (15.0, 17.0, 19.0):
        struck |= (sweep.time > moment) & (sweep.time < moment + 0.3)
    columns = {}
    for name in (name for name in sweep.columns if name.startswith("wrench.")):
        columns[name] = np.where(behind, spoiled.column(name), sweep.column(name))
        columns[name] += np.where(struck, 20 * random.standard_normal(len(sweep)), 0.0)
    found = estimate_wrench_delay(twin, [sweep.with_columns(columns)])
    assert found.measured
    assert found.delay == pytest.approx(0.0, abs=1e-3)


FAR = [
    ({"wrench.": 0.2}, (0.2, 0.2, 0.0)),
    ({"wrench.left": 0.2}, (0.2, 0.0, 0.0)),
    ({"imu.": 0.2}, (-0.2, -0.2, -0.2)),
    ({"joint.": 0.06}, (0.0, 0.0, 0.06)),
    ({"wrench.right": -0.1, "joint.": 0.15}, (0.0, -0.1, 0.15)),
]


@pytest.mark.parametrize(("put_in", "expected"), FAR)
def test_delays_up_to_a_fifth_of_a_second_are_found(
    twin: RobotModel, sweep: MotionLog, put_in: dict[str, float], expected: tuple[float, float, float]
) -> None:
    log = sweep
    for columns, delay in put_in.items():
        log = late(log, columns, delay)
    found = estimate_wrench_delay(twin, [log])
    assert found.measured
    assert not found.doubtful
    feet = [found.feet.get(name, found.delay) for name in ("left", "right")]
    np.testing.assert_allclose([*feet, found.encoders], expected, atol=1.2e-3)
    assert found.std < 1e-3


def test_the_grid_holds_the_lag_and_the_steps_from_it_settle(twin: RobotModel, sweep: MotionLog) -> None:
    log = late(sweep, "wrench.", 0.13)
    grid = lagged_log(twin, log)
    assert grid is not None
    lags = search_lags([grid])
    np.testing.assert_allclose(lags.values, [0.13, 0.13, 0.0], atol=0.6 * STEP)
    assert refined_delays(twin, [log], map, np.zeros(3)) is None, "too far for steps along the rates"
    found = refined_delays(twin, [log], map, lags.values)
    assert found is not None
    np.testing.assert_allclose(found.values, [0.13, 0.13, 0.0], atol=1e-3)


def test_encoders_that_seem_late_are_looked_for_on_the_grid(
    twin: RobotModel, sweep: MotionLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Gentle motions close well enough at no delay, from which steps settle nowhere; where they do, and leave much to
    suspect, the grid is asked as well."""
    gentle = checked(
        twin, play_all([short(plan("Myrand4"), 20.0, 40.0)], twin, PAPER, "sensors", [0])[0][0].log
    )
    still = np.zeros(3)
    seen, timely = (
        refined_delays(twin, [late(gentle, "joint.", delay)], map, still) for delay in (0.06, 0.0)
    )
    assert seen is None
    assert timely is not None
    assert not timely.suspect
    assert estimate_wrench_delay(twin, [late(gentle, "joint.", 0.06)]).encoders == pytest.approx(
        0.06, abs=2e-3
    )
    log = late(sweep, "joint.", 0.1)
    sure = replace(timely, values=still, std=3e-4)
    for suspect, encoders in ((True, 0.1), (False, 0.0)):
        first = replace(sure, suspect=suspect)
        monkeypatch.setattr(
            "plantar.sensors.delays.sensor_delay.refined_delays",
            lambda *given, first=first: refined_delays(*given) if np.any(given[-1]) else first,
        )
        assert estimate_wrench_delay(twin, [log]).encoders == pytest.approx(encoders, abs=1e-3)


def test_a_delay_of_another_length_in_each_log_leaves_damping_in_doubt(
    twin: RobotModel, sweep: MotionLog
) -> None:
    other = replace(late(sweep, "wrench.", 0.03), name="other")
    found = estimate_wrench_delay(twin, [sweep, other])
    assert found.note.code == "delays_by_log"
    assert found.doubtful
    assert found.std == pytest.approx(0.03 / np.sqrt(2), rel=0.1)


@pytest.mark.parametrize("delay", [0.4, 1.0])
def test_what_no_delay_closes_is_called_so(twin: RobotModel, sweep: MotionLog, delay: float) -> None:
    found = estimate_wrench_delay(twin, [late(sweep, "imu.", delay)])
    assert found.note.code == "delay_beyond_search"
    assert found.doubtful
    assert found.std > 0.1
    assert found.delay == 0.0


def test_a_hand_that_carries_the_robot_is_no_late_sensor(twin: RobotModel, sweep: MotionLog) -> None:
    """Torques about the root that the motion does not ask for: timing does not show, the robot file's word stands."""
    time = sweep.time[:, None]
    push = 25.0 * np.sin(2 * np.pi * np.array([0.31, 0.43]) * time)
    columns = {}
    for foot in ("left", "right"):
        for axis, own in zip("xy", push.T, strict=True):
            name = f"wrench.{foot}_foot.torque.{axis}"
            columns[name] = sweep.column(name) + own
            name = f"wrench.{foot}_foot.force.{axis}"
            columns[name] = sweep.column(name) + own
    found = estimate_wrench_delay(twin, [sweep.with_columns(columns)])
    assert found.note.code == "delay_unknown"
    assert not found.doubtful
    assert found.std == twin.uncertainty.wrench_delay


def test_a_log_that_a_hand_steadies_puts_no_delay_in_doubt_that_another_shows(
    twin: RobotModel, sweep: MotionLog
) -> None:
    """Half of what the sway asks for is taken by somebody: too little to be called a push, too much to close."""
    names = [name for name in sweep.columns if name.startswith("wrench.")]
    wrenches = sweep.stack(names)
    steadied = wrenches.mean(axis=0) + 0.6 * (wrenches - wrenches.mean(axis=0))
    held = replace(sweep.with_columns(dict(zip(names, steadied.T, strict=True))), name="held")
    alone, both = (estimate_wrench_delay(twin, logs) for logs in ([held], [sweep, held]))
    assert alone.doubtful
    assert not both.doubtful
    assert both.delay == pytest.approx(0.0, abs=1e-3)


def test_a_robot_that_stands_still_leaves_the_robot_files_word(twin: RobotModel, sweep: MotionLog) -> None:
    """Noise closes nothing, though its squares may be alike on both sides; that is no reason for doubt."""
    random = np.random.default_rng(3)
    quiet = {}
    for name, values in sweep.columns.items():
        noise = 0.1 if name.startswith("wrench.") else 2e-3 * ("acceleration" in name)
        quiet[name] = np.full(len(sweep), values[0]) + noise * random.standard_normal(len(sweep))
    told = replace(twin, uncertainty=Uncertainty(wrench_delay=0.004))
    still = sweep.with_columns(quiet)
    assert lagged_log(told, still) is None
    found = estimate_wrench_delay(told, [still])
    assert found.note.code == "delay_unknown"
    assert (found.delay, found.std, found.doubtful) == (0.0, 0.004, False)
    assert found.encoders_std == APART


def wrong_urdf(robot: RobotModel, seed: int) -> RobotModel:
    """The robot with masses 5 % and centres of mass 5 mm off in the model that predicts the wrench."""
    random, other = np.random.default_rng(1000 + seed), replace(robot)
    model = robot.floating_model.copy()
    for joint in range(1, model.njoints):
        own, share = model.inertias[joint], 1 + 0.05 * random.standard_normal()
        lever = own.lever + 0.005 * random.standard_normal(3)
        model.inertias[joint] = pin.Inertia(own.mass * share, lever, own.inertia * share)
    other.__dict__["floating_model"] = model
    return other


def test_intervals_of_the_delay_hold_for_wrong_urdfs(twin: RobotModel, sweep: MotionLog) -> None:
    exact = replace(twin, uncertainty=Uncertainty(link_mass=0.0, link_com=0.0))
    sure = estimate_wrench_delay(exact, [sweep])
    assert sure.std < 0.0005
    found = [estimate_wrench_delay(wrong_urdf(twin, seed), [sweep]) for seed in range(10)]
    far = np.array([one.delay / one.std for one in found])
    assert np.sum(np.abs(far) < 1.96) >= 9
    assert 0.4 < np.sqrt(np.mean(far**2)) < 1.5, "nor wider than they need to be"
    assert min(one.std for one in found) > 1.2 * sure.std


def test_cells_without_horizontal_force_show_no_delay_and_none_is_searched(
    twin: RobotModel, sweep: MotionLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On some motions a search would find that no delay closes Newton's law, and raise an alarm about clocks."""
    monkeypatch.setattr(sensor_delay, "refined_delays", lambda *_: pytest.fail("searched"))
    none = ("force.x", "force.y", "torque.z")
    gone = {name: 0 * values for name, values in sweep.columns.items() if name.endswith(none)}
    found = estimate_wrench_delay(twin, [sweep.with_columns(gone)])
    assert (found.measured, found.doubtful, found.delay) == (False, False, 0.0)
    assert "cells" in found.note.text
    assert "--wrench-delay" in found.note.text
