"""By how much zeros of encoders, the IMU's mount and the bushes' places change the height between two soles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from plantar.contact.deflection import FootPath, foot_motion, path_to
from plantar.contact.imu_turn import turned
from plantar.conventions import Array, Mask
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.signals.orientation import attitude

RATE = 20.0  # Hz, at which heights are computed: a standing robot moves below 2 Hz
STEP = 1e-3  # rad or m, of the differences that stand for derivatives


def height_changes(log: MotionLog, robot: RobotModel, rows: Mask | slice) -> Iterator[tuple[str, Array]]:
    """Each cause and its change (n,) [m] of the right sole's height over the left one's, at one deviation of the cause,
    at the n samples `rows` (N,).

    Deviations are the robot file's: of each joint's zero between IMU and feet, of the IMU's mount about its three axes,
    and of each bush's place in its two horizontal directions, about which a sole that leans rises and falls.
    """
    known, stride = robot.uncertainty, max(1, round(1 / (RATE * log.period)))
    orientation, _ = attitude(log, robot.required_imu, [])
    positions, measured = np.asfortranarray(log.positions(robot)[::stride]), orientation[::stride]
    still = np.zeros_like(positions), np.zeros((len(positions), 3))
    last = len(positions) - 1
    place = np.interp(log.time[rows], log.time[::stride], np.arange(len(positions)))
    before = place.astype(np.intp)
    behind, share = np.minimum(before + 1, last), place - before

    def sole(path: FootPath, quaternions: Array = measured) -> Array:
        return foot_motion(path, positions, still[0], quaternions, still[1]).sole_position[:, 2]

    def change(by: Array | float, deviation: float) -> Array:
        # Known samples stand beside holes in this coarse grid, which must not reach them.
        by = np.nan_to_num(by * (deviation / STEP)) + np.zeros(len(positions))
        return np.asarray(by[before] + share * (by[behind] - by[before]))

    paths = {name: path_to(robot, name)[0] for name in robot.feet}
    sides = dict(zip(robot.feet, (-1.0, 1.0), strict=True))
    lies = {name: sole(path) for name, path in paths.items()}
    for column, joint in enumerate(robot.joint_names):
        if joint not in robot.path_joints or not known.encoder_zero:
            continue
        read = positions[:, column].copy()
        positions[:, column] += STEP
        by = sum(
            sides[name] * (sole(path) - lies[name]) for name, path in paths.items() if column in path.joints
        )
        positions[:, column] = read
        yield joint, change(by, known.encoder_zero)
    for axis in range(3 if known.imu_mount else 0):
        leant = turned(measured, STEP * np.eye(3)[axis])
        by = sum(sides[name] * (sole(path, leant) - lies[name]) for name, path in paths.items())
        yield f"imu {'xyz'[axis]}", change(by, known.imu_mount)
    for name, foot in robot.feet.items():
        for axis in range(2 if known.bush_position else 0):
            bush = replace(foot.bush, xyz=foot.bush.xyz + STEP * foot.bush.rotation[:, axis])
            by = sides[name] * (sole(path_to(robot, name, bush)[0]) - lies[name])
            yield f"{name} {'xyz'[axis]}", change(by, known.bush_position)
