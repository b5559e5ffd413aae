"""Robots and logs as a caller gives them, and names that must differ."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped_robot import make_robot
from plantar.errors import DataError, LogError, NoRoom, RobotError
from plantar.logs.inputs import check_names, logs_of, open_in_turn, read_ahead, robot_of
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log


def log(name: str, **columns: list[float]) -> MotionLog:
    return MotionLog(name, np.arange(3.0), {name: np.array(values) for name, values in columns.items()})


def test_two_logs_of_one_name_are_refused() -> None:
    check_names([log("one"), log("two")])
    with pytest.raises(
        DataError,
        match=r"^two logs are called 'one': one and one \(valid: file names that differ, since results "
        r"name motions by them\)$",
    ):
        check_names([log("one"), log("two"), log("one")])


SIGNALS = {name: np.random.default_rng(7).normal(size=(2, 600))[place] for place, name in enumerate("ab")}


def recording(name: str, rows: slice = slice(None), later: float = 0.0, **changed: np.ndarray) -> MotionLog:
    columns = {key: values[rows] for key, values in (SIGNALS | changed).items()}
    return MotionLog(name, np.arange(600.0)[rows] + later, columns)


@pytest.mark.parametrize(
    "copy",
    [
        recording("copy"),
        recording("copy", slice(100, 400)),
        recording("copy", slice(0, 600, 5), later=1e9),
        recording("copy", slice(100, 600), later=-3.5),
    ],
)
def test_one_recording_under_two_names_is_refused(copy: MotionLog) -> None:
    """Also cut, thinned, or on another clock: its samples would count twice."""
    for logs in ([recording("one"), copy], [copy, recording("one")]):
        with pytest.raises(DataError, match="hold the same recording"):
            check_names(logs)


def test_one_recording_with_other_columns_is_refused_where_force_sensors_read_the_same() -> None:
    forces = {f"wrench.left.force.{axis}": SIGNALS[axis.replace("x", "a").replace("y", "b")] for axis in "xy"}
    bare = MotionLog("bare", np.arange(600.0), forces | {"joint.a.position": SIGNALS["a"]})
    more = MotionLog("more", np.arange(600.0) + 7, forces | {"joint.b.position": SIGNALS["b"]})
    for logs in ([bare, more], [more, bare]):
        with pytest.raises(DataError, match="hold the same recording"):
            check_names(logs)
    check_names([recording("plan", extra=SIGNALS["a"]), recording("the same plan")])


@pytest.mark.parametrize("first", [150, 250, 340])
def test_recordings_that_overlap_by_more_than_a_tenth_of_the_shorter_are_one(first: int) -> None:
    for later in (0.0, 1e9):
        with pytest.raises(
            DataError,
            match=r"^one and two hold the same recording, or a part of one \(valid: each once; told twice, "
            r"intervals come out too narrow, and a log that was fitted validates nothing\)$",
        ):
            check_names([recording("one", slice(0, 400)), recording("two", slice(first, 600), later)])


def test_simulations_without_noise_may_begin_alike() -> None:
    one = recording("one")
    apart = {name: np.where(np.arange(600) < 240, own, own + 1.0) for name, own in SIGNALS.items()}
    check_names([one, recording("two", **apart)])
    with pytest.raises(
        DataError,
        match=r"^one and two hold the same recording, or a part of one \(valid: each once; told twice, "
        r"intervals come out too narrow, and a log that was fitted validates nothing\)$",
    ):
        check_names([one, recording("two", slice(5, 600), **apart)])


def test_recordings_that_have_little_in_common_are_two() -> None:
    one = recording("one", slice(0, 320))
    check_names([one, recording("next", slice(300, 600)), recording("noisy", a=SIGNALS["a"] + 1e-9)])
    rest = np.zeros(600)
    check_names([recording("rest", a=rest, b=rest), recording("rest too", a=rest, b=rest)])
    gap = np.where(np.arange(600) % 2, np.nan, SIGNALS["a"])
    with pytest.raises(
        DataError,
        match=r"^one and copy hold the same recording, or a part of one \(valid: each once; told twice, "
        r"intervals come out too narrow, and a log that was fitted validates nothing\)$",
    ):
        check_names([recording("one", a=gap), recording("copy", a=gap)])


def test_what_is_no_log_or_no_robot_is_said_in_one_line(tmp_path: Path) -> None:
    robot = make_robot(tmp_path)
    one = log("one")
    assert list(logs_of(one, robot)) == [one]
    assert list(logs_of([one], robot)) == [one]
    for wrong in (3, [3]):
        with pytest.raises(
            LogError,
            match=r"^value 'int': is not a log \(valid: a MotionLog, the path of a log, or a list of them\)$",
        ):
            list(logs_of(wrong, robot))  # type: ignore[arg-type]
    with pytest.raises(
        RobotError, match=r"^value 'int': is not a robot \(valid: a RobotModel or the path of a robot file\)$"
    ):
        robot_of(3)  # type: ignore[arg-type]


def test_logs_read_in_turn_fit_beside_what_is_kept_of_those_before(tmp_path: Path) -> None:
    paths = [tmp_path / f"{name}.csv" for name in ("one", "two", "three")]
    for path in paths:
        path.write_text("time,joint.knee.position\n" + "".join(f"{0.01 * k:g},0\n" for k in range(100)))
    size = open_log(paths[0]).size
    few = open_in_turn(paths, None, lambda log: log.size // 5, 2 * size, ahead={})  # type: ignore[arg-type]
    assert [log.name for log in few] == ["one", "two", "three"]
    with pytest.raises(
        NoRoom,
        match=r"two\.csv: does not fit beside the other logs, which leave 800 bytes \(valid: fewer logs "
        r"at a time, or more with --memory \(memory= in Python\)\)$",
    ):
        list(open_in_turn(paths, None, lambda log: log.size, size + 800, ahead={}))  # type: ignore[arg-type]
    with pytest.raises(
        NoRoom,
        match=r"one\.csv: holds 100 rows x 2 columns, 1\.6 kB as numbers \(valid: at most 1\.6 kB, or "
        r"more with --memory \(memory= in Python\), or a shorter log\)$",
    ):
        list(open_in_turn(paths, None, lambda log: log.size, size - 1, ahead={}))  # type: ignore[arg-type]


def table(path: Path, joint: str = "knee", rows: int = 100) -> Path:
    path.write_text(f"time,joint.{joint}.position\n" + "".join(f"{0.01 * k:g},0\n" for k in range(rows)))
    return path


def test_tables_that_are_read_ahead_are_read_no_second_time(tmp_path: Path) -> None:
    """They come in their turns under the robot's names, and those that cannot be read say so in theirs."""
    robot = make_robot(tmp_path, joint_names={"renamed": {"left_ankle_roll": "Hals"}})
    first, broken, last = table(tmp_path / "a.csv", "Hals"), tmp_path / "b.csv", table(tmp_path / "c.csv")
    broken.write_text("time,joint.knee.position\n0,x\n1,y\n")
    ahead = read_ahead([first, broken, last])
    assert {*ahead} == {first, last}
    for path in (first, last):
        path.unlink()
    turns = iter(open_in_turn([first, broken, last], robot, len, ahead=ahead, memory=None))
    log = next(turns)
    assert (log.name, [*log.columns]) == ("a", ["joint.left_ankle_roll.position"])
    with pytest.raises(
        LogError,
        match=r"b\.csv, column 'joint\.knee\.position', t = 0 s, value 'x': is not a number \(valid: a "
        r"number, or an empty cell where nothing was recorded\)$",
    ):
        next(turns)


def test_logs_that_the_robot_file_maps_are_not_taken_from_those_before(tmp_path: Path) -> None:
    path = table(tmp_path / "one.csv")
    columns = {"time": "time", "joint.left_ankle_roll.position": "joint.knee.position"}
    robot = make_robot(tmp_path, columns=columns)
    found = next(iter(open_in_turn([path], robot, len, ahead=read_ahead([path]), memory=None)))
    assert "joint.left_ankle_roll.position" in found.columns


def test_no_more_is_read_ahead_than_there_is_time_and_room_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = [table(tmp_path / f"{name}.csv") for name in "abc"]
    size = paths[0].stat().st_size
    monkeypatch.setattr("plantar.logs.inputs.AHEAD", 2 * size)
    assert [*read_ahead(paths)] == paths[:2]
    assert not read_ahead(paths, 100)
    assert not read_ahead([*paths, tmp_path / "none.csv"])
