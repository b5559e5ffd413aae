"""What may be used of a replayed log: the estimator sees no fault that only a whole log shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from plantar.faults.log_faults import check_log, finding_notes, refuse_impossible
from plantar.feet.assess.data_faults import UNMENDED, doubted
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.online.replay import IDENTIFY
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Parameter
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import ORIENTATION_LATE
from plantar.sensors.attitude_lag import ATTITUDE_LATE
from plantar.sensors.tilt_error import ATTITUDE_TILTED

# Codes of notes on an IMU whose orientation a batch fit put right, or did without: the estimator goes by it as it is.
OF_ORIENTATION = frozenset({ATTITUDE_LATE, ATTITUDE_TILTED, ORIENTATION_LATE})
UNTOLD = (
    "without a result of `identify feet`: errors of the robot file do not show here, and hysteresis of the rubber only "
    "in large motions"
)

AGAIN = (
    "run `plantar identify feet` again, on this log and on larger motions of this robot, and give that result"
)


def log_notes(robot: RobotModel, log: MotionLog) -> tuple[Note, ...]:
    """The faults of a log, as notes. Raises DataError where a sensor reads something impossible."""
    findings = check_log(robot, log)
    refuse_impossible(log, findings)
    return tuple(finding_notes(log, findings))


def result_notes(result: FeetResult | None) -> tuple[Note, ...]:
    """Warnings, one of each code, of what a batch `result` says of the IMU, by whose orientation the estimator goes."""
    notes = () if result is None else result.notes
    first = {note.code: note for note in reversed(notes) if note.code in OF_ORIENTATION}
    return tuple(
        Note(code, "warning", f"in the result: {note.text}; here it is used as it is")
        for code, note in first.items()
    )


def judged(rows: Sequence[Parameter], notes: Sequence[Note], *, identified: bool) -> list[Parameter]:
    """The rows, at most weak where the log has a fault, or no batch result has been `identified` for this robot."""
    doubts = UNMENDED | OF_ORIENTATION
    faults = [note for note in notes if note.severity == "warning" and note.code in doubts]
    found = doubted(rows, faults)
    if identified:
        return [replace(row, advice=AGAIN) if row.advice == IDENTIFY else row for row in found]
    return [
        replace(row, verdict="weak", reason=UNTOLD, advice=IDENTIFY) if row.verdict == "usable" else row
        for row in found
    ]
