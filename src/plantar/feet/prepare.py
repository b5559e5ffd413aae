"""All logs of one identification made ready together: what is common to them is found here."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial

from plantar.conventions import Axis
from plantar.cores import Each, over_cores
from plantar.errors import DataError
from plantar.feet.coherent_band import coherent_band
from plantar.feet.exclusion.edge_rolling import without_edge_rolling
from plantar.feet.exclusion.slip import without_slip
from plantar.feet.exclusion.torque_saturation import without_torque_saturation
from plantar.feet.fit.imu_mount import ImuTurn
from plantar.feet.fit.vertical_stiffness import VerticalStiffness, fit_vertical_stiffness
from plantar.feet.interval_width.force_gain import GainError, force_gain_errors, force_gain_notes
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import Recording, Role, filtered_recording, moved_centre
from plantar.feet.settings import FeetSettings
from plantar.logs.freed_memory import return_freed
from plantar.logs.inputs import WaitingLogs, check_names
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note, unique
from plantar.robot.guesses import guess_notes, naming_notes
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import with_accelerometers_on_time
from plantar.sensors.attitude_scale import AttitudeScale, attitude_scale_notes
from plantar.sensors.bandwidth import fading, fading_notes
from plantar.sensors.delays.sensor_delay import SensorDelay, estimate_wrench_delay, in_time, known_delay
from plantar.sensors.moment_balance import TorqueGain, torque_gain_notes, torque_gains
from plantar.sensors.moment_fit import fit_moments
from plantar.sensors.sensor_turns import sensor_turn_notes
from plantar.sensors.tilt_error import NO_TILT_ERROR, TiltError, log_tilt_error

Progress = Callable[[str], None]
# Samples: with fewer, threads mostly hand Python's lock to each other; with more, copies of the process hold much.
LONG = 50_000


@dataclass(frozen=True)
class PreparedLogs:
    """Recordings to fit and to validate, the wrenches' delay and the bushes' vertical compliance behind them.

    `settings` hold the cutoff that was used. `gain_errors`: see `force_gain_errors`; `torque_gains`: see there.
    `turned`: by foot, a warning that its force sensor is; `imu_turn`: by which all angles were put right.
    """

    robot: RobotModel
    fitted: tuple[Recording, ...]
    unseen: tuple[Recording, ...]
    settings: FeetSettings
    sensor_delay: SensorDelay
    vertical: VerticalStiffness
    notes: tuple[Note, ...]
    gain_errors: Mapping[str, GainError] = field(default_factory=dict)
    torque_gains: Mapping[Axis, TorqueGain] = field(default_factory=dict)
    turned: Mapping[str, Note] = field(default_factory=dict)
    imu_turn: ImuTurn = field(default_factory=partial(ImuTurn.unknown, 0.0))

    @property
    def recordings(self) -> tuple[Recording, ...]:
        return self.fitted + self.unseen


@contextmanager
def over_logs(logs: Sequence[MotionLog]) -> Iterator[Each]:
    """A map over logs, or over what comes of them, on all cores: by threads where one of them is long."""
    if max(map(len, logs), default=0) <= LONG:
        yield over_cores
        return
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield pool.map


def prepare_all(
    robot: RobotModel,
    logs: Iterable[MotionLog],
    validate: Iterable[MotionLog],
    settings: FeetSettings,
    progress: Progress,
) -> PreparedLogs:
    """Check, put on even grids, and `prepare_checked`; a log that is read when its turn comes is let go when checked.

    Raises RobotError, LogError or DataError with one line where an input cannot be used, or nothing is to be fitted.
    """
    progress("check the logs")
    fitted = checked_in_turn(robot, logs)
    if not fitted:
        raise DataError("no logs to fit (valid: at least one)")
    unseen = checked_in_turn(robot, validate)
    check_names([*fitted, *unseen])
    return prepare_checked(robot, fitted, unseen, settings, progress)


def checked_in_turn(robot: RobotModel, logs: Iterable[MotionLog]) -> list[MotionLog]:
    """Every log `checked`, in order: small files on all cores, of others the next is read while one is checked.

    Raises the error of the first that has one.
    """
    if isinstance(logs, WaitingLogs) and logs.fit:
        return over_cores(lambda opened: checked(robot, opened()), logs.openers)
    even: list[MotionLog] = []
    pending: Future[MotionLog] | None = None
    with ThreadPoolExecutor(1) as pool:
        try:
            for log in logs:
                if pending is not None:
                    before, pending = pending, None
                    even.append(before.result())
                pending = pool.submit(checked, robot, log)
                del log  # or it would stay until the next was read
        finally:  # also where the next one cannot be read: what is wrong with this one is told first
            if pending is not None:
                even.append(pending.result())
    return_freed()
    return even


def prepare_checked(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    validate: Sequence[MotionLog],
    settings: FeetSettings,
    progress: Progress,
) -> PreparedLogs:
    """Correct `checked` logs for delay, leave out what cannot be used, move torques to the loaded centre."""
    progress("estimate the sensors' delays")
    with over_logs([*logs, *validate]) as each:
        even = with_accelerometers_on_time(robot, [*logs, *validate], each)
        if settings.wrench_delay is None:
            delay = estimate_wrench_delay(robot, even, each)
        else:
            delay = known_delay(settings.wrench_delay)
    return_freed()
    recordings, settings = _recordings(robot, even, len(logs), settings, delay, progress)
    return_freed()
    progress("fit z")
    with over_logs(even) as each:
        vertical = fit_vertical_stiffness(recordings[: len(logs)], robot, each)
    moved = [moved_centre(recording, vertical.compliance) for recording in recordings]
    forces = force_gain_errors(robot, recordings)
    return_freed()
    with over_logs(even) as each:
        stepping = {
            one.name for one in recordings if any(found is not None for found in one.stances.values())
        }
        moments = fit_moments(robot, delay.residuals, stepping, each)
    fades = fading_notes(fading(delay.residuals))
    delay = replace(delay, residuals=())  # both sides of Newton's law in every log: no fit reads them
    return_freed()
    torques, turned = torque_gains(robot, moments), sensor_turn_notes(robot, moments)
    file = robot.path.name
    odd = [
        *naming_notes(file, robot.guesses),
        *guess_notes(file, robot.guesses),
        *robot.weight_notes,
        *force_gain_notes(robot, forces),
        *torque_gain_notes(torques).values(),
        *turned.values(),
        *fades,
        *attitude_scale_notes(sum((one.attitude_scale for one in recordings), AttitudeScale())),
    ]
    notes = [*odd, *(note for one in recordings for note in one.notes), delay.note, *vertical.notes]
    fitted, unseen = tuple(moved[: len(logs)]), tuple(moved[len(logs) :])
    mount = ImuTurn.unknown(robot.uncertainty.imu_mount)
    return PreparedLogs(
        robot, fitted, unseen, settings, delay, vertical, unique(notes), forces, torques, turned, mount
    )


def prepare_unseen(
    robot: RobotModel,
    logs: Iterable[MotionLog],
    settings: FeetSettings,
    delay: SensorDelay,
    compliance: Mapping[str, float],
    progress: Progress,
) -> list[Recording]:
    """Logs to score with what an earlier fit found: its cutoff in `settings`, its `delay`, its `compliance` [m/N]."""
    even = checked_in_turn(robot, logs)
    check_names(even)
    recordings, _ = _recordings(robot, even, 0, settings, delay, progress)
    return [moved_centre(recording, compliance) for recording in recordings]


def _recordings(
    robot: RobotModel,
    even: Sequence[MotionLog],
    fitted: int,
    settings: FeetSettings,
    delay: SensorDelay,
    progress: Progress,
) -> tuple[list[Recording], FeetSettings]:
    """Checked logs, the first `fitted` of them to fit, as recordings without what cannot be used; the cutoff used."""
    progress("prepare the logs")
    roles: list[Role] = ["fit" if place < fitted else "validate" for place in range(len(even))]

    def read_in_time(log: MotionLog) -> tuple[MotionLog, TiltError]:
        on_time = in_time(robot, log, delay)
        return on_time, log_tilt_error(on_time, robot.imu) if robot.imu else NO_TILT_ERROR

    with over_logs(even) as each:
        on_time, tilt_errors = zip(*each(read_in_time, even), strict=True)
        tilt_error = sum(tilt_errors, NO_TILT_ERROR)

        def ready(log: MotionLog, role: Role) -> Recording:
            return prepare(robot, log, role, tilt_error, settings.highest_cutoff)

        recordings = list(each(ready, on_time, roles))
        cutoff = settings.highest_cutoff
        if settings.cutoff is None:
            cutoff = min(cutoff, coherent_band(recordings[:fitted]))
        settings = replace(settings, cutoff=cutoff)

        def usable(recording: Recording) -> Recording:
            return without_torque_saturation(robot, filtered_recording(recording, cutoff), settings)

        recordings = list(each(usable, recordings))
        progress("look for soles that tip or slide")
        recordings = without_edge_rolling(robot, recordings, settings)
        recordings = list(each(lambda recording: without_slip(robot, recording), recordings))
    return recordings, settings
