"""The direction of gravity where the log holds none: gyroscope and accelerometer, blended without lag."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from plantar.conventions import Array
from plantar.signals import low_pass

BLEND_FREQUENCY = 0.03  # Hz: below it the accelerometer tells where up is, above it the gyroscope


def attitude_from_inertial(angular_velocity: Array, acceleration: Array, period: float) -> Array:
    """Quaternions w x y z, body to world, (N, 4), from rates [rad/s] and proper acceleration [m/s²], both (N, 3).

    The gyroscope is integrated to a frame that drifts slowly; in that frame the accelerometer's mean points up, and a
    zero-phase low-pass follows the drift. Yaw starts at 0 and drifts: nothing here may depend on it.
    """
    increments = Rotation.from_rotvec(angular_velocity * period)
    body = _accumulated(increments)
    drifting = body.apply(acceleration)
    if len(acceleration) * period > 2 / BLEND_FREQUENCY:
        up = low_pass(drifting, period, BLEND_FREQUENCY)
    else:
        up = np.broadcast_to(drifting.mean(axis=0), drifting.shape)
    up = up / np.linalg.norm(up, axis=1, keepdims=True)
    return np.asarray((_onto_vertical(up) * body).as_quat(scalar_first=True))


def _accumulated(increments: Rotation) -> Rotation:
    """Orientation at each sample, starting from identity: products of all earlier increments, by doubling."""
    total = Rotation.concatenate([Rotation.identity(), increments[:-1]]) if len(increments) > 1 else increments
    quaternion = total.as_quat()
    step = 1
    while step < len(quaternion):
        head = Rotation.from_quat(quaternion[:-step]) * Rotation.from_quat(quaternion[step:])
        quaternion = np.vstack([quaternion[:step], head.as_quat()])
        step *= 2
    return Rotation.from_quat(quaternion)


def _onto_vertical(up: Array) -> Rotation:
    """The shortest rotations that turn unit vectors `up` (N, 3) onto the world's z axis."""
    axis = np.column_stack([up[:, 1], -up[:, 0], np.zeros(len(up))])
    sine = np.linalg.norm(axis, axis=1, keepdims=True)
    angle = np.arctan2(sine, up[:, 2:])
    unit = np.where(sine > 1e-12, axis / np.maximum(sine, 1e-12), [[1.0, 0.0, 0.0]])
    return Rotation.from_rotvec(unit * angle)
