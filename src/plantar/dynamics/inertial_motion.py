"""A log's motion from IMU and joint positions alone: nothing else enters, so nothing else can delay it.

Of an IMU without an accelerometer, soles that stand say how it accelerates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pinocchio as pin

from plantar.contact.standing_imu import StandingImu
from plantar.conventions import Array
from plantar.dynamics.base_motion import root_motion
from plantar.dynamics.equation import Equation
from plantar.dynamics.motion import Motion
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import shifted


@dataclass(frozen=True)
class InertialSignals:
    """Joint `positions` (n, joints), the IMU's angular velocity `rate` [rad/s] and `proper` acceleration (n, 3), all
    of them filtered without lag.

    `by_encoders` (n, 3): how an acceleration that comes from encoders changes with the moment at which these are read
    [m/s³], and `by_turn` (3, n, 3) with a turn of the IMU about its axes [m/s² per rad]; None of an accelerometer.
    """

    positions: Array
    rate: Array
    proper: Array
    period: float
    by_encoders: Array | None = None
    by_turn: Array | None = None

    def during(self, run: slice) -> InertialSignals:
        """The signals of some consecutive samples alone."""
        slopes = None if self.by_encoders is None else self.by_encoders[run]
        turns = None if self.by_turn is None else self.by_turn[:, run]
        return InertialSignals(
            self.positions[run], self.rate[run], self.proper[run], self.period, slopes, turns
        )

    @cached_property
    def joints(self) -> tuple[Array, Array, Array]:
        """Positions, velocities and accelerations of the joints; velocities and accelerations are differences."""
        velocities = differentiate(self.positions, self.period)
        return self.positions, velocities, differentiate(velocities, self.period)

    @cached_property
    def turning(self) -> tuple[Array, Array]:
        """The IMU's angular velocity and acceleration."""
        return self.rate, differentiate(self.rate, self.period)


def inertial_signals(robot: RobotModel, log: MotionLog, cutoff: float) -> InertialSignals:
    """What `inertial_motion` needs of a log, filtered at `cutoff` [Hz].

    Raises RobotError without an IMU, LogError where a log has no angular velocity, or neither acceleration nor
    orientation.
    """
    imu = robot.required_imu.name
    positions = low_pass(log.positions(robot), log.period, cutoff)
    rate = low_pass(log.angular_velocity(imu), log.period, cutoff)
    stood = None if log.has_imu(imu, "linear_acceleration") else StandingImu.of(robot, log)
    if stood is None:
        proper = low_pass(log.linear_acceleration(imu), log.period, cutoff)
        return InertialSignals(positions, rate, proper, log.period)
    stacked = low_pass(np.hstack([*stood.along_encoders, *stood.by_turn]), log.period, cutoff)
    proper, slopes, *turns = np.split(stacked, 5, axis=1)
    return InertialSignals(positions, rate, proper, log.period, slopes, np.array(turns))


def inertial_motion(
    robot: RobotModel,
    equation: Equation,
    signals: InertialSignals,
    kept: slice,
    encoders_late: float = 0.0,
    gyroscope_late: float = 0.0,
    bends: Array | None = None,
) -> Motion:
    """Motion of root and joints at the samples `kept`; equation: of the robot's floating model.

    encoders_late, gyroscope_late: by which these report late [s]; bends: how far joints are beyond their encoders, with
    both derivatives, (3, n, joints).
    """
    joints = _joint_motion(signals, kept, encoders_late)
    if bends is not None:
        joints = (joints[0] + bends[0], joints[1] + bends[1], joints[2] + bends[2])
    measured = _measured(signals, kept, gyroscope_late)
    if signals.by_encoders is not None:
        measured[:, :3] += encoders_late * signals.by_encoders[kept]
    return Motion(root_motion(equation, *_imu(robot), measured, *joints), *joints)


def turned_motions(
    robot: RobotModel, equation: Equation, signals: InertialSignals, kept: slice, turns: Sequence[Array]
) -> list[Motion]:
    """`inertial_motion` for each of `turns`: rotations (3, 3) of the IMU from where the robot file has it."""
    joints, measured = _joint_motion(signals, kept), _measured(signals, kept)
    link, placement = _imu(robot)
    motions = []
    for turn in turns:
        turned = pin.SE3(placement.rotation @ turn, placement.translation)
        reads = measured.copy()
        if signals.by_turn is not None:
            reads[:, :3] += np.tensordot(pin.log3(turn), signals.by_turn[:, kept], 1)
        motions.append(Motion(root_motion(equation, link, turned, reads, *joints), *joints))
    return motions


def _joint_motion(signals: InertialSignals, kept: slice, late: float = 0.0) -> tuple[Array, Array, Array]:
    """Positions, velocities and accelerations at the samples `kept`, of encoders that report `late` [s]."""
    positions, velocities, accelerations = (
        shifted(values, signals.period, late, kept) for values in signals.joints
    )
    return positions, velocities, accelerations


def _imu(robot: RobotModel) -> tuple[int, pin.SE3]:
    """The link that carries the IMU, and where."""
    return robot.frame(robot.required_imu.placement)


def _measured(signals: InertialSignals, kept: slice, late: float = 0.0) -> Array:
    """The IMU's own motion (n, 9), as in `Motion.base`, of a gyroscope that reports `late` [s]."""
    turning = (shifted(values, signals.period, late, kept) for values in signals.turning)
    return np.hstack([signals.proper[kept], *turning])
