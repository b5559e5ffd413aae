"""How hard two feet push against one another on the floor, while their bushes bend apart."""

from __future__ import annotations

from typing import Final

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.design.legs import Legs
from plantar.twin.robots.from_robot import describe

HELD: Final = [0, 1, 5]  # of a foot's force and moment: what the floor's friction holds, x, y and yaw
LEFT: Final = [4, 3, 2]  # what soft feet leave, about y (pitch), about x (roll), and along z


def internal_forces(legs: Legs) -> Array:
    """Horizontal force (2, 3) [N] of a foot on the robot, per N·m about y and x and per N along z by which the feet
    differ from their mean.

    Joints give way: a leg whose foot is turned by its bush and pressed would move that foot aside, and the floor does
    not let it. Joints give way by as much as their torque's share of its limit, as the twin's do; what the feet do
    against one another leaves the root where it is.
    """
    model, data, (rest, _, _) = legs.model, legs.data, legs.rest
    limits = {body.joint: body.effort for body in describe(legs.body.robot).bodies[1:]}
    soft = np.zeros(model.nv)
    for number in range(2, model.njoints):
        soft[model.joints[number].idx_v] = 1.0 / limits.get(model.names[number], np.inf)
    pin.computeJointJacobians(model, data, rest)
    pin.updateFramePlacements(model, data)
    found = []
    for frame in legs.bushes.values():
        rows = pin.getFrameJacobian(model, data, model.getFrameId(frame), pin.LOCAL_WORLD_ALIGNED)
        moved = (rows * soft) @ rows.T
        found.append(-np.linalg.solve(moved[np.ix_(HELD, HELD)], moved[np.ix_(HELD, LEFT)])[:2])
    return np.asarray(np.mean(found, axis=0))
