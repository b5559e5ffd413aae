"""Units, frames, signs and orders: the one place that fixes them.

Units are SI (m, kg, s, rad, N, N·m). Quaternions are w x y z, body to world, with the world's z up.
A wrench is force then torque, of the environment on the robot, so a standing robot reads force.z > 0.

The bush is a series of z slide, pitch and roll between ankle and sole:
`R_ankle_sole = Ry(pitch) Rx(roll)`. Its model, with K, C > 0 for every axis, is

    torque = K·deflection + C·rate + offset            (pitch, roll)
    force.z = K_z·z + C_z·ż + offset                   (z > 0: compressed)
"""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Axis = Literal["pitch", "roll", "z"]

YEAR: Final = 365.25  # days
MONTH: Final = YEAR / 12
GRAVITY: Final = 9.80665  # m/s², standard gravity
NORMAL95: Final = 1.96  # deviations that a 95 % interval of a normal value reaches
UNIFORM: Final = 3**-0.5  # of its bounds: the deviation of what lies anywhere within (GUM, type B)
SHOWN: Final = 3.0  # standard deviations from which what logs show is put right, or said
ROUNDING: Final = 1e-12  # of a value, or of its square: what arithmetic leaves of it
SURE: Final = 5.0  # standard deviations from which what logs show is beyond doubt
ROTATIONAL_AXES: Final[tuple[Axis, Axis]] = ("pitch", "roll")
AXES: Final[tuple[Axis, Axis, Axis]] = ("pitch", "roll", "z")

FORCE: Final = slice(0, 3)
TORQUE: Final = slice(3, 6)
WRENCH_AXES: Final = ("force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z")

# One link's inertial parameters in Pinocchio's order, the inertia about the joint frame's origin.
INERTIAL_NAMES: Final = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz")
INERTIAL_UNITS: Final = ("kg",) + ("kg.m",) * 3 + ("kg.m2",) * 6

STIFFNESS_UNIT: Final = {"pitch": "N.m/rad", "roll": "N.m/rad", "z": "N/m"}
DAMPING_UNIT: Final = {"pitch": "N.m.s/rad", "roll": "N.m.s/rad", "z": "N.s/m"}
OFFSET_UNIT: Final = {"pitch": "N.m", "roll": "N.m", "z": "N"}


def skew(vector: Array) -> Array:
    """Cross-product matrix: `skew(a) @ b == a × b`, (..., 3) -> (..., 3, 3)."""
    x, y, z = np.moveaxis(np.asarray(vector, dtype=float), -1, 0)
    zero = np.zeros_like(x)
    rows = [np.stack(row, axis=-1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))]
    return np.stack(rows, axis=-2)


def cross(one: Array, other: Array) -> Array:
    """Products one × other of vectors (..., 3): as NumPy's, which takes twice as long for those of a log."""
    product = np.empty(np.broadcast_shapes(one.shape, other.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        product[..., i] = one[..., j] * other[..., k] - one[..., k] * other[..., j]
    return product


def rotation_from_rpy(rpy: Array) -> Array:
    """URDF's fixed-axis roll-pitch-yaw [rad] to a rotation matrix: Rz(yaw) Ry(pitch) Rx(roll)."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(rpy), np.cos(rpy)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rotated(orientation: Array, vectors: Array) -> Array:
    """Vectors (N, 3) in the axes that unit quaternions w x y z (N, 4) take theirs to."""
    axis = orientation[:, 1:]
    half = cross(axis, vectors)
    return np.asarray(vectors + 2 * (orientation[:, :1] * half + cross(axis, half)))


def rotation_from_quaternion(quaternion: Array) -> Array:
    """Quaternions w x y z, (N, 4), of any length > 0, to rotation matrices body to world, (N, 3, 3)."""
    w, x, y, z = np.moveaxis(quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True), -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    rotation = np.empty((*np.shape(w), 3, 3))
    for i, row in enumerate(rows):
        for j, entry in enumerate(row):
            rotation[..., i, j] = entry
    return rotation
