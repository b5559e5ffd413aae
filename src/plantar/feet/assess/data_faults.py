"""Faults of the data that were seen and could not be put right: no number that rests on them is called usable."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from plantar.faults.channels import LOST_FRAMES
from plantar.faults.dead_band import DEAD_BAND, DEAD_FORCE
from plantar.faults.gyroscope import IMU_LATE
from plantar.faults.standing import LEANS, LEANS_LITTLE
from plantar.feet.assess.sensor_hysteresis import HYSTERESIS
from plantar.feet.place.place_notes import BUSH_TURNED, FAR
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.notes import Note
from plantar.results.feet import Parameter
from plantar.sensors.accelerometer_delay import ORIENTATION_LATE
from plantar.sensors.bandwidth import FILTERED
from plantar.sensors.delays.sensor_delay import BEYOND_SEARCH
from plantar.sensors.moments.torque_delay import TORQUES_LATE

# Codes of warnings on a log's signs, frames, times, full scales and load, and on a bush far from its place.
UNMENDED = frozenset(
    {
        "sign", LEANS, LEANS_LITTLE, "imu_turned", "wrench_turned", IMU_LATE, "gyroscope_frame", "gyroscope_scale",
        "path_joint_missing", "stuck_channel", "vertical_only", "weight", "bush_axes", "bush_link", "sparse_stances",
        FAR, BUSH_TURNED, DEAD_BAND, DEAD_FORCE, LOST_FRAMES, ORIENTATION_LATE,
    }
)  # fmt: skip
# Codes of warnings on sensors that lag, or repeat what they read before: what they spoil is damping and memory.
OF_MOMENTS = frozenset({FILTERED, BEYOND_SEARCH, HYSTERESIS, TORQUES_LATE, LOST_FRAMES})
ADVICE = "mend what the warning names, or leave this log out"


def data_faults(recordings: Sequence[Recording], fit: AxisFit) -> list[Note]:
    """The warnings on logs in which this foot has used samples, and on its fit."""
    used = [recording for recording in recordings if recording.used(fit.foot).any()]
    stands = [recording for recording in used if recording.stances[fit.foot] is None]
    own = [note for note in fit.notes if note.severity == "warning" and note.code in UNMENDED]
    return [*_faults_of(used, stands), *own]


def standing_faults(recordings: Sequence[Recording]) -> list[Note]:
    """The warnings on logs in which no foot steps: those that the vertical stiffness rests on."""
    stand = [one for one in recordings if all(stances is None for stances in one.stances.values())]
    return _faults_of(stand, stand)


def _faults_of(used: Sequence[Recording], stands: Sequence[Recording]) -> list[Note]:
    """The warnings on `used` logs, those of which the foot `stands` in among them.

    Where the ground's force leans a little in some logs and not in others, somebody holds or pushes the robot in those:
    a turned IMU or a wrong mass would show in all of them.
    """
    upright = any(
        all(note.code not in (LEANS_LITTLE, LEANS) for note in recording.notes) for recording in stands
    )
    seen = [
        note for recording in used for note in recording.notes if not (upright and note.code == LEANS_LITTLE)
    ]
    return [note for note in seen if note.severity == "warning" and note.code in UNMENDED]


def first_sentence(note: Note) -> str:
    """What a warning says, without what to do about it: the warning itself stands above the numbers."""
    return note.text.partition(". ")[0]


def doubted(rows: Sequence[Parameter], faults: Sequence[Note], *, steps: bool = False) -> list[Parameter]:
    """The rows, no longer usable where the data have a fault: a sensor behind a slow filter, or late by nobody knows
    how much, leaves the stiffness to its interval.

    Of a foot that `steps` a slow filter spoils the stiffness too: it smears landings over the stance.
    """
    moments = OF_MOMENTS - {FILTERED} if steps else OF_MOMENTS
    found = []
    for row in rows:
        own = [note for note in faults if note.code not in moments or row.name != "stiffness"]
        if own and row.verdict == "usable":
            reason = f"a fault of the data: {first_sentence(own[0])}"
            found.append(replace(row, verdict="weak", reason=reason, advice=ADVICE))
        else:
            found.append(row)
    return found
