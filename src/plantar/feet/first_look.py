"""What each log tells before anything is known of the others: it is checked, and says how far its sensors are off."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from os import cpu_count
from typing import Any

import numpy as np

from plantar.cores import Each, over_cores
from plantar.feet.prepare_log import LONG, checked
from plantar.logs.freed_memory import return_freed
from plantar.logs.inputs import WaitingLogs
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.sensors.accelerometer_delay import AccelerometerDelay, accelerometer_delay, orientation_notes
from plantar.sensors.attitude_lag import NO_LAG, AttitudeLag, log_attitude_lag
from plantar.sensors.delays.refined_delays import residuals_at
from plantar.sensors.delays.sensor_delay import on_force_cells
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.sensors.tilt_error import NO_TILT_ERROR, TiltError, log_tilt_error
from plantar.signals.gyroscope_delay import GyroscopeDelay, log_gyroscope_delay


@dataclass(frozen=True)
class FirstLook:
    """A checked log, how late its gyroscope and accelerometer are, how far its attitude follows the latter or lags the
    former, and both sides of Newton's law with all sensors read as recorded; None where nobody asks, vertical force
    cells leave nothing to ask, or the gyroscope is likely to be read anew.
    """

    log: MotionLog
    gyroscope: GyroscopeDelay | None
    accelerometer: AccelerometerDelay
    tilt: TiltError
    lag: AttitudeLag
    residuals: list[NewtonEulerResidual] | None

    def forget_residuals(self) -> None:
        """Give back what is larger than the log itself, whoever holds the look: delays are known then."""
        if self.residuals is not None:
            self.residuals.clear()


@contextmanager
def over_logs(logs: Sequence[MotionLog]) -> Iterator[Each]:
    """A map over logs, or over what comes of them, on all cores: by threads where one of them is long."""
    if max(map(len, logs), default=0) <= LONG:
        yield over_cores
        return
    with ThreadPoolExecutor(cpu_count()) as pool:
        yield pool.map


def looked_at(
    robot: RobotModel,
    logs: Iterable[MotionLog],
    timed: bool,
    meanwhile: Callable[[], object] | None = None,
) -> list[FirstLook]:
    """Every log `checked` and looked at, in order: small files on all cores, others read when their turns come.

    timed: whether Newton's law is to tell how late sensors are; meanwhile: called once, while the first is read. Raises
    the error of the first log that has one.
    """
    if isinstance(logs, WaitingLogs) and logs.bounded:

        def read(opened: Callable[[], MotionLog]) -> FirstLook:
            return look_at(robot, timed, checked(robot, opened()))

        return over_cores(read, logs.openers, meanwhile=meanwhile)
    even = checked_in_turn(robot, logs, meanwhile)
    with over_logs(even) as each:
        return list(each(partial(look_at, robot, timed), even))


def look_at(robot: RobotModel, timed: bool, log: MotionLog) -> FirstLook:
    """What one `checked` log tells; `timed` as in `looked_at`."""
    gyroscope = None if robot.imu is None else log_gyroscope_delay(log, robot.imu.name)
    late = gyroscope is not None and gyroscope.shown
    asked: list[Callable[[], Any]] = [
        lambda: _as_recorded(robot, log) if timed and not late else None,
        lambda: (accelerometer_delay(robot, log), _tilt(robot, log), _lag(robot, log)),
    ]
    with ThreadPoolExecutor(len(asked)) as pool:  # of a long log each takes a while
        each = pool.map if len(log) > LONG else map
        residuals, (accelerometer, tilt, lag) = each(lambda ask: ask(), asked)
    if robot.imu is not None:
        log = log.with_columns({}, *orientation_notes(log, robot.imu.name, accelerometer))
    return FirstLook(log, gyroscope, accelerometer, tilt, lag, residuals)


def look_again(robot: RobotModel, timed: bool, look: FirstLook, log: MotionLog) -> FirstLook:
    """What a log tells that is read otherwise now, but for how late its IMU was."""
    return replace(
        look, log=log, tilt=_tilt(robot, log), residuals=_as_recorded(robot, log) if timed else None
    )


def _tilt(robot: RobotModel, log: MotionLog) -> TiltError:
    return log_tilt_error(log, robot.imu) if robot.imu else NO_TILT_ERROR


def _lag(robot: RobotModel, log: MotionLog) -> AttitudeLag:
    return log_attitude_lag(log, robot.imu) if robot.imu else NO_LAG


def _as_recorded(robot: RobotModel, log: MotionLog) -> list[NewtonEulerResidual] | None:
    return None if on_force_cells(robot, [log]) else residuals_at(robot, np.zeros(len(robot.feet) + 1), log)


def checked_in_turn(
    robot: RobotModel, logs: Iterable[MotionLog], meanwhile: Callable[[], object] | None
) -> list[MotionLog]:
    """Every log `checked`, in order; while one is, the next is read, and while the first is, what is to be done
    `meanwhile`. Raises the error of the first that has one."""
    even: list[MotionLog] = []
    pending: Future[MotionLog] | None = None
    with ThreadPoolExecutor(1) as pool:
        if meanwhile is not None:
            pool.submit(meanwhile)
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
