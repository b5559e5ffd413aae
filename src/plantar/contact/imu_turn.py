"""What an IMU that is turned in its mount does to the bushes' angles.

While nothing between IMU and ankle moves, a turned mount is a constant angle, which the offset takes up. Where hips and
waist move, it is not: of an IMU turned by ε the angles are off by ε as the ankle sees it then.
"""

from __future__ import annotations

import numpy as np

from plantar.contact.deflection import foot_motion, path_to
from plantar.conventions import Array, cross
from plantar.robot.model import RobotModel

RATE = 50.0  # Hz, at which effects are computed: they follow hips and waist, not the feet
STEP = 1e-3  # rad: angles of a mount act as their first order up to some degrees


def imu_turn_effects(
    robot: RobotModel, positions: Array, orientation: Array, period: float
) -> dict[str, Array]:
    """Change of each foot's pitch and roll with a turn of the IMU about its own x, y and z, (N, 2, 3) [rad/rad].

    positions: (N, n_joints) [rad or m]; orientation: w x y z, IMU to world, (N, 4), a sample each `period` [s]. None of
    a robot without IMU.
    """
    if robot.imu is None:
        return {}
    every = np.arange(len(positions))
    places = every[:: max(1, round(1 / (RATE * period)))]
    ways = [np.zeros(3), *STEP * np.eye(3)]
    attitudes = np.vstack([turned(orientation[places], way) for way in ways])
    angles = np.tile(positions[places], (len(ways), 1))
    still = np.zeros_like(angles), np.zeros((len(angles), 3))
    found = {}
    for name in robot.feet:
        path = path_to(robot, name)[0]
        read, *moved = np.split(
            foot_motion(path, angles, still[0], attitudes, still[1]).deflection, len(ways)
        )
        changes = np.stack([(one - read) / STEP for one in moved], axis=2).reshape(len(places), -1)
        # A hole in the attitude must not spread to the samples beside it.
        known = np.isfinite(changes).all(axis=1)
        if not known.any():
            changes, known = np.zeros_like(changes), ~known
        found[name] = np.column_stack(
            [np.interp(every, places[known], change) for change in changes[known].T]
        ).reshape(-1, *moved[0].shape[1:], len(moved))
    return found


def turned(orientation: Array, turn: Array) -> Array:
    """Orientations w x y z (N, 4) of an IMU that is turned by a small `turn` (3,) [rad] about its own axes."""
    w, vector, half = orientation[:, :1], orientation[:, 1:], turn / 2
    return np.hstack([w - vector @ half[:, None], vector + w * half + cross(vector, half)])
