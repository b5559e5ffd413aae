"""All logs of one identification made ready together: what is common to them is found here."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import hypot
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array, Axis
from plantar.errors import DataError
from plantar.feet.coherent_band import coherent_band
from plantar.feet.exclusion.edge_rolling import without_edge_rolling
from plantar.feet.exclusion.slip import without_slip
from plantar.feet.exclusion.torque_saturation import without_torque_saturation
from plantar.feet.first_look import FirstLook, look_again, look_at, looked_at, over_logs
from plantar.feet.fit.vertical_stiffness import Heights, VerticalStiffness, fit_vertical_stiffness, heights_of
from plantar.feet.interval_width.force_gain import (
    GainError,
    force_gain_errors,
    force_gain_notes,
    gain_reaches,
)
from plantar.feet.place.imu_mount import ImuTurn
from plantar.feet.prepare_log import prepare
from plantar.feet.recording import Recording, Role, filtered_recording, has_steps, moved_centre
from plantar.feet.settings import FeetSettings
from plantar.logs.freed_memory import return_freed
from plantar.logs.inputs import check_names
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note, unique
from plantar.robot.guesses import guess_notes, naming_notes
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import imu_delay, with_imus_on_time
from plantar.sensors.attitude_lag import NO_LAG, without_lag
from plantar.sensors.attitude_scale import AttitudeScale, attitude_scale_notes
from plantar.sensors.bandwidth import Fading, fading, fading_notes, slow_filter
from plantar.sensors.delays.sensor_delay import SensorDelay, estimate_wrench_delay, in_time, known_delay
from plantar.sensors.imu_filter import imu_filter, with_gyroscopes_on_time
from plantar.sensors.moments.bent_joints import (
    JointBending,
    joint_bending,
    joint_bending_notes,
    put_straight,
)
from plantar.sensors.moments.moment_errors import MomentErrors, moment_errors
from plantar.sensors.moments.moment_fit import moments_of
from plantar.sensors.moments.sensor_errors import BENDING
from plantar.sensors.moments.sensor_turns import sensor_turn_notes
from plantar.sensors.moments.torque_delay import torque_delay_notes
from plantar.sensors.moments.torque_gains import TorqueGain, torque_gain_notes, torque_gains
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.sensors.tilt_error import NO_TILT_ERROR

Progress = Callable[[str], None]


@dataclass(frozen=True)
class PreparedLogs:
    """Recordings to fit and to validate, the wrenches' delay and the bushes' vertical compliance behind them.

    `settings` hold the cutoff that was used. `gain_errors`: see `force_gain_errors`; `torque_gains`: see there.
    `turned`: by foot, a warning that its force sensor is; `imu_turn`: by which all angles were put right; `bending`:
    by which joints were. `slow_filter`: that forces and torques are behind, or the others.
    """

    robot: RobotModel
    fitted: tuple[Recording, ...]
    unseen: tuple[Recording, ...]
    settings: FeetSettings
    sensor_delay: SensorDelay
    vertical: VerticalStiffness
    notes: tuple[Note, ...]
    gain_errors: Mapping[str, GainError]
    torque_gains: Mapping[Axis, TorqueGain]
    turned: Mapping[str, Note]
    imu_turn: ImuTurn
    slow_filter: Fading | None
    bending: JointBending

    @property
    def recordings(self) -> tuple[Recording, ...]:
        return self.fitted + self.unseen


def prepare_all(
    robot: RobotModel,
    logs: Iterable[MotionLog],
    validate: Iterable[MotionLog],
    settings: FeetSettings,
    progress: Progress,
    meanwhile: Callable[[], object] | None = None,
) -> PreparedLogs:
    """Check, put on even grids, and `prepare_checked`; a log that is read when its turn comes is let go when checked.

    meanwhile: called while logs are read and cores are free. Raises RobotError, LogError or DataError with one line
    where an input cannot be used, or nothing is to be fitted.
    """
    progress("check the logs")
    timed = settings.wrench_delay is None
    fitted = looked_at(robot, logs, timed, meanwhile)
    if not fitted:
        raise DataError("no logs to fit (valid: at least one)")
    unseen = looked_at(robot, validate, timed)
    check_names([one.log for one in (*fitted, *unseen)])
    return prepare_checked(robot, fitted, unseen, settings, progress)


def prepare_checked(
    robot: RobotModel,
    logs: Sequence[FirstLook],
    validate: Sequence[FirstLook],
    settings: FeetSettings,
    progress: Progress,
) -> PreparedLogs:
    """Correct `checked` logs for delay, leave out what cannot be used, move torques to the loaded centre."""
    progress("estimate the sensors' delays")
    looks, unsure = _on_time(robot, [*logs, *validate], settings.wrench_delay is None)
    delay = _wrench_delay(robot, looks, settings, unsure)
    for look in (*logs, *validate, *looks):
        look.forget_residuals()
    size = max(look.log.size for look in looks)
    return_freed(size)
    found = _recordings(robot, looks, len(logs), settings, delay, progress)
    steps, balances = any(map(has_steps, found.recordings)), found.moments
    # Legs that may bend hide what torques read too much: they are asked only where they show it.
    moments = moments_of(robot, balances, steps, BENDING)
    bending = joint_bending(robot, moments)
    if bending.found:
        bent = looks
        for last in (False, True):
            return_freed(size)
            looks = _straight(robot, bent, settings.wrench_delay is None, bending.compliances, delay)
            delay = _wrench_delay(robot, looks, settings, unsure)
            for look in looks:
                look.forget_residuals()
            # What bends moves what it is told by: once more.
            told = replace(delay, residuals=()) if last else delay
            found = _recordings(robot, looks, len(logs), settings, told, progress)
            if not last:
                moments = moments_of(robot, found.moments, steps, BENDING)
                bending = joint_bending(robot, moments, bending.compliances)
        del bent
    else:
        moments = moments_of(robot, balances, steps)
    del balances
    recordings, settings = found.recordings, found.settings
    return_freed(size)
    progress("fit z")
    forces = force_gain_errors(robot, recordings)
    vertical = fit_vertical_stiffness(found.heights, robot, gain_reaches(robot, forces))
    moved = [moved_centre(recording, vertical.compliance) for recording in recordings]
    return_freed(size)
    filtered = slow_filter(fading(delay.residuals))
    delay = replace(delay, residuals=())  # both sides of Newton's law in every log: no fit reads them
    return_freed(size)
    torques, turned = torque_gains(robot, moments), sensor_turn_notes(robot, moments)
    file = robot.path.name
    odd = [
        *naming_notes(file, robot.guesses),
        *guess_notes(file, robot.guesses),
        *robot.weight_notes,
        *force_gain_notes(robot, forces),
        *torque_gain_notes(torques).values(),
        *turned.values(),
        *torque_delay_notes(moments),
        *joint_bending_notes(robot, bending),
        *fading_notes(filtered),
        *attitude_scale_notes(sum((one.attitude_scale for one in recordings), AttitudeScale())),
    ]
    notes = [*odd, *(note for one in recordings for note in one.notes), delay.note, *vertical.notes]
    fitted, unseen = tuple(moved[: len(logs)]), tuple(moved[len(logs) :])
    mount = ImuTurn.unknown(robot.uncertainty.imu_mount)
    return PreparedLogs(
        robot,
        fitted,
        unseen,
        settings,
        delay,
        vertical,
        unique(notes),
        forces,
        torques,
        turned,
        mount,
        filtered,
        bending,
    )


def prepare_unseen(
    robot: RobotModel,
    logs: Iterable[MotionLog],
    settings: FeetSettings,
    delay: SensorDelay,
    compliance: Mapping[str, float],
    progress: Progress,
    bends: Array | None = None,
) -> list[Recording]:
    """Logs to score with what an earlier fit found: its cutoff in `settings`, its `delay`, its `compliance` [m/N], and
    by which joints `bends` (joints,) [rad/(N.m)]."""
    looks = looked_at(robot, logs, False)
    if not looks:
        return []
    check_names([look.log for look in looks])
    looks, _ = _on_time(robot, looks, False)
    if bends is not None:
        looks = _straight(robot, looks, False, bends, delay)
    recordings = _recordings(robot, looks, 0, settings, delay, progress).recordings
    return [moved_centre(recording, compliance) for recording in recordings]


def _on_time(robot: RobotModel, looks: Sequence[FirstLook], timed: bool) -> tuple[list[FirstLook], float]:
    """The logs with what the IMU's own filter delays read at the moments of its orientation, or without an orientation
    that lags, and how unsure these are beside the accelerometer's [s]; looked at again where that moves them."""
    looks = _without_lag(robot, looks, timed)
    before, name = [look.log for look in looks], "" if robot.imu is None else robot.imu.name
    imu = imu_filter([look.gyroscope for look in looks])
    read = with_gyroscopes_on_time(before, name, imu)
    late, std = imu_delay([look.accelerometer for look in looks], imu)
    after = with_imus_on_time(robot, read, (late, std))
    unsure = std if late else 0.0
    if all(one is other for one, other in zip(before, after, strict=True)):
        return [*looks], unsure
    with over_logs(after) as each:
        return list(each(partial(look_again, robot, timed), looks, after)), unsure


def _without_lag(robot: RobotModel, looks: Sequence[FirstLook], timed: bool) -> list[FirstLook]:
    """The logs without an attitude that lags, looked at anew."""
    lag = sum((look.lag for look in looks), NO_LAG)
    if robot.imu is None or not lag.believed(sum((look.tilt for look in looks), NO_TILT_ERROR)):
        return [*looks]
    logs = without_lag([look.log for look in looks], robot.imu, lag)
    with over_logs(logs) as each:
        return list(each(partial(look_at, robot, timed), logs))


def _wrench_delay(
    robot: RobotModel, looks: Sequence[FirstLook], settings: FeetSettings, unsure: float
) -> SensorDelay:
    """The delay that the logs show, or that the user knows; `unsure` [s]: as of `_on_time`."""
    if settings.wrench_delay is not None:
        return known_delay(settings.wrench_delay)
    even = [look.log for look in looks]
    with over_logs(even) as each:
        delay = estimate_wrench_delay(robot, even, each, [look.residuals for look in looks])
    # Newton's law tells delays against the accelerometer, and a bush has its angle from the orientation.
    return replace(delay, std=hypot(delay.std, unsure))


def _straight(
    robot: RobotModel, looks: Sequence[FirstLook], timed: bool, compliances: Array, delay: SensorDelay
) -> list[FirstLook]:
    """The logs with their joints put straight, looked at again: joints that bend also seem late, or filtered."""
    if not compliances.any():
        return [*looks]
    shown = [one.parameters for one in delay.residuals]
    above = np.mean(shown, axis=0) if shown else None
    with over_logs([look.log for look in looks]) as each:
        straight = list(each(lambda look: put_straight(robot, look.log, compliances, delay, above), looks))
        return list(each(partial(look_again, robot, timed), looks, straight))


class _Ready(NamedTuple):
    """Recordings without what cannot be used, and the settings with the cutoff that was; of those to fit what the
    `heights` of their soles tell, and of all in which Newton's law closes what its `moments` do."""

    recordings: list[Recording]
    settings: FeetSettings
    heights: list[Heights]
    moments: list[MomentErrors]


def _recordings(
    robot: RobotModel,
    looks: Sequence[FirstLook],
    fitted: int,
    settings: FeetSettings,
    delay: SensorDelay,
    progress: Progress,
) -> _Ready:
    """Logs, the first `fitted` of them to fit, made ready."""
    others = f" and {len(looks) - 1} more" if len(looks) > 1 else ""
    progress(f"prepare {looks[0].log.name}{others}")
    tilt_error = sum((look.tilt for look in looks), NO_TILT_ERROR)
    highest = settings.highest_cutoff
    roles: list[Role] = ["fit" if place < fitted else "validate" for place in range(len(looks))]
    residuals = [[one for one in delay.residuals if one.pair.label == look.log.name] for look in looks]

    def usable(recording: Recording, cutoff: float) -> Recording:
        return without_torque_saturation(robot, filtered_recording(recording, cutoff), settings)

    def ready(look: FirstLook, role: Role) -> tuple[Recording, Recording | None]:
        recording = prepare(robot, in_time(robot, look.log, delay), role, look.tilt, tilt_error, highest)
        # The cutoff may still fall where feet step.
        early = settings.cutoff is not None or not has_steps(recording)
        return recording, usable(recording, highest) if early else None

    def told(
        recording: Recording, residual: NewtonEulerResidual | None
    ) -> MomentErrors | tuple[Recording, Heights | None]:
        return_freed()  # moments take much of any log, and what one process has freed is of no use to the others
        if residual is not None:
            return moment_errors(robot, residual, has_steps(recording))
        flat = without_slip(robot, recording)
        return_freed(recording.log.size)
        return flat, heights_of(robot, flat) if recording.role == "fit" else None

    with over_logs([look.log for look in looks]) as each:
        prepared, done = zip(*each(ready, looks, roles), strict=True)
        cutoff = highest if settings.cutoff is not None else min(highest, coherent_band(prepared[:fitted]))
        settings = replace(settings, cutoff=cutoff)
        recordings = list(done)
        if cutoff < highest or None in done:
            recordings = list(each(partial(usable, cutoff=cutoff), prepared))
        del prepared, done
        progress("look for soles that tip or slide")
        recordings = without_edge_rolling(robot, recordings, settings)
        # What a log's moments tell takes as long as all else that is left of it: cores share it, also of a single log.
        balances = [(recordings[place], one) for place, own in enumerate(residuals) for one in own]
        works = [*balances, *((recording, None) for recording in recordings)]
        return_freed(max(look.log.size for look in looks))
        found = list(each(told, *zip(*works, strict=True)))
    moments = [one for one in found if isinstance(one, MomentErrors)]
    stood = [one for one in found if not isinstance(one, MomentErrors)]
    heights = [own for _, own in stood if own is not None]
    return _Ready([recording for recording, _ in stood], settings, heights, moments)
