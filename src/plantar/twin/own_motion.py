"""A motion of one's own, joint positions in a table, as a plan that the twin can play."""

from __future__ import annotations

import os
from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline

from plantar.contact.balance import flat_soles, soles_in_root
from plantar.errors import LogError, MotionError
from plantar.logs.readers import open_log
from plantar.motions.plan import RATE, Plan
from plantar.robot.model import RobotModel

LEVEL: Final = 0.01  # m between two soles that both stand
SHORTEST, LONGEST = 1.0, 3600.0  # s


def own_plan(path: str | os.PathLike[str], robot: RobotModel) -> Plan:
    """The columns `joint.<joint>.position` [rad, m] of a table as a plan at 200 Hz; other columns are not used.

    The robot starts where the first row stands on flat soles; a joint that the table lacks stands at 0. Raises LogError
    where no column is a joint of the robot, MotionError where the first row does not stand on level feet.
    """
    log = open_log(path, robot)
    known = [name for name in robot.joint_names if log.has(f"joint.{name}.position")]
    if not known:
        first = next(iter(robot.joint_names), "")
        message = "holds no position of a joint of this robot"
        raise LogError(message, path=path, valid=f"columns such as 'joint.{first}.position'")
    if not SHORTEST <= log.duration <= LONGEST:
        raise LogError(f"lasts {log.duration:.4g} s", path=path, valid=f"{SHORTEST:g} to {LONGEST:g} s")
    values = log.positions(robot)
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if bad.size:
        message = "a joint has no position"
        raise LogError(message, path=path, time=float(log.time[bad[0]]), valid="a number in every row")
    time = np.arange(int(log.duration * RATE + 1e-6) + 1) / RATE
    positions = CubicSpline(log.time - log.time[0], values)(time)
    if not robot.feet:
        raise MotionError("has no feet to stand on", path=robot.path, valid="a robot file with feet")
    in_root, soles = soles_in_root(robot, positions[0]), flat_soles(robot, positions[0])
    foot = min(soles)
    base = soles[foot] @ np.linalg.inv(in_root[foot])
    heights = [(base @ pose)[2, 3] for pose in in_root.values()]
    if np.ptp(heights) > LEVEL:
        message = f"the first row has one foot {1e3 * np.ptp(heights):.0f} mm above the other"
        raise MotionError(message, path=path, valid=f"level feet, within {1e3 * LEVEL:.0f} mm")
    bases = np.tile(base, (time.size, 1, 1))
    return Plan(log.name, time, robot.joint_names, positions, bases, frozenset(soles), soles)
