"""Which axes of a force sensor make a foot's torque push back as its sole tilts: a bush does, whoever holds the robot.

Balance tells axes only while nobody pushes. A bush's torque follows the tilt of its foot with a stiffness above zero
all the time; axes turned by half a turn make it negative, by a quarter they tie pitch to roll.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import FORCE, TORQUE, Array, Mask
from plantar.robot_guess.feet import Sole
from plantar.robot_guess.imu import Mount
from plantar.robot_guess.seat import Seat, sensor_pose
from plantar.robot_guess.stance import FEWEST, Stance

FOLLOWS = 0.5  # share of the torque that must follow the tilt before it tells of axes
AS_WELL = 0.5  # of the largest share about either axis: axes with less are not the sensor's


def that_push_back(
    options: Sequence[Mapping[str, Seat]],
    soles: Sequence[Sole],
    stance: Stance,
    mount: Mount | None,
    poses: Mapping[str, Array],
) -> list[Mapping[str, Seat]]:
    """The seats whose torques follow the soles' tilt; all of them where the logs do not tell.

    mount: of the IMU, by which the tilt is seen; poses: of each seat's link in its ankle link, (4, 4).
    """
    if mount is None or stance.felt is None or not options:
        return list(options)
    up = np.einsum("nij,nj->ni", stance.carriers[mount.link][:, :3, :3] @ mount.rotation, stance.felt)
    shares = np.array([_shares(seats, soles, stance, up, poses) for seats in options])
    most = shares.max(axis=0)
    well = (shares > AS_WELL * most) | (most < FOLLOWS)
    return [seats for seats, both in zip(options, well, strict=True) if both.all()] or list(options)


def _shares(
    seats: Mapping[str, Seat], soles: Sequence[Sole], stance: Stance, up: Array, poses: Mapping[str, Array]
) -> Array:
    """Of the torque's squares, within logs, how much a stiffness above zero explains about roll and pitch, all feet
    together, (2,).
    """
    squares = np.zeros((2, 2))
    for sole in soles:
        side = sole.limb.side
        place, turn = sensor_pose(seats[side], poses[side])
        ankle = stance.rotations[side]
        read = seats[side].sign * stance.wrenches[side]
        force, torque = (np.einsum("nij,nj->ni", ankle @ turn, read[:, part]) for part in (FORCE, TORQUE))
        moment = torque + np.cross(ankle @ place, force)
        tilt = np.cross(up, ankle @ sole.upright[:, 2])
        load = np.sum(force * up, axis=1)
        for column in (0, 1):
            along = ankle @ sole.upright[:, column]
            signals = np.column_stack([np.sum(values * along, axis=1) for values in (moment, -tilt)])
            squares[column] += _squares(np.column_stack([signals, load]), stance.loaded[side], stance.logs)
    return np.asarray(1 - squares[:, 1] / np.maximum(squares[:, 0], 1e-300))


def _squares(signals: Array, rows: Mask, logs: NDArray[np.intp]) -> tuple[float, float]:
    """Squares of a moment that its load does not explain, and those left by a stiffness that is not negative.

    signals: (n, 3), moment, tilt and load; logs: (n,), the log of each sample: each has zeros of its own.
    """
    parts = [signals[rows & (logs == log)] for log in np.unique(logs)]
    moving = np.concatenate([part - part.mean(axis=0) for part in parts if len(part)] or [np.zeros((0, 3))])
    if len(moving) < FEWEST:
        return 0.0, 0.0
    load = moving[:, 2]
    clear = moving[:, :2] - np.outer(load, load @ moving[:, :2] / max(float(load @ load), 1e-9))
    moment, tilt = clear.T
    before, power = float(moment @ moment), float(tilt @ tilt)
    stiffness = max(float(moment @ tilt) / power, 0.0) if power > 0 else 0.0
    rest = moment - stiffness * tilt
    return before, float(rest @ rest)
