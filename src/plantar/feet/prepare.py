"""All logs of one identification made ready together: what is common to them is found here."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from plantar.errors import DataError
from plantar.feet.exclusion.edge_rolling import leave_out_edges
from plantar.feet.exclusion.slip import leave_out_slip
from plantar.feet.exclusion.torque_saturation import leave_out_torque_saturation
from plantar.feet.fit.vertical_stiffness import VerticalStiffness, fit_vertical_stiffness
from plantar.feet.recording import Recording, Role, checked, moved_centre, prepare
from plantar.feet.sensors.sensor_delay import SensorDelay, estimate_wrench_delay, in_time, known_delay
from plantar.feet.sensors.tilt_error import NO_TILT_ERROR, TiltError, log_tilt_error
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note, unique
from plantar.robot.model import RobotModel

Progress = Callable[[str], None]


@dataclass(frozen=True)
class PreparedLogs:
    """Recordings to fit and to validate, the wrenches' delay and the bushes' vertical compliance behind them."""

    fitted: tuple[Recording, ...]
    unseen: tuple[Recording, ...]
    sensor_delay: SensorDelay
    vertical: VerticalStiffness
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
) -> PreparedLogs:
    """Check, put on even grids, correct for delay, leave out what cannot serve, move torques to the loaded centre.

    Raises RobotError, LogError or DataError with one line where an input cannot serve.
    """
    check_names([*logs, *validate])
    progress("check the logs")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        even = list(pool.map(lambda log: checked(robot, log), [*logs, *validate]))
        progress("estimate the sensors' delays")
        sensor_delay = (
            estimate_wrench_delay(robot, even, pool.map)
            if settings.wrench_delay is None
            else known_delay(settings.wrench_delay)
        )
        even = [in_time(robot, log, sensor_delay) for log in even]
        tilt_error = common_tilt_error(robot, even)
        roles = _roles("fit", logs) + _roles("validate", validate)
        recordings = list(
            pool.map(
                lambda log, role: recorded(robot, log, role, settings, tilt_error, progress),
                even,
                roles,
            )
        )
        progress("look for soles that tip or slide")
        leave_out_edges(robot, recordings, settings)
        list(pool.map(lambda recording: leave_out_slip(robot, recording), recordings))
    progress("fit z")
    vertical = fit_vertical_stiffness(recordings[: len(logs)], robot, settings.cutoff)
    moved = [moved_centre(recording, vertical.compliance, settings.cutoff) for recording in recordings]
    notes = [*(note for one in recordings for note in one.notes), sensor_delay.note, *vertical.notes]
    return PreparedLogs(
        tuple(moved[: len(logs)]), tuple(moved[len(logs) :]), sensor_delay, vertical, unique(notes)
    )


def _roles(role: Role, logs: Sequence[MotionLog]) -> list[Role]:
    return [role for _ in logs]


def common_tilt_error(robot: RobotModel, logs: Sequence[MotionLog]) -> TiltError:
    """The pull of the IMU's filter that all logs together show."""
    return sum((log_tilt_error(log, robot.imu) for log in logs if robot.imu), NO_TILT_ERROR)


def recorded(
    robot: RobotModel,
    log: MotionLog,
    role: Role,
    settings: FeetSettings,
    tilt_error: TiltError,
    progress: Progress,
) -> Recording:
    """A `checked` log `in_time` as `prepare` makes it ready, without what is sure to be beyond the sole."""
    progress(f"prepare {log.name}")
    recording = prepare(robot, log, role, settings, tilt_error)
    leave_out_torque_saturation(robot, recording, settings)
    return recording


def check_names(logs: Sequence[MotionLog]) -> None:
    """DataError where two logs have one name: results name motions by them."""
    seen: dict[str, MotionLog] = {}
    for log in logs:
        if log.name in seen:
            message = f"two logs are called '{log.name}': {seen[log.name].source} and {log.source}"
            raise DataError(f"{message} (valid: file names that differ, since results name motions by them)")
        seen[log.name] = log
