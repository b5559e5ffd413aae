"""Gaps in rows and in single sensors are told of where they cost time."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from plantar.conventions import Mask
from plantar.faults.gaps import check_gaps
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return record(sway(duration=20.0))


def emptied(log: MotionLog, part: str, rows: Mask) -> MotionLog:
    names = [name for name in log.columns if part in name]
    return log.with_columns({name: np.where(rows, np.nan, log.column(name)) for name in names})


def test_an_empty_sensor_is_named_with_its_time(robot: RobotModel, log: MotionLog) -> None:
    (found,) = check_gaps(robot, emptied(log, "wrench.left", (log.time > 4) & (log.time < 6)))
    assert (found.code, found.fatal) == ("gaps", False)
    assert "'wrench.left.*': 1 gap" in found.text
    assert "from t = 4.0" in found.text
    assert "10 % of the log" in found.text


def test_gaps_are_a_share_of_what_was_chosen_of_a_long_recording(robot: RobotModel, log: MotionLog) -> None:
    """Of its 20 s ten are no gap: others tell more."""
    holed = emptied(log, "wrench.left", (log.time > 4) & (log.time < 6))
    kept = (log.time < 8) | (log.time >= 18)
    columns = {name: values[kept] for name, values in holed.columns.items()}
    chosen = MotionLog(holed.name, log.time[kept], columns, left_out=((7.99, 18.0),))
    (found,) = check_gaps(robot, chosen)
    assert "'wrench.left.*': 1 gap" in found.text
    assert "20 % of the log" in found.text


def test_rows_that_are_missing_count_too(robot: RobotModel, log: MotionLog) -> None:
    kept = log.time % 5 > 0.5
    thin = MotionLog(log.name, log.time[kept], {name: log.column(name)[kept] for name in log.columns})
    (found,) = check_gaps(robot, thin)
    assert found.text.startswith("rows: 3 gaps")


def test_short_holes_late_starts_and_early_ends_are_not_worth_a_word(
    robot: RobotModel, log: MotionLog
) -> None:
    assert list(check_gaps(robot, log)) == []
    assert list(check_gaps(robot, emptied(log, "imu.", log.time < 5))) == []
    assert list(check_gaps(robot, emptied(log, "imu.", log.time > 15))) == []
    assert list(check_gaps(robot, emptied(log, "imu.", np.arange(len(log)) % 4 > 0))) == []
    assert list(check_gaps(robot, emptied(log, "wrench.left", (log.time > 4) & (log.time < 4.4)))) == []


def test_an_encoder_that_drops_out_is_named(robot: RobotModel, log: MotionLog) -> None:
    column = "joint.left_ankle_pitch.position"
    gone = log.time % 5 > 4.8
    angle = np.where(gone, 0.0, log.column(column) + 0.3)
    (found,) = check_gaps(robot, log.with_columns({column: angle}))
    assert (found.code, found.severity) == ("dropout", "warning")
    assert found.text == (
        f"column '{column}', t = 4.8 s, value 0: reads exactly 0 between jumps in 3 stretches, 3.2 % of the log, left "
        "out; does the sensor lose its connection? (valid: leave such cells empty)"
    )
    assert not list(check_gaps(robot, log.with_columns({"joint.neck.position": angle})))


def test_a_sensor_that_drops_out_is_named_as_a_whole(robot: RobotModel, log: MotionLog) -> None:
    gone = log.time % 5 > 4.8
    names = [name for name in log.columns if name.startswith("wrench.left.")]
    silent = {name: np.where(gone, 0.0, log.column(name)) for name in names}
    (found,) = check_gaps(robot, log.with_columns(silent))
    assert (found.code, found.severity) == ("dropout", "warning")
    assert "columns 'wrench.left.*', t = 4.8" in found.text
    assert "read exactly 0" in found.text


@pytest.mark.parametrize(("seconds", "told"), [(0.5, False), (0.8, True)])
def test_gaps_are_worth_a_word_from_three_percent_of_the_log_on(
    robot: RobotModel, log: MotionLog, seconds: float, told: bool
) -> None:
    """Of 20 s, in one hole or in two of different sensors."""
    for parts in (("wrench.left",), ("wrench.left", "wrench.right")):
        holed = log
        for place, part in enumerate(parts):
            start = 4.0 + 3.0 * place
            rows = (log.time > start) & (log.time < start + seconds / len(parts))
            holed = emptied(holed, part, rows)
        assert len(list(check_gaps(robot, holed))) == told
