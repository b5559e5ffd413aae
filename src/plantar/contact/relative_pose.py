"""How two soles stand to each other, which neither the IMU's yaw nor its position enters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar.contact.deflection import BushState
from plantar.conventions import Array


@dataclass(frozen=True)
class RelativePose:
    """The right sole seen from the left one's levelled heading frame: constant while both stand without slip.

    position: (N, 3) [m]; its z is the difference of the soles' heights: the z deflections of both bushes;
    yaw: (N,) [rad], in (-pi, pi].
    """

    position: Array
    yaw: Array


def relative_pose(left: BushState, right: BushState) -> RelativePose:
    """How two soles stand to each other; the IMU's yaw and position cancel."""
    x, y, z = (right.sole_position - left.sole_position).T
    c, s = np.cos(left.heading), np.sin(left.heading)
    yaw = np.pi - np.mod(np.pi - (right.heading - left.heading), 2 * np.pi)
    return RelativePose(np.column_stack([c * x + s * y, c * y - s * x, z]), yaw)
