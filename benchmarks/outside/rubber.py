"""What a robot's feet are made of: springs, dampers and sliding elements that carry its weight and height."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from plantar.robot.model import RobotModel

GRAVITY = 9.81
STIFFER = (2.0, 3.2)  # times what the robot's weight asks of both feet together
RELAXATION = (0.018, 0.04)  # s, damping over stiffness
SINKS = (0.002, 0.004)  # m, under the whole weight on one foot
SLIP_SHARES = {"pitch": (0.008, 0.016), "roll": (0.004, 0.010)}  # of weight times height
SLIP_ANGLES = (0.006, 0.015)  # rad


@dataclass(frozen=True)
class Hinge:
    """Stiffness [N·m/rad], damping [N·m·s/rad] and the element that slides beside them (torque 0: none)."""

    stiffness: float
    damping: float
    slip_torque: float
    slip_angle: float


@dataclass(frozen=True)
class Rubber:
    """One foot's."""

    pitch: Hinge
    roll: Hinge
    stiffness: float  # N/m, along z
    damping: float  # N·s/m


def weight_times_height(robot: RobotModel) -> float:
    """How fast a robot's gravity turns it over its soles, in the posture of its URDF's zeros [N·m/rad]."""
    model = robot.model
    data, neutral = model.createData(), pin.neutral(model)
    centre = np.array(pin.centerOfMass(model, data, neutral))
    pin.framesForwardKinematics(model, data, neutral)
    soles = [robot.frame(foot.sole.placement) for foot in robot.feet.values()]
    places = [(data.oMi[joint] * place).translation for joint, place in soles]
    return float(robot.mass * GRAVITY * np.linalg.norm(centre - np.mean(places, axis=0)))


def draw_rubber(robot: RobotModel, random: np.random.Generator, sliding: bool) -> dict[str, Rubber]:
    """Rubber for each foot, about what this robot needs to stand."""
    turning = weight_times_height(robot)
    weight = robot.mass * GRAVITY

    def hinge(axis: str, share: float) -> Hinge:
        stiffness = share * turning / 2 * random.uniform(*STIFFER)
        slip = turning * random.uniform(*SLIP_SHARES[axis])
        angle = random.uniform(*SLIP_ANGLES)
        return Hinge(stiffness, stiffness * random.uniform(*RELAXATION), slip if sliding else 0.0, angle)

    found = {}
    for foot in robot.feet:
        vertical = weight / random.uniform(*SINKS)
        found[foot] = Rubber(hinge("pitch", 1.1), hinge("roll", 0.9), vertical, 0.002 * vertical)
    return found
