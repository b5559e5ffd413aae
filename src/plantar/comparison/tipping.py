"""When a sole of the record first stands on its edge. From then on it tips by itself, beside what its rubber does."""

from __future__ import annotations

import numpy as np

from plantar.contact.balance import zero_moment_point
from plantar.contact.phases import LIFTING_SHARE
from plantar.contact.polygon import inside_distance
from plantar.conventions import GRAVITY
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.signals.filters import low_pass
from plantar.twin.replay import SMOOTH


def on_an_edge(robot: RobotModel, log: MotionLog) -> float | None:
    """Seconds from the start of the log until a foot's centre of pressure is as near to its sole's border as samples
    that identification leaves out; None where it never is.
    """
    least, margin = LIFTING_SHARE * robot.mass * GRAVITY, FeetSettings().edge_margin
    found = []
    for foot in robot.feet.values():
        sole, sensor = (robot.frame(place)[1] for place in (foot.sole.placement, foot.wrench.placement))
        moved = foot.wrench.sign * (sole.inverse() * sensor).toDualActionMatrix()
        wrench = log.wrench(foot.wrench.name) @ moved.T
        # The noise of a lightly loaded sensor moves its centre of pressure by more than the margin.
        slow = low_pass(wrench, float(np.median(np.diff(log.time))), SMOOTH)
        # NaN in the air: no.
        near = inside_distance(zero_moment_point(slow, least), foot.sole.polygon) < margin
        found += [float(log.time[int(np.argmax(near))] - log.time[0])] if near.any() else []
    return min(found, default=None)
