"""Axes of the bushes in the robot file: feet that stand beside each other lie along each other's pitch axis."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import RobotModel

BEFORE = 3.0  # times as far before or behind as beside: no posture of a whole log


def check_bush_axes(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A finding for each bush whose x axis points to the other foot: what is called pitch would be roll.

    In the log's usual posture; not of robots with another number of feet than two.
    """
    if len(robot.feet) != 2:
        return
    positions = np.nan_to_num(np.nanmedian(np.atleast_2d(log.positions(robot)), axis=0))[None]
    rotations, places = robot.tree.poses(positions)
    frames = {}
    for name, foot in robot.feet.items():
        carrier, placement = robot.frame(foot.bush)
        turn = rotations[carrier, 0]
        frames[name] = turn @ placement.rotation, places[carrier, 0] + turn @ placement.translation
    (first, second) = (place for _, place in frames.values())
    for name, (turn, _) in frames.items():
        x, y, _ = np.abs(turn.T @ (second - first))
        if x > BEFORE * y:
            text = (
                f"robot file, feet.{name}.bush.rpy: its x axis points to the other foot: pitch and roll would be "
                "exchanged (valid: x to the toes, y to the left, z up)"
            )
            yield Finding("bush_axes", text)
