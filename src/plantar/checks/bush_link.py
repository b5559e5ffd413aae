"""The link that carries a bush: the last one of its leg, or joints below it turn the sole unseen."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import RobotModel

TURNED = 0.02  # rad: as much as a bush turns


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
