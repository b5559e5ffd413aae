"""The root frame's motion from an IMU anywhere on the robot, moved through the encoders.

With R, p, ω_r, α_r, v_r, a_r the pose and motion of the IMU's link relative to the root link, in root axes, and ω, α,
A those of the root frame itself (A: proper acceleration of its origin):

    ω_imu = ω + ω_r,   α_imu = α + α_r + ω × ω_r,
    A_imu = A + α × p + ω × (ω × p) + 2 ω × v_r + a_r

Attitude never enters.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY, Array, cross
from plantar.robot.kinematics import KinematicTree, rotations_about


@dataclass(frozen=True)
class RelativeMotion:
    """A frame seen from the root link, in root axes: rotation (N, 3, 3), the others (N, 3); SI units."""

    rotation: Array
    position: Array
    angular_velocity: Array
    angular_acceleration: Array
    velocity: Array
    acceleration: Array


def relative_motion(
    tree: KinematicTree, joint: int, placement: pin.SE3, q: Array, v: Array, a: Array
) -> RelativeMotion:
    """Pose and motion of a frame relative to the root link.

    joint: index of the joint that carries the frame, -1 for the root link; placement: in that joint's frame;
    q, v, a: of all joints, (N, n_joints).
    """
    samples = len(q)
    rotation = np.tile(np.eye(3), (samples, 1, 1))
    position, omega, alpha, velocity, acceleration = (np.zeros((samples, 3)) for _ in range(5))

    def carried(arm: Array) -> None:
        nonlocal position, velocity, acceleration
        spin = cross(omega, arm)
        position = position + arm
        velocity = velocity + spin
        acceleration = acceleration + cross(alpha, arm) + cross(omega, spin)

    for index in reversed(tree.ancestors[joint]) if joint >= 0 else ():
        carried(rotation @ tree.translations[index])
        rotation = rotation @ tree.rotations[index]
        axis = rotation @ tree.axes[index]
        angle, rate, second = (values[:, index : index + 1] for values in (q, v, a))
        turning = cross(omega, axis) * rate
        if tree.slides[index]:
            carried(angle * axis)
            velocity = velocity + rate * axis
            acceleration = acceleration + second * axis + 2 * turning
        else:
            alpha = alpha + second * axis + turning
            omega = omega + rate * axis
            rotation = rotation @ rotations_about(tree.axes[index], angle[:, 0])
    carried(rotation @ placement.translation)
    return RelativeMotion(rotation @ placement.rotation, position, omega, alpha, velocity, acceleration)


def root_motion(relative: RelativeMotion, acceleration: Array, rate: Array, rate_slope: Array) -> Array:
    """The root frame's motion (N, 9), as in `Motion.base`.

    acceleration: proper, of the IMU; rate, rate_slope: its angular velocity and acceleration; all in the IMU's own
    axes, (N, 3).
    """
    measured, spin, turning = (
        np.einsum("nij,nj->ni", relative.rotation, values) for values in (acceleration, rate, rate_slope)
    )
    omega = spin - relative.angular_velocity
    alpha = turning - relative.angular_acceleration - cross(omega, relative.angular_velocity)
    origin = (
        measured
        - cross(alpha, relative.position)
        - cross(omega, cross(omega, relative.position))
        - 2 * cross(omega, relative.velocity)
        - relative.acceleration
    )
    return np.hstack([origin, omega, alpha])


def root_motion_from_sole(relative: RelativeMotion) -> Array:
    """The root frame's motion (N, 9) where a level sole stands still (Iwasaki 2012): its frame is an IMU at rest."""
    still = np.zeros_like(relative.position)
    up = still.copy()
    up[:, 2] = GRAVITY
    return root_motion(relative, up, still, still)
