"""What a URDF that is a little wrong does to the predicted wrench: inertial parameters drawn about its own."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.robot.model import RobotModel

DRAWS = 48  # a spread is then known to a tenth of itself
SEED = 0  # the same draws for every recording: the robot is the same


def drawn_parameter_errors(robot: RobotModel) -> Array:
    """By how much inertial parameters may be off at random, (draws, 10 n_links), in Pinocchio's order.

    Each link's mass is off by a share `uncertainty.link_mass`, its rotational inertia about the centre of mass with
    it, and its centre of mass by `uncertainty.link_com` [m] along each axis. No draws where both are zero.
    """
    mass, centre = robot.uncertainty.link_mass, robot.uncertainty.link_com
    if mass == 0 and centre == 0:
        return np.zeros((0, 10 * (robot.floating_model.njoints - 1)))
    random = np.random.default_rng(SEED)
    return np.array([_drawn(robot.floating_model, random, mass, centre) for _ in range(DRAWS)])


def _drawn(model: pin.Model, random: np.random.Generator, mass: float, centre: float) -> Array:
    changes = []
    for inertia in list(model.inertias)[1:]:
        share, moved = 1 + mass * random.standard_normal(), centre * random.standard_normal(3)
        share = max(share, 0.0)
        heavier = _parameters(share * inertia.mass, inertia.lever + moved, share * inertia.inertia)
        changes.append(heavier - inertia.toDynamicParameters())
    return np.concatenate(changes)


def _parameters(mass: float, centre: Array, inertia: Array) -> Array:
    """The ten parameters of a body with its rotational inertia (3, 3) about the centre of mass, in Pinocchio's order.

    Pinocchio itself refuses inertias that rounding made a hair negative, as of links with next to no mass.
    """
    about_origin = inertia + mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    rows, columns = [0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]
    return np.concatenate([[mass], mass * centre, about_origin[rows, columns]])
