"""What an IMU that is turned in its mount does to the bushes' angles.

While nothing between IMU and ankle moves, a turned mount is a constant angle, which the offset takes up. Where hips and
waist move, it is not: of an IMU turned by ε the angles are off by ε as the ankle sees it then.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from plantar.contact.deflection import FootMotion
from plantar.conventions import Array, cross
from plantar.signals.segments import complete


def imu_turn_effects(motions: Mapping[str, FootMotion]) -> dict[str, Array]:
    """Change of each foot's pitch and roll with a turn of the IMU about its own x, y and z, (N, 2, 3) [rad/rad]: known
    throughout, a filter must not lose more samples than the angles do. Zero of a motion that is nowhere known."""
    found = {}
    for name, motion in motions.items():
        effects = motion.imu_turn.reshape(-1, 6)
        known = complete(effects)
        if not known.any():
            effects = np.zeros_like(effects)
        elif not known.all():
            every = np.arange(len(known))
            bridged = [np.interp(every, every[known], effect) for effect in effects[known].T]
            effects = np.column_stack(bridged)
        found[name] = effects.reshape(-1, 2, 3)
    return found


def turned(orientation: Array, turn: Array) -> Array:
    """Orientations w x y z (N, 4) of an IMU that is turned by a small `turn` (3,) [rad] about its own axes."""
    w, vector, half = orientation[:, :1], orientation[:, 1:], turn / 2
    return np.hstack([w - vector @ half[:, None], vector + w * half + cross(vector, half)])
