"""The joints of the legs, and by which torques what the feet carry turns them."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import Contact
from plantar.dynamics.equation import equation_of
from plantar.dynamics.motion import Motion
from plantar.robot.model import RobotModel


def leg_joints(robot: RobotModel) -> list[list[int]]:
    """Places of the joints between the URDF's root and each foot, those of all legs together that are equally far down;
    each by itself where legs differ."""
    chains = [[joint - 1 for joint in robot.model.supports[robot.frame(foot.bush)[0]] if joint]
              for foot in robot.feet.values()]  # fmt: skip
    if len({len(chain) for chain in chains}) > 1:
        return [[joint] for joint in sorted({joint for chain in chains for joint in chain})]
    return [sorted(set(joints)) for joints in zip(*chains, strict=True)]


def leg_torques(robot: RobotModel, positions: Array, wrenches: Array) -> Array:
    """By which torques (n, joints) [N.m] what the feet's sensors read, `wrenches` (n, 6 feet), turns the joints at
    `positions` (n, joints).

    Links below a joint weigh little beside what the foot carries: they are left out.
    """
    equation, still = equation_of(robot.floating_model), np.zeros_like(positions)
    resting = Motion(np.zeros((len(positions), 9)), positions, still, still)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]
    feet = np.split(wrenches, len(contacts), axis=1)
    return np.asarray(-equation.inverse_dynamics(resting, None, contacts, feet)[equation.first_joint_row :].T)
