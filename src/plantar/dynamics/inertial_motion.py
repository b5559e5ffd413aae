"""A log's motion from IMU and joint positions alone: nothing else enters, so nothing else can delay it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.dynamics.base_motion import relative_motion, root_motion
from plantar.dynamics.motion import Motion
from plantar.errors import RobotError, located
from plantar.logs.motion_log import MotionLog
from plantar.robot.kinematics import KinematicTree
from plantar.robot.model import RobotModel
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import shifted


class InertialSignals(NamedTuple):
    """Joint `positions` (n, joints), the IMU's angular velocity `rate` [rad/s] and `proper` acceleration (n, 3), all
    of them filtered without lag.
    """

    positions: Array
    rate: Array
    proper: Array
    period: float


def inertial_signals(robot: RobotModel, log: MotionLog, cutoff: float) -> InertialSignals:
    """What `inertial_motion` needs of a log, filtered at `cutoff` [Hz].

    Raises RobotError without an IMU, LogError where its columns are missing.
    """
    if robot.imu is None:
        raise RobotError(located("names no imu", path=robot.path, valid="imu: {name: ..., link: ...}"))
    positions = low_pass(log.positions(robot), log.period, cutoff)
    rate = low_pass(log.angular_velocity(robot.imu.name), log.period, cutoff)
    proper = low_pass(log.linear_acceleration(robot.imu.name), log.period, cutoff)
    return InertialSignals(positions, rate, proper, log.period)


def inertial_motion(
    robot: RobotModel,
    signals: InertialSignals,
    kept: slice = slice(None),
    encoders_late: float = 0.0,
    gyroscope_late: float = 0.0,
    turned: Array | None = None,
) -> Motion:
    """Motion of root and joints at the samples `kept`; velocities and accelerations are differences of positions.

    encoders_late, gyroscope_late: by which these report late [s]; turned: (3, 3), how the IMU stands from where the
    robot file has it.
    """
    assert robot.imu is not None
    period = signals.period
    positions = shifted(signals.positions, period, encoders_late) if encoders_late else signals.positions
    rate = shifted(signals.rate, period, gyroscope_late) if gyroscope_late else signals.rate
    velocities = differentiate(positions, period)
    accelerations = differentiate(velocities, period)
    carrier, placement = robot.frame(robot.imu.placement)
    if turned is not None:
        placement = placement * pin.SE3(turned, np.zeros(3))
    tree = KinematicTree.from_model(robot.model)
    moving = tuple(values[kept] for values in (positions, velocities, accelerations))
    relative = relative_motion(tree, carrier - 1, placement, *moving)
    base = root_motion(relative, signals.proper[kept], rate[kept], differentiate(rate, period)[kept])
    return Motion(base, *moving)
