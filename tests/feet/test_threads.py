"""Logs are worked on one after another unless one of them is long."""

from __future__ import annotations

from dataclasses import replace
from threading import Barrier, current_thread, main_thread

import numpy as np
import pytest

from biped import record, sway
from plantar.errors import DataError
from plantar.feet import prepare, prepare_log
from plantar.feet.first_look import over_logs
from plantar.feet.prepare import prepare_all
from plantar.feet.prepare_log import checked
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.twin.robots import hrp2
from twin_samples import walked

LONG = 50000


@pytest.mark.parametrize(("samples", "here"), [(LONG, True), (LONG + 1, False)])
def test_threads_are_for_long_logs(samples: int, here: bool) -> None:
    logs = [MotionLog("log", np.arange(float(count)), {}) for count in (2, samples)]
    with over_logs(logs) as each:
        places = list(each(lambda _: current_thread() is main_thread(), logs))
    assert places == [here, here]


def meeting(monkeypatch: pytest.MonkeyPatch, module: object, *names: str) -> None:
    """Functions of a module that wait for each other: they come to an end where they are called at one time."""
    both = Barrier(len(names), timeout=30)

    def wait_for_the_other(function: object) -> object:
        def called(*given: object, **named: object) -> object:
            both.wait()
            return function(*given, **named)  # type: ignore[operator]

        return called

    for name in names:
        monkeypatch.setattr(module, name, wait_for_the_other(getattr(module, name)))


def test_a_long_log_is_put_right_while_it_is_checked(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = record(sway(duration=10.0))
    expected = checked(robot, log)
    monkeypatch.setattr(prepare_log, "LONG", 500)
    meeting(monkeypatch, prepare_log, "check_log", "without_dropouts")
    found = checked(robot, log)
    assert found.notes == expected.notes
    for name, values in expected.columns.items():
        np.testing.assert_array_equal(found.columns[name], values)


def test_no_long_log_is_put_on_a_grid_before_its_time_is_checked(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rows that come in bursts would make a grid of any size."""
    log, row = record(sway(duration=10.0)), np.arange(1001)
    bursts = replace(log, time=0.05 * (row // 5) + 1e-4 * (row % 5))
    monkeypatch.setattr(prepare_log, "LONG", 500)
    monkeypatch.setattr(prepare_log, "evenly_sampled", lambda _: pytest.fail("a grid was made"))
    with pytest.raises(
        DataError,
        match=r"^sway: column 'time': rows come in bursts, usually 0\.1 ms apart, 9\.99 ms on average "
        r"\(valid: the moment at which each row was measured; these look like moments of "
        r"arrival\)$",
    ):
        checked(robot, bursts)


def test_the_moments_of_a_long_log_are_told_beside_its_slides(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("plantar.feet.first_look.LONG", 500)
    meeting(monkeypatch, prepare, "moment_errors", "without_slip")
    ready = prepare_all(hrp2.robot(), [walked()], (), FeetSettings(), lambda _: None)
    assert len(ready.fitted) == 1
