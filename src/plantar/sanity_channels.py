"""Channels that stop while others go on: a cable that comes off, a driver that repeats its last value, a full scale."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.log import MotionLog
from plantar.notes import Finding
from plantar.robot import Foot, RobotModel
from plantar.signals import runs

SHORTEST, FEWEST = 0.2, 10  # s and samples at one value: less happens by chance
LIVELY = 0.9  # share of the other steps that change the value: of a coarse or slow channel nothing is said
NOTABLE = 0.005  # share of the log


def check_channels(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """Columns of the IMU and of the wrenches that stand at one value for a while, joints between them that never move.

    Encoders read in steps: of one that stands for a while nothing can be said.
    """
    if robot.imu is None:
        return
    loaded = [foot for foot in robot.feet.values() if _carries(robot, foot, log)]
    path = frozenset().union(*(robot.joints_between(robot.imu.placement, foot.bush) for foot in loaded))
    joints = [f"joint.{name}.position" for name in sorted(path) if log.has(f"joint.{name}.position")]
    still = [name for name in joints if not _moves(log.column(name))]
    if still and 2 * len(still) < len(joints):
        several = len(still) > 1
        text = f"column{'s' * several} {', '.join(map(repr, still))}: never change{'s' * (not several)}"
        yield Finding(
            "still_joint",
            f"{text}; right if the joint stood still, else the channel is dead",
            severity="info",
        )
    sensors = (f"imu.{robot.imu.name}.", *(f"wrench.{foot.wrench.name}." for foot in robot.feet.values()))
    for name in (column for column in log.columns if column.startswith(sensors)):
        yield from _stuck(name, log)


def _carries(robot: RobotModel, foot: Foot, log: MotionLog) -> bool:
    """Whether this foot carries a tenth of the weight or more, at least half of the time."""
    force = np.linalg.norm(log.wrench(foot.wrench.name)[:, :3], axis=1)
    return bool(np.mean(force > 0.1 * robot.mass * GRAVITY) > 0.5)


def _moves(values: Array) -> bool:
    finite = values[np.isfinite(values)]
    return finite.size == 0 or bool(np.ptp(finite) > 0)


def _stuck(name: str, log: MotionLog) -> Iterator[Finding]:
    values = log.column(name)
    steps = np.diff(values)
    still = (steps == 0) & (values[1:] != 0)  # a foot in the air may read zero
    least = max(FEWEST, round(SHORTEST / log.period))
    held = [run for run in runs(still) if run.stop - run.start >= least]
    count = sum(run.stop - run.start for run in held)
    if not NOTABLE * len(log) < count < len(steps):
        return
    inside = np.zeros(len(steps), dtype=bool)
    for run in held:
        inside[run] = True
    others = steps[~inside & np.isfinite(steps)]
    if others.size < least or np.mean(others != 0) < LIVELY:
        return
    longest = max(held, key=lambda run: run.stop - run.start)
    first, last = log.time[longest.start], log.time[longest.stop]
    text = f"column '{name}', t = {first:g} to {last:g} s, value {values[longest.start]:.6g}: stands still while it"
    share = f"{100 * count / len(log):.0f} % of the log; is the channel dead or at its full scale?"
    yield Finding("stuck_channel", f"{text} changes elsewhere, {share} (valid: leave such cells empty)")
