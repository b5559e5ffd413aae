"""The direction of gravity where the log holds none: gyroscope and accelerometer, blended without lag."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from plantar.conventions import Array
from plantar.signals.filters import low_pass

BLEND_FREQUENCY = 0.03  # Hz: below it the accelerometer tells where up is, above it the gyroscope


def attitude_from_inertial(angular_velocity: Array, acceleration: Array, period: float) -> Array:
    """Quaternions w x y z, body to world, (N, 4), from rates [rad/s] and proper acceleration [m/s²], both (N, 3).

    The gyroscope is integrated to a frame that drifts slowly; in that frame the accelerometer's mean points up, and a
    zero-phase low-pass follows the drift. Yaw starts at 0 and drifts: nothing here may depend on it.
    """
    # Between two samples the body turns at their mean rate; the earlier one alone would lag by half a period.
    between = (angular_velocity[:-1] + angular_velocity[1:]) / 2
    body = _accumulated(Rotation.from_rotvec(between * period)) if len(between) else Rotation.identity(1)
    drifting = np.asarray(body.apply(np.array(acceleration)))
    if len(acceleration) * period > 2 / BLEND_FREQUENCY:
        up = _slow_part(drifting, period)
    else:
        up = np.broadcast_to(drifting.mean(axis=0), drifting.shape)
    up = up / np.linalg.norm(up, axis=1, keepdims=True)
    return np.asarray((_onto_vertical(up) * body).as_quat(scalar_first=True))


def _slow_part(values: Array, period: float) -> Array:
    """What of `values` (N, k) is slower than the blend: a straight line and the low-passed rest, mirrored at both ends.

    Without line and mirror, a single sample's acceleration would decide the ends.
    """
    time = np.linspace(-1.0, 1.0, len(values))[:, None]
    line = values.mean(axis=0) + time * (time * values).sum(axis=0) / (time**2).sum()
    rest = values - line
    mirrored = np.concatenate([rest[::-1], rest, rest[::-1]])
    return np.asarray(line + low_pass(mirrored, period, BLEND_FREQUENCY)[len(values) : 2 * len(values)])


def _accumulated(increments: Rotation) -> Rotation:
    """Orientation at each sample, starting from identity: products of all earlier increments, by doubling."""
    quaternion = Rotation.concatenate([Rotation.identity(), increments]).as_quat()
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
