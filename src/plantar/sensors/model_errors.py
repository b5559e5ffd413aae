"""What a URDF and a mount of the IMU that are a little wrong do to the predicted wrench, drawn at random."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import pinocchio as pin

from plantar.contact.standing_imu import TURN
from plantar.conventions import Array
from plantar.dynamics import Equation
from plantar.dynamics.equation import PER_LINK
from plantar.dynamics.inertial_motion import InertialSignals, turned_motions
from plantar.robot.model import RobotModel

# A spread is then known to a tenth of itself. Of sixteen, what a wrong URDF does to delays was a seventh too small,
# in all logs of a robot.
DRAWS = 48
LIGHT = 0.002  # of the robot's mass: a twentieth of it is no more than what a force sensor's noise is
SEED = 0  # the same draws for every recording: the robot is the same


def drawn_parameter_errors(robot: RobotModel) -> Array:
    """By how much inertial parameters may be off at random, (draws, 10 n_links), in Pinocchio's order.

    Each link's mass is off by a share `uncertainty.link_mass`, its rotational inertia about the centre of mass with
    it, and its centre of mass by `uncertainty.link_com` [m] along each axis. No draws where both are zero.
    """
    return _drawn(robot.floating_model, robot.uncertainty.link_mass, robot.uncertainty.link_com)


def link_errors(robot: RobotModel) -> Array:
    """What one deviation of a link's mass, and of its centre of mass along each axis, adds to the inertial parameters,
    (k, 10 n_links), as `drawn_parameter_errors` draws them. Links that weigh nearly nothing have none."""
    uncertainty, bodies = robot.uncertainty, list(robot.floating_model.inertias)[1:]
    masses, centres, inertias = _inertias(bodies)
    own = [uncertainty.link_mass * _parameters(masses, centres, inertias)]
    for by in uncertainty.link_com * np.eye(3):
        # Half of the difference of both directions: what is quadratic in the shift drops out.
        ends = [_parameters(masses, centres + shift, inertias) for shift in (by, -by)]
        own.append((ends[0] - ends[1]) / 2)
    heavy = np.flatnonzero(masses > LIGHT * robot.mass)
    errors = np.zeros((len(own), len(heavy), len(bodies), PER_LINK))
    errors[:, np.arange(len(heavy)), heavy] = np.array(own)[:, heavy]
    rows = errors.reshape(len(own) * len(heavy), -1)
    return np.asarray(rows[rows.any(axis=1)])


def drawn_imu_turns(robot: RobotModel) -> Array:
    """By how much an IMU may be turned in its mount at random about its axes, (draws, 3) [rad]; no draws for none."""
    mount = robot.uncertainty.imu_mount
    return mount * np.random.default_rng(SEED + 1).standard_normal((DRAWS if mount else 0, 3))


def imu_turn_slopes(
    robot: RobotModel, equation: Equation, signals: InertialSignals, kept: slice, parameters: Array
) -> Array:
    """How the predicted wrench changes as the IMU turns in its mount about each of its axes, (3, n, 6) [1/rad].

    At the samples `kept` of `signals`; parameters (10 n_links,): of the links.
    """
    turns = [pin.exp3(by * axis) for by in (TURN, -TURN) for axis in np.eye(3)]
    turned = turned_motions(robot, equation, signals, kept, turns)
    ends = np.array([equation.base_wrenches(motion, parameters[None])[0] for motion in turned])
    return np.asarray((ends[:3] - ends[3:]) / (2 * TURN))


@lru_cache(maxsize=1)  # every log asks for those of the one robot
def _drawn(model: pin.Model, mass: float, centre: float) -> Array:
    if mass == 0 and centre == 0:
        return np.zeros((0, PER_LINK * (model.njoints - 1)))
    bodies = list(model.inertias)[1:]
    masses, centres, inertias = _inertias(bodies)
    random = np.random.default_rng(SEED).standard_normal((DRAWS, len(bodies), 4))
    shares = np.maximum(1 + mass * random[..., 0], 0.0)
    moved = centres + centre * random[..., 1:]
    drawn = _parameters(shares * masses, moved, shares[..., None, None] * inertias)
    return np.asarray((drawn - _parameters(masses, centres, inertias)).reshape(DRAWS, -1))


def _inertias(bodies: Sequence[pin.Inertia]) -> tuple[Array, Array, Array]:
    """Masses (n,), centres of mass (n, 3) and rotational inertias about them (n, 3, 3)."""
    masses, centres = np.array([body.mass for body in bodies]), np.array([body.lever for body in bodies])
    return masses, centres, np.array([body.inertia for body in bodies])


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
