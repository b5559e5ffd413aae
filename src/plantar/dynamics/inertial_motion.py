"""A log's motion from IMU and joint positions alone: nothing else enters, so nothing else can delay it."""

from __future__ import annotations

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


def inertial_motion(
    robot: RobotModel,
    log: MotionLog,
    cutoff: float,
    late: float = 0.0,
    kept: slice = slice(None),
    turned: Array | None = None,
) -> Motion:
    """Motion of root and joints from proper acceleration, angular velocity and joint positions.

    Of all samples or of those `kept`. Everything is filtered at `cutoff` [Hz] without lag; velocities and
    accelerations are differences of the filtered positions, which the encoders report `late` by so much [s]. The IMU
    stands `turned` (3, 3) from where the robot file has it. Raises RobotError without an IMU, LogError where its
    columns are missing.
    """
    if robot.imu is None:
        raise RobotError(located("names no imu", path=robot.path, valid="imu: {name: ..., link: ...}"))
    period = log.period
    positions = shifted(low_pass(log.positions(robot), period, cutoff), period, late)
    velocities = differentiate(positions, period)
    accelerations = differentiate(velocities, period)
    rate = low_pass(log.angular_velocity(robot.imu.name), period, cutoff)
    proper = low_pass(log.linear_acceleration(robot.imu.name), period, cutoff)
    carrier, placement = robot.frame(robot.imu.placement)
    if turned is not None:
        placement = placement * pin.SE3(turned, np.zeros(3))
    tree = KinematicTree.from_model(robot.model)
    moving = tuple(values[kept] for values in (positions, velocities, accelerations))
    relative = relative_motion(tree, carrier - 1, placement, *moving)
    base = root_motion(relative, proper[kept], rate[kept], differentiate(rate, period)[kept])
    return Motion(base, *moving)
