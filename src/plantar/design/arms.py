"""Which joints swing with the arms, and how far: those that turn it about its y axis and carry neither foot nor IMU."""

from __future__ import annotations

from typing import Final

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.motions.body import CHEST, Body
from plantar.motions.upper import ROOM, upper_joints

SWING: Final = 0.3  # rad
WEAKEST: Final = 0.2  # of the strongest joint's angular momentum: fingers and wrists keep still


def arm_swing(body: Body, q: Array) -> Array:
    """The joints' part in one swing from configuration `q` (nq,), (nv,) [rad]; 0 where a joint keeps still."""
    model = body.model
    momentum = np.array(pin.computeCentroidalMap(model, model.createData(), q))[4]
    swing = np.zeros(model.nv)
    chest = model.frames[model.getFrameId(CHEST)].parentJoint
    numbers = [model.getJointId(name) for name in upper_joints(body)]
    joints = [model.joints[number] for number in numbers if number not in list(model.supports[chest])]
    strongest = max((abs(momentum[joint.idx_v]) for joint in joints), default=0.0)
    for joint in joints:
        low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
        room = max(min(high - q[joint.idx_q], q[joint.idx_q] - low), 0.0) if low < high else SWING
        if strongest > 0 and abs(momentum[joint.idx_v]) > WEAKEST * strongest:
            swing[joint.idx_v] = np.sign(momentum[joint.idx_v]) * min(SWING, ROOM * room)
    return swing
