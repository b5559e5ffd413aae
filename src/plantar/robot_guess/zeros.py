"""Force sensors' zeros of a walking robot, taken off before pose, sign and outline are read from wrenches.

How a sensor is mounted is not known yet: its vertical is the direction in which its force points under load.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from plantar.conventions import FORCE, Array
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.robot_guess.evidence import Remark
from plantar.sensors.air_zero import air_zero


def without_zeros(
    logs: Sequence[MotionLog], sensors: Mapping[str, str], weight: float
) -> tuple[list[MotionLog], list[Remark]]:
    """The logs with wrenches less what the sensors read while their feet swing, and a remark that says how much.

    sensors: of each side, the name of its force sensor; weight: the robot's [N].
    """
    tared, largest = list[MotionLog](), dict[str, float]()
    for log in logs:
        for side, name in sensors.items():
            columns = wrench_columns(name)
            if not log.has(*columns):
                continue
            wrench = log.wrench(name)
            zero = air_zero(log.time, wrench, _load(wrench), weight)
            if zero is not None:
                right = wrench - zero.at(log.time)
                log = log.with_columns(dict(zip(columns, right.T, strict=True)))
                largest[side] = max(largest.get(side, 0.0), float(np.linalg.norm(zero.middle[FORCE])))
        tared.append(log)
    if not largest:
        return tared, []
    found = ", ".join(f"{side} {force:.0f} N" for side, force in largest.items())
    return tared, [Remark(f"in the air the feet's sensors read up to: {found}; taken off as their zeros")]


def _load(wrench: Array) -> Array:
    """The force (N,) [N] along its usual direction while the foot carries, whatever the sensor's axes and sign."""
    size: Array = np.linalg.norm(wrench[:, FORCE], axis=1)
    carries = size > np.nanmax(size, initial=0.0) / 2
    if not carries.any():
        return size
    usual = np.median(wrench[carries, FORCE], axis=0)
    return np.asarray(wrench[:, FORCE] @ usual / np.linalg.norm(usual))
