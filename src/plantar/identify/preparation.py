"""All logs of one identification made ready together: what is common to them is found here."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from plantar.errors import DataError
from plantar.identify.attitude_pull import NO_PULL, Pull, log_pull
from plantar.identify.edges import leave_out_edges
from plantar.identify.height import Height, fit_height
from plantar.identify.latency import Latency, in_time, known_latency, wrench_latency
from plantar.identify.recording import Recording, Role, checked, moved_centre, prepare
from plantar.identify.settings import FeetSettings
from plantar.identify.sliding import leave_out_slip
from plantar.identify.tipping import leave_out_tipping
from plantar.log import MotionLog
from plantar.notes import Note, unique
from plantar.robot import RobotModel
from plantar.robot_guesses import guess_notes

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Prepared:
    """Recordings to fit and to validate, the wrenches' delay and the bushes' vertical compliance behind them."""

    fitted: tuple[Recording, ...]
    unseen: tuple[Recording, ...]
    latency: Latency
    vertical: Height
    notes: tuple[Note, ...]

    @property
    def recordings(self) -> tuple[Recording, ...]:
        return self.fitted + self.unseen


def prepare_all(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    validate: Sequence[MotionLog],
    settings: FeetSettings,
    progress: Progress,
) -> Prepared:
    """Check, put on even grids, correct for delay, leave out what cannot serve, move torques to the loaded centre.

    Raises RobotError, LogError or DataError with one line where an input cannot serve.
    """
    check_names([*logs, *validate])
    progress("check the logs")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        even = list(pool.map(lambda log: checked(robot, log), [*logs, *validate]))
        progress("estimate the sensors' delays")
        latency = (
            wrench_latency(robot, even, pool.map)
            if settings.wrench_delay is None
            else known_latency(settings.wrench_delay)
        )
        even = [in_time(robot, log, latency) for log in even]
        pull = common_pull(robot, even)
        roles = _roles("fit", logs) + _roles("validate", validate)
        recordings = list(
            pool.map(
                lambda log, role: recorded(robot, log, role, settings, pull, progress),
                even,
                roles,
            )
        )
        progress("look for soles that tip or slide")
        leave_out_edges(robot, recordings, settings)
        list(pool.map(lambda recording: leave_out_slip(robot, recording), recordings))
    progress("fit z")
    vertical = fit_height(recordings[: len(logs)], robot, settings.cutoff)
    moved = [moved_centre(recording, vertical.compliance, settings.cutoff) for recording in recordings]
    guessed = guess_notes(robot.path.name, robot.guesses)
    notes = [*guessed, *(note for one in recordings for note in one.notes), latency.note, *vertical.notes]
    return Prepared(tuple(moved[: len(logs)]), tuple(moved[len(logs) :]), latency, vertical, unique(notes))


def _roles(role: Role, logs: Sequence[MotionLog]) -> list[Role]:
    return [role for _ in logs]


def common_pull(robot: RobotModel, logs: Sequence[MotionLog]) -> Pull:
    """The pull of the IMU's filter that all logs together show."""
    return sum((log_pull(log, robot.imu) for log in logs if robot.imu), NO_PULL)


def recorded(
    robot: RobotModel,
    log: MotionLog,
    role: Role,
    settings: FeetSettings,
    pull: Pull,
    progress: Progress,
) -> Recording:
    """A `checked` log `in_time` as `prepare` makes it ready, without what is sure to be beyond the sole."""
    progress(f"prepare {log.name}")
    recording = prepare(robot, log, role, settings, pull)
    leave_out_tipping(robot, recording, settings)
    return recording


def check_names(logs: Sequence[MotionLog]) -> None:
    """DataError where two logs have one name: results name motions by them."""
    seen: dict[str, MotionLog] = {}
    for log in logs:
        if log.name in seen:
            message = f"two logs are called '{log.name}': {seen[log.name].source} and {log.source}"
            raise DataError(f"{message} (valid: file names that differ, since results name motions by them)")
        seen[log.name] = log
