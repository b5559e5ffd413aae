"""The motion that eq. 1 is written for: of the root frame, and of every joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.errors import DataError
from plantar.robot.kinematics import KinematicTree


@dataclass(frozen=True)
class Motion:
    """N samples of a robot in motion.

    base: (N, 9), the root frame's proper acceleration (+9.81 up at rest) [m/s²], angular velocity [rad/s] and
    angular acceleration [rad/s²], each in the root frame's own axes: neither attitude nor position enters the
    dynamics; positions, velocities, accelerations: of the joints, (N, n_joints) [rad or m, and per second].
    """

    base: Array
    positions: Array
    velocities: Array
    accelerations: Array

    def __len__(self) -> int:
        return len(self.base)

    def select(self, rows: slice | np.ndarray) -> Motion:
        """The same motion with only some of its samples."""
        return Motion(self.base[rows], self.positions[rows], self.velocities[rows], self.accelerations[rows])

    @property
    def finite(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Samples in which nothing is NaN or infinite, (N,)."""
        parts = (self.base, self.positions, self.velocities, self.accelerations)
        return np.asarray(np.logical_and.reduce([np.isfinite(part).all(axis=1) for part in parts]))


def pinocchio_motion(model: pin.Model, tree: KinematicTree, q: Array, v: Array, a: Array) -> Motion:
    """Samples in Pinocchio's conventions as a `Motion`, under the model's own gravity.

    Args:
        model: the robot.
        tree: of its joints, such as `dynamics.Equation(model).tree`.
        q: (N, nq) positions [m, rad].
        v: (N, nv) velocities.
        a: (N, nv) accelerations.

    Returns:
        The motion of root and joints that `Equation` takes.

    Raises:
        DataError: a shape is wrong, or a value is not finite.

    Example:
        >>> import numpy as np, pinocchio as pin
        >>> from plantar import dynamics
        >>> model = pin.buildSampleModelManipulator()
        >>> zero = np.zeros((5, model.nv))
        >>> len(dynamics.pinocchio_motion(model, dynamics.Equation(model).tree, zero, zero, zero))
        5
    """
    arrays = {"q": q, "v": v, "a": a}
    for name, width in (("q", model.nq), ("v", model.nv), ("a", model.nv)):
        array = arrays[name] = np.asarray(arrays[name], dtype=np.float64)
        if array.ndim != 2 or array.shape != (len(arrays["q"]), width):
            raise DataError(f"{name}: an array of shape {array.shape} (valid: ({len(arrays['q'])}, {width}))")
        if not np.isfinite(array.sum()) and not np.isfinite(array).all():
            sample, column = np.argwhere(~np.isfinite(array))[0]
            value = array[sample, column]
            raise DataError(f"{name}: sample {sample}, column {column} is {value} (valid: finite numbers)")
    q, v, a = arrays["q"], arrays["v"], arrays["a"]
    base = np.zeros((len(q), 9))
    gravity = np.asarray(model.gravity.linear)
    if tree.floating:
        carried = v[:, (4, 5, 3)] * v[:, (2, 0, 1)] - v[:, (5, 3, 4)] * v[:, (1, 2, 0)]  # omega x velocity
        base[:, 0:3] = a[:, 0:3] + carried - _seen_from_body(gravity, q[:, 3:7])
        base[:, 3:6] = v[:, 3:6]
        base[:, 6:9] = a[:, 3:6]
        v, a = v[:, 6:], a[:, 6:]
    else:
        base[:, 0:3] = -gravity
    return Motion(base, tree.joint_positions(q), v, a)


def _seen_from_body(vector: Array, quaternion: Array) -> Array:
    """A world vector (3,) in the axes of bodies with orientations x y z w, (N, 4), of any length > 0."""
    u, w = quaternion[:, :3], quaternion[:, 3:]
    square = np.einsum("ij,ij->i", u, u)[:, None]
    twice = 2 / (square + w * w)
    turned = w * (u @ pin.skew(vector).T) + u * (u @ vector)[:, None]
    return np.asarray((1 - twice * square) * vector + twice * turned)
