"""A replayed log's numbers are no surer than what its checks and a batch result let them be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import record, sway
from plantar.errors import DataError
from plantar.notes import Note
from plantar.online.replay import IDENTIFY
from plantar.online.verdicts import AGAIN, judged, log_notes, result_notes
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Parameter
from plantar.robot.model import RobotModel

ROWS = [
    Parameter("left", "pitch", "stiffness", "N.m/rad", 420.0, 1.0, (418.0, 422.0), None, "usable", ""),
    Parameter("left", "roll", "stiffness", "N.m/rad", 300.0, 90.0, (120.0, 480.0), None, "weak", "± 60 %"),
]


def test_a_batch_result_leaves_the_verdicts_and_none_makes_them_weak() -> None:
    assert judged(ROWS, [], identified=True) == ROWS
    first, second = judged(ROWS, [], identified=False)
    assert (first.verdict, first.advice) == ("weak", IDENTIFY)
    assert second == ROWS[1]


def test_who_gave_a_result_is_not_sent_for_one() -> None:
    small = replace(ROWS[0], verdict="weak", reason="motions too small", advice=IDENTIFY)
    assert judged([small], [], identified=False) == [small]
    assert judged([small], [], identified=True) == [replace(small, advice=AGAIN)]
    assert IDENTIFY == "run `plantar identify feet` on logs of this robot, and give its result (--result)"
    assert AGAIN == (
        "run `plantar identify feet` again, on this log and on larger motions of this robot, and give that result"
    )


@pytest.mark.parametrize(("code", "severity", "verdict"), [
    ("gyroscope_scale", "warning", "weak"), ("gyroscope_scale", "info", "usable"), ("gap", "warning", "usable"),
])  # fmt: skip
def test_a_fault_that_nobody_mends_takes_usable_away(code: str, severity: str, verdict: str) -> None:
    note = Note(code, severity, "sway: the gyroscope")  # type: ignore[arg-type]
    assert judged(ROWS, [note], identified=True)[0].verdict == verdict


def test_a_log_is_checked_as_for_a_batch_fit(robot: RobotModel) -> None:
    log = record(sway(duration=8.0))
    assert log_notes(robot, log) == ()
    columns = [f"imu.chest.angular_velocity.{axis}" for axis in "xyz"]
    degrees = log.with_columns({column: np.degrees(log.column(column)) for column in columns})
    with pytest.raises(
        DataError,
        match=r"^sway: columns 'imu\.chest\.angular_velocity\.\*': 57 times the orientation's rate, "
        r"which looks like degrees per second \(valid: rad/s\)$",
    ):
        log_notes(robot, degrees)


def test_what_a_batch_result_says_of_the_orientation_holds_here_too() -> None:
    """The estimator goes by the orientation that the batch fit put right, or did without."""
    said = (
        Note("attitude_late", "warning", "sway: behind a low-pass of 200 ms"),
        Note("attitude_tilted", "info", "sway: follows its accelerometer"),
        Note("attitude_tilted", "info", "arms: follows its accelerometer"),
        Note("orientation_late", "warning", "sway: 200 ms behind the accelerometer"),
        Note("spikes", "warning", "sway: one sample bridged"),
    )
    notes = result_notes(FeetResult("biped", (), {}, "kelvin_voigt", (), (), (), (), said))
    assert sorted(note.code for note in notes) == ["attitude_late", "attitude_tilted", "orientation_late"]
    assert all(note.severity == "warning" for note in notes)
    assert {note.text for note in notes} == {
        f"in the result: sway: {text}; here it is used as it is"
        for text in (
            "behind a low-pass of 200 ms",
            "follows its accelerometer",
            "200 ms behind the accelerometer",
        )
    }
    for note in notes:
        assert judged(ROWS, [note], identified=True)[0].verdict == "weak"
    assert result_notes(None) == ()
