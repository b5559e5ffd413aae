"""Robots and logs as a caller gives them, and names that must differ."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar.errors import DataError, LogError, NoRoom, RobotError
from plantar.logs.inputs import check_names, logs_of, open_in_turn, robot_of
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log


def log(name: str) -> MotionLog:
    return MotionLog(name, np.arange(3.0), {})


def test_two_logs_of_one_name_are_refused() -> None:
    check_names([log("one"), log("two")])
    with pytest.raises(DataError, match="two logs are called 'one'"):
        check_names([log("one"), log("two"), log("one")])


def test_what_is_no_log_or_no_robot_is_said_in_one_line() -> None:
    one = log("one")
    assert list(logs_of(one, None)) == [one]  # type: ignore[arg-type]
    assert list(logs_of([one], None)) == [one]  # type: ignore[arg-type]
    for wrong in (3, [3]):
        with pytest.raises(LogError, match="value 'int': is not a log"):
            list(logs_of(wrong, None))  # type: ignore[arg-type]
    with pytest.raises(RobotError, match="is not a robot"):
        robot_of(3)  # type: ignore[arg-type]


def test_logs_read_in_turn_fit_beside_what_is_kept_of_those_before(tmp_path: Path) -> None:
    paths = [tmp_path / f"{name}.csv" for name in ("one", "two", "three")]
    for path in paths:
        path.write_text("time,joint.knee.position\n" + "".join(f"{0.01 * k:g},0\n" for k in range(100)))
    size = open_log(paths[0]).size
    few = open_in_turn(paths, None, lambda log: log.size // 5, 2 * size)  # type: ignore[arg-type]
    assert [log.name for log in few] == ["one", "two", "three"]
    with pytest.raises(NoRoom, match=r"two.csv: does not fit beside the other logs, which leave 800 bytes"):
        list(open_in_turn(paths, None, lambda log: log.size, size + 800))  # type: ignore[arg-type]
    with pytest.raises(NoRoom, match=r"one.csv: holds 100 rows"):
        list(open_in_turn(paths, None, lambda log: log.size, size - 1))  # type: ignore[arg-type]
