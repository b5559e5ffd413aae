"""Joints between IMU and feet whose recorded position never changes: locked, at rest, or read by a dead encoder."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import permutations

import numpy as np

from plantar.conventions import Array
from plantar.faults.channels import TURNED, loaded_path, named
from plantar.faults.joints.names import legs
from plantar.logs.motion_log import MotionLog, imu_columns, wrench_columns
from plantar.notes import Finding
from plantar.robot.model import RobotModel

QUIET = 1e-4  # noise of IMU and force sensors over what they read: of devices it is a hundredth, of a simulation none
ORDER = 5  # of differences: a smooth motion hardly passes them
RAISED = 252.0  # times the square of white noise, which they make of it
MOST = (1.0, 99.0)  # percent of the samples: a spike is no motion


def check_still_joints(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A finding for joints that never move, as long as most of those between the IMU and the feet that carry do.

    Where the same joint of another leg moves, what this one hides would be the bush's: a motor gives way under load.
    That is a warning. No velocity is needed: a driver that repeats a position often says that it rests. In a simulation
    without noise motors may hold as they are told.
    """
    path = loaded_path(robot, log)
    recorded = {
        name: log.column(f"joint.{name}.position") for name in path if log.has(f"joint.{name}.position")
    }
    still = sorted(name for name, position in recorded.items() if _never_changes(position))
    if not still or 2 * len(still) >= len(recorded):
        return
    turning = {name for name, position in recorded.items() if _turns(position)}
    doubtful = [name for name in still if not turning.isdisjoint(_alike(robot, name))]
    if doubtful and _noiseless(robot, log):
        doubtful = []
    if doubtful:
        text = f"{_columns(doubtful)} while the same joint of another leg moves; the encoder is dead, or its column"
        yield Finding("stuck_channel", f"{text} repeats an old value (valid: leave such cells empty)")
    rest = [name for name in still if name not in doubtful]
    if rest:
        text = f"{_columns(rest)}; right if the joint stood still, else the channel is dead"
        yield Finding("still_joint", text, severity="info")


def _noiseless(robot: RobotModel, log: MotionLog) -> bool:
    """Whether IMU and force sensors read without noise, as only a simulation's do."""
    assert robot.imu is not None, "a path that is loaded"
    names = [*imu_columns(robot.imu.name, "angular_velocity", "linear_acceleration")]
    names += [name for foot in robot.feet.values() for name in wrench_columns(foot.wrench.name)]
    read = log.stack([name for name in names if log.has(name)])
    rough = np.nanstd(np.diff(read, ORDER, axis=0), axis=0) / np.sqrt(RAISED)
    return bool(np.nanmedian(rough / np.maximum(np.nanstd(read, axis=0), 1e-12)) < QUIET)


def _columns(joints: Collection[str]) -> str:
    return f"{named([f'joint.{name}.position' for name in joints])}: never change{'s' * (len(joints) == 1)}"


def _never_changes(position: Array) -> bool:
    finite = position[np.isfinite(position)]
    return finite.size > 0 and not np.ptp(finite) > 0


def _turns(position: Array) -> bool:
    """Whether a joint turns for more than some lone samples."""
    low, high = np.nanpercentile(position, MOST) if np.isfinite(position).any() else (0.0, 0.0)
    return bool(high - low > TURNED)


def _alike(robot: RobotModel, joint: str) -> Iterator[str]:
    """The joints in the same place of other legs, where these have as many."""
    for leg, other in permutations(legs(robot).values(), 2):
        if joint in leg and len(leg) == len(other):
            yield other[leg.index(joint)]
