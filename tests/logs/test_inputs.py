"""Robots and logs as a caller gives them, and names that must differ."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.errors import DataError, LogError, RobotError
from plantar.logs.inputs import check_names, logs_of, robot_of
from plantar.logs.motion_log import MotionLog


def log(name: str) -> MotionLog:
    return MotionLog(name, np.arange(3.0), {})


def test_two_logs_of_one_name_are_refused() -> None:
    check_names([log("one"), log("two")])
    with pytest.raises(DataError, match="two logs are called 'one'"):
        check_names([log("one"), log("two"), log("one")])


def test_what_is_no_log_or_no_robot_is_said_in_one_line() -> None:
    one = log("one")
    assert logs_of(one, None) == (one,)  # type: ignore[arg-type]
    assert logs_of([one], None) == (one,)  # type: ignore[arg-type]
    for wrong in (3, [3]):
        with pytest.raises(LogError, match="value 'int': is not a log"):
            logs_of(wrong, None)  # type: ignore[arg-type]
    with pytest.raises(RobotError, match="is not a robot"):
        robot_of(3)  # type: ignore[arg-type]
