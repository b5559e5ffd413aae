"""The root link's motion from an IMU anywhere on the robot, moved through the encoders."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.dynamics.motion import Motion
from plantar.errors import RobotError, located
from plantar.kinematics import KinematicTree
from plantar.log import MotionLog
from plantar.robot import RobotModel
from plantar.signals import differentiate, low_pass


def inertial_motion(robot: RobotModel, log: MotionLog, cutoff: float) -> Motion:
    """Motion of root and joints from proper acceleration, angular velocity and joint positions alone.

    Everything is filtered at `cutoff` [Hz] without lag; velocities and accelerations are differences of the filtered
    positions. With p, R the IMU in the root frame,

        ω = R ω_imu - ω_rel,    a = R a_imu - (ω̇ × p + ω × (ω × p) + 2 ω × ṗ + p̈).

    Raises RobotError without an IMU, LogError where its columns are missing.
    """
    if robot.imu is None:
        raise RobotError(located("names no imu", path=robot.path, valid="imu: {name: ..., link: ...}"))
    period = log.period
    positions = low_pass(log.positions(robot), period, cutoff)
    velocities = differentiate(positions, period)
    accelerations = differentiate(velocities, period)
    gyroscope = low_pass(log.angular_velocity(robot.imu.name), period, cutoff)
    proper = low_pass(log.linear_acceleration(robot.imu.name), period, cutoff)
    rotation, place, turning = _imu_in_root(robot, positions, velocities)
    angular = np.einsum("nij,nj->ni", rotation, gyroscope) - turning
    angular_acceleration = differentiate(angular, period)
    sliding = differentiate(place, period)
    apparent = (
        np.cross(angular_acceleration, place)
        + np.cross(angular, np.cross(angular, place) + 2 * sliding)
        + differentiate(sliding, period)
    )
    base = np.hstack([np.einsum("nij,nj->ni", rotation, proper) - apparent, angular, angular_acceleration])
    return Motion(base, positions, velocities, accelerations)


def _imu_in_root(robot: RobotModel, positions: Array, velocities: Array) -> tuple[Array, Array, Array]:
    """Rotation (N, 3, 3), origin (N, 3) and angular velocity (N, 3) of the IMU in the root link's frame."""
    assert robot.imu is not None
    tree = KinematicTree.from_model(robot.model)
    carrier, placement = robot.frame(robot.imu.placement)
    samples = len(positions)
    rotation = np.broadcast_to(np.eye(3), (samples, 3, 3))
    place, turning = np.zeros((samples, 3)), np.zeros((samples, 3))
    for joint, _ in tree.path(-1, carrier - 1):
        place = place + rotation @ tree.translations[joint]
        rotation = rotation @ tree.rotations[joint]
        axis = tree.axes[joint]
        if tree.slides[joint]:
            place = place + np.einsum("nij,j->ni", rotation, axis) * positions[:, joint, None]
        else:
            turning = turning + np.einsum("nij,j->ni", rotation, axis) * velocities[:, joint, None]
            rotation = rotation @ _turned(axis, positions[:, joint])
    fixed: pin.SE3 = placement
    return rotation @ fixed.rotation, place + rotation @ fixed.translation, turning


def _turned(axis: Array, angle: Array) -> Array:
    """Rotations by `angle` (N,) about a unit axis (3,): Rodrigues' formula, (N, 3, 3)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, rest = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    return np.asarray(np.eye(3) + sine * cross + rest * (cross @ cross))
