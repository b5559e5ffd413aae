"""What a URDF that is a little wrong does to the predicted wrench: inertial parameters drawn about its own."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.robot.model import RobotModel

# A spread is then known to a tenth of itself. Of sixteen, what a wrong URDF does to delays was a seventh too small,
# in all logs of a robot.
DRAWS = 48
SEED = 0  # the same draws for every recording: the robot is the same


def drawn_parameter_errors(robot: RobotModel) -> Array:
    """By how much inertial parameters may be off at random, (draws, 10 n_links), in Pinocchio's order.

    Each link's mass is off by a share `uncertainty.link_mass`, its rotational inertia about the centre of mass with
    it, and its centre of mass by `uncertainty.link_com` [m] along each axis. No draws where both are zero.
    """
    return _drawn(robot.floating_model, robot.uncertainty.link_mass, robot.uncertainty.link_com)


@lru_cache(maxsize=1)  # every log asks for those of the one robot
def _drawn(model: pin.Model, mass: float, centre: float) -> Array:
    if mass == 0 and centre == 0:
        return np.zeros((0, 10 * (model.njoints - 1)))
    bodies = list(model.inertias)[1:]
    masses = np.array([body.mass for body in bodies])
    centres, inertias = np.array([body.lever for body in bodies]), np.array([body.inertia for body in bodies])
    random = np.random.default_rng(SEED).standard_normal((DRAWS, len(bodies), 4))
    shares = np.maximum(1 + mass * random[..., 0], 0.0)
    moved = centres + centre * random[..., 1:]
    drawn = _parameters(shares * masses, moved, shares[..., None, None] * inertias)
    return np.asarray((drawn - _parameters(masses, centres, inertias)).reshape(DRAWS, -1))


def _parameters(mass: Array, centre: Array, inertia: Array) -> Array:
    """The ten parameters (..., 10) of bodies of `mass` (...), with `centre` (..., 3) and rotational inertia (..., 3, 3)
    about it, in Pinocchio's order.

    Pinocchio itself refuses inertias that rounding made a hair negative, as of links with next to no mass.
    """
    square = np.sum(centre**2, axis=-1)[..., None, None] * np.eye(3)
    about_origin = inertia + mass[..., None, None] * (square - centre[..., :, None] * centre[..., None, :])
    rows, columns = [0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]
    return np.concatenate(
        [mass[..., None], mass[..., None] * centre, about_origin[..., rows, columns]], axis=-1
    )
