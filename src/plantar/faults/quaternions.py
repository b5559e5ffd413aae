"""The ways in which the four numbers of a quaternion can be meant."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array
from plantar.notes import Finding


def readings(orientation: Array) -> dict[str, Array]:
    """The orientation (n, 4) w x y z, body to world, as the columns say, and as other conventions would fill them."""
    return {
        "as it is": orientation,
        "read as x y z w": np.roll(orientation, 1, axis=1),
        "inverted": inverse(orientation),
    }


def inverse(orientation: Array) -> Array:
    """The turns back, (n, 4)."""
    return np.asarray(orientation * np.array([1.0, -1.0, -1.0, -1.0]))


def turns_between(before: Array, after: Array) -> Array:
    """Rotation vectors (n, 3) [rad] that turn one orientation (n, 4), of any length > 0, into another, in the body."""
    (w, *_), (end, *_) = before.T, after.T
    start, stop = before[:, 1:], after[:, 1:]
    cosine = w * end + np.einsum("ni,ni->n", start, stop)
    sine = w[:, None] * stop - end[:, None] * start - np.cross(start, stop)
    size = np.linalg.norm(sine, axis=1)
    angle = 2 * np.arctan2(size, np.abs(cosine))  # q and -q are one orientation
    return np.asarray((np.where(cosine < 0, -angle, angle) / np.where(size > 0, size, 1.0))[:, None] * sine)


def misread(name: str, text: str, reading: str, or_else: str = "") -> Finding:
    """What is said of an IMU whose quaternions agree only in another reading, `or_else` with something beside it."""
    valid = "w x y z" if reading == "read as x y z w" else "body to world"
    return Finding(
        "quaternion_order",
        f"columns 'imu.{name}.orientation.*': {text}; {reading} it agrees{or_else} (valid: {valid})",
        True,
    )
