"""Rigid transforms (4, 4) for moving parts of a model from one link to another."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array, rotation_from_rpy


def pose(xyz: Array, rpy: Array | None = None, rotation: Array | None = None) -> Array:
    """A transform from a translation and fixed-axis roll-pitch-yaw, or a rotation matrix."""
    transform = np.eye(4)
    transform[:3, :3] = (
        rotation if rotation is not None else rotation_from_rpy(np.zeros(3) if rpy is None else rpy)
    )
    transform[:3, 3] = xyz
    return transform


def inverse(transform: Array) -> Array:
    """The inverse of a rigid transform."""
    back = np.eye(4)
    back[:3, :3] = transform[:3, :3].T
    back[:3, 3] = -transform[:3, :3].T @ transform[:3, 3]
    return back


def rpy_of(transform: Array) -> Array:
    """Fixed-axis roll-pitch-yaw of a transform, (3,) [rad]; at pitch ±90° the yaw is put to 0."""
    r = transform[:3, :3]
    pitch = np.arctan2(-r[2, 0], np.hypot(r[0, 0], r[1, 0]))
    if np.hypot(r[0, 0], r[1, 0]) < 1e-9:
        return np.array([np.arctan2(r[0, 1], r[1, 1]) * np.sign(pitch), pitch, 0.0])
    return np.array([np.arctan2(r[2, 1], r[2, 2]), pitch, np.arctan2(r[1, 0], r[0, 0])])
