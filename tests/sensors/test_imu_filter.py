"""A gyroscope that its own filter delays is told from the orientation beside it, and read on time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.sensors.imu_filter import ImuFilter, imu_filter, with_gyroscopes_on_time
from plantar.signals.gyroscope_delay import log_gyroscope_delay
from plantar.signals.orientation import rates_from

PERIOD = 0.005
TIME = PERIOD * np.arange(6000)
RATES = imu_columns("chest", "angular_velocity")


def log_with(late: float, noise: float = 1e-4) -> MotionLog:
    """A body that rolls and pitches, 0.3 to 1.5 Hz, its gyroscope late by `late` [s]; an angle's `noise` [rad]."""

    def angles(time: Array) -> Array:
        roll = 0.05 * np.sin(2 * np.pi * 0.5 * time) + 0.02 * np.sin(2 * np.pi * 1.5 * time)
        return np.column_stack([roll, 0.06 * np.sin(2 * np.pi * 0.3 * time + 1), 0.3 + 0 * time])

    random = np.random.default_rng(5)
    read = angles(TIME) + noise * random.standard_normal((len(TIME), 3))
    x, y, z, w = Rotation.from_euler("xyz", read).as_quat().T
    exact = Rotation.from_euler("xyz", angles(TIME)).as_quat()[:, [3, 0, 1, 2]]
    rates = rates_from(exact, PERIOD)
    delayed = np.column_stack([np.interp(TIME - late, TIME, column) for column in rates.T])
    delayed += 0.001 * random.standard_normal(delayed.shape) + 0.01
    columns = dict(zip(imu_columns("chest", "orientation"), (w, x, y, z), strict=True))
    return MotionLog("sway", TIME, columns | dict(zip(RATES, delayed.T, strict=True)))


def filter_of(logs: list[MotionLog]) -> ImuFilter | None:
    return imu_filter(log_gyroscope_delay(log, "chest") for log in logs)


def on_time(log: MotionLog) -> MotionLog:
    """The log alone, its gyroscope read when it should be."""
    return with_gyroscopes_on_time([log], "chest", filter_of([log]))[0]


@pytest.mark.parametrize("late", [0.003, -0.002, 0.009, 0.04])
def test_rates_come_at_the_moments_of_the_orientation(late: float) -> None:
    log = log_with(late)
    found = on_time(log)
    exact, inner = log_with(0.0), slice(200, -200)
    before, after = (
        np.abs(one.angular_velocity("chest") - exact.angular_velocity("chest"))[inner].mean()
        for one in (log, found)
    )
    assert after < 0.6 * before
    assert [note.code for note in found.notes] == ["gyroscope_delay"]
    shown = float(found.notes[0].text.split("gyroscope ")[1].split(" ms")[0])
    assert shown == pytest.approx(1e3 * abs(late), abs=0.3)
    assert ("ahead of" if late < 0 else "behind") in found.notes[0].text


@pytest.mark.parametrize("late", [0.0, -0.0055])
def test_none_and_one_that_is_early_are_left_as_they_are(late: float) -> None:
    log = log_with(late)
    assert on_time(log) is log


def test_noise_that_hides_a_delay_shifts_nothing() -> None:
    log = log_with(0.0005, noise=0.02)
    assert on_time(log) is log


def test_a_log_without_orientation_or_with_gaps() -> None:
    log = log_with(0.003)
    alone = MotionLog("sway", TIME, {name: log.column(name) for name in RATES})
    assert on_time(alone) is alone
    holes = log.angular_velocity("chest").copy()
    holes[3000:3010] = np.nan
    found = on_time(log.with_columns(dict(zip(RATES, holes.T, strict=True))))
    assert found.notes
    assert np.isnan(found.angular_velocity("chest")).sum() < 45


def test_a_gyroscope_that_an_accelerometer_may_explain_is_not_made_late() -> None:
    """Ahead of an orientation that follows the accelerometer it is right; behind one, its own filter delays it."""
    for late, left in ((-0.003, True), (0.003, False)):
        log = log_with(late)
        still = np.tile([0.0, 0.0, 9.81], (len(TIME), 1))
        columns = dict(zip(imu_columns("chest", "linear_acceleration"), still.T, strict=True))
        log = log.with_columns(columns)
        assert (on_time(log) is log) is left


def test_a_filter_is_the_device_s_so_logs_that_hardly_turn_are_read_as_the_others() -> None:
    quiet = log_with(0.003, noise=0.02)
    assert on_time(quiet) is quiet
    logs = [log_with(0.003), quiet, log_with(0.003)]
    found = filter_of(logs)
    assert found is not None
    assert found.shown
    alone = filter_of(logs[:1])
    assert alone is not None
    assert found.std == pytest.approx(alone.std / np.sqrt(2), rel=0.1)
    read = with_gyroscopes_on_time(logs, "chest", found)
    moved = [
        float(np.nanmax(np.abs(one.angular_velocity("chest") - log.angular_velocity("chest"))))
        for one, log in zip(read, logs, strict=True)
    ]
    assert min(moved) > 0.5 * max(moved) > 0
    assert all(len(one.notes) == 1 for one in read)


def test_logs_that_disagree_show_no_filter() -> None:
    """Ahead in one log and behind in another: the orientation follows something else, and nothing is moved."""
    logs = [log_with(0.003), log_with(0.001)]
    found = filter_of(logs)
    assert found is not None
    assert not found.steady
    assert all(
        one is log for one, log in zip(with_gyroscopes_on_time(logs, "chest", found), logs, strict=True)
    )
    assert filter_of([MotionLog("empty", TIME, {})]) is None


@pytest.mark.parametrize(("late", "std", "steady", "shown"), [
    (0.004, 0.0013, True, True), (0.004, 0.0014, True, False), (0.004, 0.0001, False, False),
    (0.00049, 0.0001, True, False), (0.00051, 0.0001, True, True),
    (0.1, 0.0001, True, True),
    (-0.0049, 0.0001, True, True), (-0.0051, 0.0001, True, False),
])  # fmt: skip
def test_a_filter_is_shown_where_it_is_sure_and_a_filter_s(
    late: float, std: float, steady: bool, shown: bool
) -> None:
    assert ImuFilter(late, std, steady).shown is shown
