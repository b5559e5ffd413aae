"""Of a long recording the stretches that move: which, how much, and what stands between them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.errors import NoRoom
from plantar.faults.gaps import check_gaps
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.save import save_log
from plantar.logs.stretches import Stretches, most_moving
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.signals.resampling import evenly_sampled, sampling
from plantar.signals.thinning import thinned

LONGEST, STRETCH = 600.0, 60.0  # s
KNEE, TORQUE = "joint.knee.position", "wrench.left.torque.{}"


def moving(time: Array, spans: list[tuple[float, float]], frequency: float, size: float = 1.0) -> Array:
    """A tone within some spans of time, beside a little noise."""
    inside = np.any([(time >= start) & (time < end) for start, end in spans], axis=0)
    noise = np.random.default_rng(0).normal(0.0, 1e-3, len(time))
    return np.asarray(noise + size * inside * np.sin(2 * np.pi * frequency * time))


def long_log(seconds: float = 1800.0, rate: float = 20.0, **torques: Array) -> MotionLog:
    time = np.arange(0.0, seconds, 1 / rate) + 5.0
    columns = {TORQUE.format(axis): values for axis, values in torques.items()}
    return MotionLog("long", time, {KNEE: np.sin(time), **columns})


TIME = np.arange(0.0, 1800.0, 0.05)
GAP = Note("gap", "info", "0.2 s missing")


def starts_of(log: MotionLog) -> set[int]:
    """Numbers of the whole stretches that a log holds."""
    return {int((time - 5.0 + 1e-9) // STRETCH) for time in log.time}


def test_what_moves_is_taken_and_the_rest_told_of() -> None:
    log = long_log(x=moving(TIME, [(300.0, 420.0), (1500.0, 1560.0)], 0.5))
    found = most_moving(log)
    assert {5, 6, 25} <= starts_of(found)
    assert len(found) == LONGEST * 20
    (note,) = found.notes
    assert note.code == "long_recording"
    assert (
        "lasts 1800 s; the 600 s in which most moves are used, 33 % of it, in stretches of 60 s" in note.text
    )
    assert most_moving(found) is found


@pytest.mark.parametrize(("seconds", "whole"), [(600.0, True), (600.1, False)])
def test_ten_minutes_are_worked_on_as_they_are(seconds: float, whole: bool) -> None:
    log = long_log(seconds, x=np.zeros(round(20 * seconds)))
    assert (most_moving(log) is log) == whole


def test_where_the_last_row_is_lost_the_one_before_ends_its_stretch() -> None:
    """Two stretches of five rows, of which the last two are emptied: one loses both, one a row within."""
    blank = np.array([0, 0, 0, 1, 1, 0, 0, 0, 1, 1], bool)
    lost = np.array([0, 0, 0, 1, 1, 0, 1, 0, 0, 0], bool)
    found = Stretches(np.ones(10, bool), blank, 10.0).without(lost)
    assert found.blank.tolist() == [False, False, True, False, False, True, True]
    half = Stretches(np.ones(10, bool), blank, 10.0).without(np.arange(10) == 4)
    assert half.blank.tolist() == [False, False, False, True, False, False, False, True, True]


def test_each_torque_has_its_own_stretches_by_its_size_and_its_changes() -> None:
    swings = [(60.0 * k, 60.0 * (k + 1)) for k in range(12)]
    x = moving(TIME, swings, 0.1, 50.0) + moving(TIME, [(1200.0, 1260.0)], 2.0, 8.0)  # quick, and far smaller
    y = moving(TIME, [(1740.0, 1800.0)], 0.2, 0.1)  # a weak axis
    assert {20, 29} <= starts_of(most_moving(long_log(x=x, y=y)))


def test_nothing_is_known_at_the_end_of_a_stretch_and_the_grid_is_even_without_what_is_left_out() -> None:
    time = np.arange(0.0, 700.0, 0.002)
    log = MotionLog("long", time, {KNEE: time, TORQUE.format("x"): moving(time, [(60.0, 120.0)], 1.0)})
    found = most_moving(log)
    assert len(found.left_out) == 1
    ((start, end),) = found.left_out
    before, after = np.searchsorted(found.time, [start, end])
    assert after == before + 1
    empty = np.flatnonzero(np.isnan(found.column(KNEE)))
    np.testing.assert_array_equal(empty, np.arange(before - 49, before + 1))  # 0.1 s
    assert evenly_sampled(found) is found
    assert sampling(found).gaps == ()
    thin = thinned(found).column(KNEE)
    assert np.isnan(thin).any()
    known = np.isfinite(thin)
    np.testing.assert_allclose(
        thin[known], thinned(found).time[known], atol=1e-6
    )  # no step passes the filter


@pytest.mark.parametrize("unit", [1e3, 1e9])
def test_a_clock_in_other_units_is_left_to_those_who_tell_it(unit: float) -> None:
    log = long_log(x=moving(TIME, [(300.0, 420.0)], 0.5))
    wrong = MotionLog("long", log.time * unit, log.columns)
    assert most_moving(wrong) is wrong


@pytest.mark.parametrize("foot", ["left", "foot.left"])
def test_other_sensors_do_not_choose(foot: str) -> None:
    """Twelve fingers, each with a stretch of its own, of the ten that there are."""
    own = {f"wrench.{foot}.torque.x": moving(TIME, [(300.0, 420.0)], 0.5)}
    moves = [(900.0 + 60.0 * finger, 960.0 + 60.0 * finger) for finger in range(12)]
    fingers = {
        f"wrench.finger_{place}.torque.y": moving(TIME, [one], 1.0, 50.0) for place, one in enumerate(moves)
    }
    log = MotionLog("long", TIME + 5.0, {**fingers, **own}, notes=(GAP,))
    found = most_moving(log, {foot})
    assert {5, 6} <= starts_of(found)
    assert found.notes[0] == GAP, "what was said of the log stays said"
    assert not {5, 6} & starts_of(most_moving(log))


def test_a_spike_is_no_motion() -> None:
    torque = moving(TIME, [(60.0 * k, 60.0 * k + 60.0) for k in range(20, 30)], 0.5)
    for minute in range(11):
        torque[minute * 1200 + 600] = 1e4
    assert set(range(20, 30)) == starts_of(most_moving(long_log(x=torque)))


def test_a_slow_sensor_has_no_gap_where_stretches_are_left_out(robot: RobotModel) -> None:
    time = np.arange(0.0, 900.0, 0.01)
    log = long_log(900.0, 100.0, x=moving(time, [(120.0, 180.0), (600.0, 660.0)], 0.5))
    sensor = robot.feet["left"].wrench.name
    names = [f"wrench.{sensor}.{part}.{axis}" for part in ("force", "torque") for axis in "xyz"]
    slow = np.where(
        np.arange(len(time)) % 4 == 2, moving(time, [(120.0, 180.0), (600.0, 660.0)], 0.5), np.nan
    )
    found = most_moving(MotionLog("long", log.time, {**log.columns, **dict.fromkeys(names, slow)}))
    assert found.left_out
    assert [*check_gaps(robot, found)] == []


def test_rows_whose_time_steps_back_leave_what_is_left_out_as_it_is(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet

    log = long_log(x=moving(TIME, [(300.0, 420.0)], 0.5))
    time = log.time.copy()
    time[[1000, 6500, 7000, 7199, 7201]] -= 3.0
    table = pa.table({"time": time, **log.columns})
    pyarrow.parquet.write_table(table, tmp_path / "long.parquet")
    read = open_log(tmp_path / "long.parquet", longest=LONGEST)
    assert sampling(read).gaps == ()
    assert len(read.left_out) == len(most_moving(log).left_out)


def test_a_gap_of_the_log_itself_stays_one() -> None:
    log = long_log(x=moving(TIME, [(300.0, 420.0)], 0.5))
    torn = log.select((log.time < 320.0) | (log.time > 340.0))
    (gap,) = sampling(most_moving(torn)).gaps
    assert gap == pytest.approx((320.0, 340.0), abs=0.1)


def test_no_gap_is_found_where_stretches_are_left_out(robot: RobotModel) -> None:
    found = most_moving(long_log(x=moving(TIME, [(300.0, 420.0)], 0.5)))
    assert [*check_gaps(robot, found)] == []


def test_cells_without_a_reading_are_no_motion() -> None:
    torque = moving(TIME, [(300.0, 360.0)], 0.5)
    torque[: 60 * 20] = np.nan
    torque[1::2] = np.nan
    assert 5 in starts_of(most_moving(long_log(x=torque)))
    assert len(most_moving(long_log(x=np.full(len(TIME), np.nan)))) == LONGEST * 20


def test_parquet_is_read_as_if_it_had_been_read_whole(tmp_path: Path) -> None:
    path = tmp_path / "long.parquet"
    save_log(long_log(x=moving(TIME, [(300.0, 420.0)], 0.5)), path)
    whole = open_log(path)
    assert len(whole) == len(TIME)
    read, chosen = open_log(path, longest=LONGEST), most_moving(whole)
    np.testing.assert_array_equal(read.time, chosen.time)
    for name in chosen.columns:
        np.testing.assert_array_equal(read.column(name), chosen.column(name))
    assert (read.left_out, read.notes) == (chosen.left_out, chosen.notes)
    assert most_moving(read) is read
    assert len(open_log(path, longest=LONGEST, memory=whole.size // 2)) == len(read)
    with pytest.raises(NoRoom):
        open_log(path, memory=whole.size // 2)


def test_torques_about_the_vertical_do_not_choose() -> None:
    moves = [(600.0 + 60.0 * place, 660.0 + 60.0 * place) for place in range(10)]
    log = long_log(x=moving(TIME, [(300.0, 420.0)], 0.5, 0.1), z=moving(TIME, moves, 0.5, 50.0))
    assert (
        most_moving(log).time.tolist()
        == most_moving(long_log(x=log.column(TORQUE.format("x")))).time.tolist()
    )
