"""The attitude as a robot's IMU computes it: gyroscope integrated, corrected towards the accelerometer's vertical."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from plantar.conventions import Array

# 1/s: how fast the accelerometer corrects; slower lets the gyroscope's bias through.
CORRECTION_RATE: Final = 0.2
LEARN: Final = 0.01  # 1/s²: how fast the gyroscope's bias is learnt


def filtered_attitude(start: Array, angular_velocity: Array, acceleration: Array, period: float) -> Array:
    """Quaternions w x y z, body to world, (N, 4): a causal complementary filter on SO(3) (after Mahony).

    `start` (4,) is the attitude at the first sample, `angular_velocity` (N, 3) [rad/s] and `acceleration` (N, 3)
    [m/s², proper] are the sensors' own, `period` [s]. Motion that accelerates tilts it, as on a robot.
    """
    w, x, y, z = (float(value) for value in start)
    bias_x = bias_y = bias_z = 0.0
    found = np.empty((len(angular_velocity), 4))
    for row, (rate, proper) in enumerate(zip(angular_velocity.tolist(), acceleration.tolist(), strict=True)):
        found[row] = w, x, y, z
        length = math.sqrt(proper[0] ** 2 + proper[1] ** 2 + proper[2] ** 2) or 1.0
        ax, ay, az = proper[0] / length, proper[1] / length, proper[2] / length
        # the world's up in the body as the filter believes it
        ux, uy, uz = 2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z
        ex, ey, ez = ay * uz - az * uy, az * ux - ax * uz, ax * uy - ay * ux
        bias_x, bias_y, bias_z = (
            b + LEARN * e * period for b, e in zip((bias_x, bias_y, bias_z), (ex, ey, ez), strict=True)
        )
        px = 0.5 * period * (rate[0] + bias_x + CORRECTION_RATE * ex)
        py = 0.5 * period * (rate[1] + bias_y + CORRECTION_RATE * ey)
        pz = 0.5 * period * (rate[2] + bias_z + CORRECTION_RATE * ez)
        w, x, y, z = (
            w - x * px - y * py - z * pz,
            x + w * px + y * pz - z * py,
            y + w * py - x * pz + z * px,
            z + w * pz + x * py - y * px,
        )
        norm = math.sqrt(w * w + x * x + y * y + z * z)
        w, x, y, z = w / norm, x / norm, y / norm, z / norm
    return found
