"""Bushes in the robot file: their axes, and the link that carries them.

Feet that stand beside each other lie along each other's pitch axis. The link is the last one of its leg: joints below
it would turn the sole unseen.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plantar.conventions import Array
from plantar.faults.channels import TURNED
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import RobotModel

SAMPLES = 500  # spread over the log: enough to tell its usual posture
BEFORE = 3.0  # times as far before or behind as beside: no posture of a whole log


def check_bush_axes(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A finding for each bush whose x axis points to the other foot: what is called pitch would be roll; and one where
    `left` stands on the right of `right`.

    In the log's usual posture; not of robots with another number of feet than two.
    """
    if len(robot.feet) != 2:
        return
    positions = np.array([[_usual(log.joint(name, "position")) for name in robot.joint_names]])
    rotations, places = robot.tree.poses(positions)
    frames = {}
    for name, foot in robot.feet.items():
        carrier, placement = robot.frame(foot.bush)
        turn = rotations[carrier, 0]
        frames[name] = turn @ placement.rotation, places[carrier, 0] + turn @ placement.translation
    (first, second) = (place for _, place in frames.values())
    apart = {name: turn.T @ (second - first) for name, (turn, _) in frames.items()}
    if set(apart) == {"left", "right"}:
        leftward = 1 if next(iter(apart)) == "right" else -1  # from the first foot to the second
        if all(leftward * y < -abs(x) for x, y, _ in apart.values()):
            text = (
                "robot file, feet: the foot 'left' stands to the right of the foot 'right' (valid: exchange the two "
                "names; or, where x of their bushes points to the heels, turn it to the toes)"
            )
            yield Finding("feet_exchanged", text)
    for name, (x, y, _) in apart.items():
        if abs(x) > BEFORE * abs(y):
            text = (
                f"robot file, feet.{name}.bush.rpy: its x axis points to the other foot: pitch and roll would be "
                "exchanged (valid: x to the toes, y to the left, z up)"
            )
            yield Finding("bush_axes", text)


def _usual(position: Array | None) -> float:
    """The joint's usual position, 0 where it was not recorded."""
    known = np.zeros(0) if position is None else position[np.isfinite(position)]
    return float(np.median(known[:: max(1, len(known) // SAMPLES)])) if known.size else 0.0


def check_bush_link(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """A finding for each foot with a joint below its bush that moves: toes that bend, or the wrong link."""
    for name, foot in robot.feet.items():
        carrier, _ = robot.frame(foot.bush)
        for joint in list(robot.model.subtrees[carrier])[1:] if carrier > 0 else []:
            position = log.joint(robot.model.names[joint], "position")
            if position is None or not np.isfinite(position).any():
                continue
            moved = float(np.nanmax(position) - np.nanmin(position))
            if moved > TURNED:
                text = (
                    f"robot file, feet.{name}.bush.link: '{foot.bush.link}' has the joint "
                    f"'{robot.model.names[joint]}' below it: it moves by {moved:.2g} rad and turns the sole unseen "
                    "(valid: the last link of the leg)"
                )
                yield Finding("bush_link", text)
