"""Any robot file's robot as a description, so that the twin can play robots that it did not write."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.errors import RobotError
from plantar.robot.model import RobotModel
from plantar.twin.robots.description import Body, Description, Shape

DEFAULT_EFFORT = 200.0  # N·m, where the URDF gives none
DEFAULT_VELOCITY = 6.0  # rad/s
ROD = 0.04  # m, thickness of the rods drawn from joint to joint


def describe(robot: RobotModel) -> Description:
    """Bodies of a robot's URDF, links without a joint in between merged, rods drawn from joint to joint.

    Raises RobotError for joints of more than one degree of freedom.
    """
    model = robot.model
    columns = _axes(model, robot)
    mass, com, inertia = _inertia(model.inertias[0])
    root = model.frames[1].name if model.nframes > 1 else "root"
    bodies = [Body(root, -1, mass=mass, com=com, inertia=inertia)]
    for joint in range(1, model.njoints):
        column = columns[joint]
        revolute = bool(np.linalg.norm(column[3:]) > 0.5)
        place = model.joints[joint].idx_v
        circular = model.joints[joint].nq != 1
        lower, upper = (-np.inf, np.inf) if circular else _limits(model, model.joints[joint].idx_q)
        placement = model.jointPlacements[joint]
        bodies.append(
            Body(
                f"{model.names[joint]}_body",
                int(model.parents[joint]),
                model.names[joint],
                "revolute" if revolute else "prismatic",
                column[3:] if revolute else column[:3],
                np.array(placement.translation),
                np.array(placement.rotation),
                lower,
                upper,
                _positive(model.upperVelocityLimit[place], DEFAULT_VELOCITY),
                _positive(model.upperEffortLimit[place], DEFAULT_EFFORT),
                *_inertia(model.inertias[joint]),
                _rods(model, joint),
            )
        )
    return Description(robot.name, tuple(bodies))


def _axes(model: pin.Model, robot: RobotModel) -> dict[int, Array]:
    """Linear then angular direction of each joint in its own frame, (6,)."""
    data, neutral = model.createData(), pin.neutral(model)
    axes = {}
    for joint in range(1, model.njoints):
        if model.joints[joint].nv != 1:
            message = f"joint '{model.names[joint]}' has {model.joints[joint].nv} degrees of freedom"
            raise RobotError(message, path=robot.path, valid="joints of one degree of freedom")
        jacobian = pin.computeJointJacobian(model, data, neutral, joint)
        axes[joint] = np.array(jacobian[:, model.joints[joint].idx_v])
    return axes


def _inertia(inertia: pin.Inertia) -> tuple[float, Array, Array]:
    """Mass, centre of mass and the inertia about it."""
    return float(inertia.mass), np.array(inertia.lever), np.array(inertia.inertia)


def _limits(model: pin.Model, place: int) -> tuple[float, float]:
    lower, upper = float(model.lowerPositionLimit[place]), float(model.upperPositionLimit[place])
    return (lower, upper) if lower < upper else (-np.inf, np.inf)


def _positive(value: float, default: float) -> float:
    return float(value) if 0 < value < 1e6 else default


def _rods(model: pin.Model, joint: int) -> tuple[Shape, ...]:
    """A box from this joint's origin to each child's, axis-aligned: enough to see the posture."""
    ends = [np.array(model.jointPlacements[child].translation) for child in model.children[joint]]
    return tuple(Shape(end / 2, np.abs(end) + ROD) for end in ends if np.linalg.norm(end) > ROD)
