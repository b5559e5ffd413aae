"""How joints and the ground's wrench go with the channels of a motion, for small motions about standing still."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pinocchio as pin

from plantar.contact.balance import planned_wrench
from plantar.conventions import FORCE, TORQUE, Array
from plantar.design.family import CHANNELS
from plantar.design.legs import Legs
from plantar.design.soft_feet import Pendulum
from plantar.twin.robots.from_robot import describe

HELD: Final = [0, 1, 5]  # of a foot's force and moment: what the floor's friction holds, x, y and yaw
LEFT: Final = [4, 3, 2]  # what soft feet leave, about y (pitch), about x (roll), and along z
SMALL: Final = 5e-3  # m, rad, share of a swing: far above what the legs miss by, still small


@dataclass(frozen=True)
class LinearRobot:
    """Per unit of each channel: `joints` (channels, nv) [rad], and the wrench about the middle of the bushes that a
    displacement holds, `held`, and that its acceleration takes, `moved`, (channels, 6) [N, N·m]."""

    joints: Array
    held: Array
    moved: Array
    pendulum: Pendulum

    @classmethod
    def of(cls, legs: Legs) -> LinearRobot:
        """By small displacements of every channel. Raises MotionError where the legs have no room to move at all."""
        rest, _, poses = legs.rest
        model = legs.model
        middle = np.mean([pose.translation for pose in poses.values()], axis=0)
        still = np.zeros((1, model.nv))
        weight = about(planned_wrench(model, rest[None], still, still), middle)[0]
        joints, held, moved = (np.zeros((len(CHANNELS), size)) for size in (model.nv, 6, 6))
        for row in range(len(CHANNELS)):
            steps = np.zeros((len(CHANNELS), 2))
            steps[row] = [-SMALL, SMALL]
            before, after = (legs.follow(step[:, None])[0] for step in steps.T)
            change = np.array(pin.difference(model, before, after)) / (2 * SMALL)
            still = np.zeros((2, model.nv))
            ends = about(planned_wrench(model, np.array([before, after]), still, still), middle)
            pushed = about(planned_wrench(model, rest[None], still, change[None]), middle)[0]
            joints[row], held[row] = change, (ends[1] - ends[0]) / (2 * SMALL)
            moved[row] = pushed - weight
        return cls(joints, held, moved, _pendulum(legs, rest, middle))

    def wrench(self, displacements: Array, accelerations: Array) -> Array:
        """What a motion asks of the ground beyond the weight, (..., 6, N), of channels (..., channels, N)."""
        return np.asarray(
            np.einsum("cw,...cn->...wn", self.held, displacements)
            + np.einsum("cw,...cn->...wn", self.moved, accelerations)
        )


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


def about(wrench: Array, point: Array) -> Array:
    """Wrenches (N, 6) about the world's origin as wrenches about another point (3,)."""
    moved = wrench.copy()
    moved[:, TORQUE] -= np.cross(point, wrench[:, FORCE])
    return moved


def _pendulum(legs: Legs, rest: Array, middle: Array) -> Pendulum:
    """The whole body about the middle of its bushes."""
    model, data = legs.model, legs.data
    pin.ccrba(model, data, rest, np.zeros(model.nv))
    inertia = data.Ig
    arm = data.com[0] - middle
    about_middle = inertia.inertia + inertia.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    places = {foot: np.array(pose.translation - middle)[:2] for foot, pose in legs.rest[2].items()}
    return Pendulum(float(inertia.mass), np.diag(about_middle)[:2].copy(), float(arm[2]), places)
