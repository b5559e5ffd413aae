"""How strongly gravity topples a robot: what its feet have to hold, and so how large their rubber is."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY
from plantar.robot.model import RobotModel


def gravitational_stiffness(robot: RobotModel) -> float:
    """m·g·h [N·m/rad], h the height of the centre of mass above the soles with all joints at neutral."""
    model = robot.model
    data, neutral = model.createData(), pin.neutral(model)
    centre = np.array(pin.centerOfMass(model, data, neutral))
    placements = [robot.frame(foot.sole.placement) for foot in robot.feet.values()]
    soles = [data.oMi[joint] * place for joint, place in placements]
    heights = [float(sole.rotation[:, 2] @ (centre - sole.translation)) for sole in soles]
    return float(robot.mass * GRAVITY * np.mean(heights))
