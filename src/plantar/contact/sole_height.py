"""By how much zeros of encoders, the IMU's mount and the bushes' places change the height between two soles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from plantar.contact.deflection import foot_motion, path_to
from plantar.contact.imu_turn import turned
from plantar.conventions import Array, Mask
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import Placement, RobotModel

RATE = 20.0  # Hz, at which heights are computed: a standing robot moves below 2 Hz
TOGETHER = (
    50_000  # samples of motions that are computed at once: all of a long log's would be its largest array
)
STEP = 1e-3  # rad or m, of the differences that stand for derivatives


def height_changes(
    log: MotionLog, robot: RobotModel, rows: Mask | slice = slice(None)
) -> Iterator[tuple[str, Array]]:
    """Each cause and its change (n,) [m] of the right sole's height over the left one's, at one deviation of the cause,
    at the n samples `rows` (N,).

    Deviations are the robot file's: of each joint's zero between IMU and feet, of the IMU's mount about its three axes,
    and of each bush's place in its two horizontal directions, about which a sole that leans rises and falls. None where
    the log has no attitude.
    """
    imu, known = robot.imu, robot.uncertainty
    orientation = log.orientation(imu.name) if imu is not None else None
    if imu is None or orientation is None:
        return
    stride = max(1, round(1 / (RATE * log.period)))
    positions, attitude = log.positions(robot)[::stride], orientation[::stride]

    def sole(name: str, angles: Array, quaternions: Array, bush: Placement | None = None) -> Array:
        path, still = path_to(robot, name, bush)[0], np.zeros((len(angles), 3))
        motion = foot_motion(path, angles, np.zeros_like(angles), quaternions, still)
        return motion.sole_position[:, 2]

    def change(by: Array, deviation: float) -> Array:
        return np.asarray(np.interp(log.time[rows], log.time[::stride], by * deviation / STEP))

    # All motions that differ from the recorded one: by a joint's angle, or in attitude.
    causes, joints, attitudes = list[tuple[str, float]](), list[int | None]([None]), [attitude]
    for column, joint in enumerate(robot.joint_names):
        if joint in robot.path_joints and known.encoder_zero:
            causes.append((joint, known.encoder_zero))
            joints.append(column)
            attitudes.append(attitude)
    for axis in range(3 if known.imu_mount else 0):
        causes.append((f"imu {'xyz'[axis]}", known.imu_mount))
        joints.append(None)
        attitudes.append(turned(attitude, STEP * np.eye(3)[axis]))
    soles: list[list[Array]] = [[] for _ in robot.feet]
    together = max(1, TOGETHER // len(positions))
    for first in range(0, len(joints), together):
        some = joints[first : first + together]
        angles = np.tile(positions, (len(some), 1, 1))
        for own, moved_joint in zip(angles, some, strict=True):
            if moved_joint is not None:
                own[:, moved_joint] += STEP
        flat, quaternions = (
            angles.reshape(-1, positions.shape[1]),
            np.vstack(attitudes[first : first + together]),
        )
        for found, name in zip(soles, robot.feet, strict=True):
            found += np.split(sole(name, flat, quaternions), len(some))
    before, *others = (right - left for left, right in zip(*soles, strict=True))
    for (cause, deviation), after in zip(causes, others, strict=True):
        yield cause, change(after - before, deviation)
    for side, (name, foot), (lies, *_) in zip((-1.0, 1.0), robot.feet.items(), soles, strict=True):
        for axis in range(2 if known.bush_position else 0):
            bush = replace(foot.bush, xyz=foot.bush.xyz + STEP * foot.bush.rotation[:, axis])
            moved = side * (sole(name, positions, attitude, bush) - lies)
            yield f"{name} {'xyz'[axis]}", change(moved, known.bush_position)
