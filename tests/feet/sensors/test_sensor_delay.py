"""Newton's law along an arm sweep of the twin: delays found end to end, impacts passed by."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.feet.prepare_log import checked
from plantar.feet.sensors.sensor_delay import estimate_wrench_delay
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.signals.resampling import shifted
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2


@pytest.fixture(scope="module")
def twin() -> RobotModel:
    return hrp2.robot()


@pytest.fixture(scope="module")
def sweep(twin: RobotModel, tmp_path_factory: pytest.TempPathFactory) -> MotionLog:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PLANTAR_CACHE", str(tmp_path_factory.getbasetemp() / "simulate-cache"))
        return checked(twin, play_all(["Myrand5"], twin, PAPER, "sensors", [0])[0][0].log)


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
    """A sole slaps the floor three times in ten seconds, and the force there is late for another reason."""
    random = np.random.default_rng(0)
    spoiled = late(sweep, "wrench.", 0.012)
    behind = sweep.time > 30.0
    struck = np.zeros(len(sweep), dtype=bool)
    for moment in (30.0, 33.0, 36.0):
        struck |= (sweep.time > moment) & (sweep.time < moment + 0.3)
    columns = {}
    for name in (name for name in sweep.columns if name.startswith("wrench.")):
        columns[name] = np.where(behind, spoiled.column(name), sweep.column(name))
        columns[name] += np.where(struck, 20 * random.standard_normal(len(sweep)), 0.0)
    found = estimate_wrench_delay(twin, [sweep.with_columns(columns)])
    assert found.measured
    assert found.delay == pytest.approx(0.0, abs=1e-3)
