"""What a robot file that is a little wrong does to the predicted wrench: its inertias and its IMU's mount drawn about
their own."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.dynamics import Equation
from plantar.dynamics.inertial_motion import InertialSignals, inertial_motion, turned_motions
from plantar.robot.model import RobotModel

DRAWS = 48  # a spread is then known to a tenth of itself
DELAY_DRAWS = 16  # that take part in delays: these are filtered in every band
SEED = 0  # the same draws for every recording: the robot is the same
TURN = 0.01  # rad, of the IMU, for the slope of what it predicts


def drawn_wrench_errors(
    robot: RobotModel, equation: Equation, signals: InertialSignals, kept: slice, parameters: Array
) -> Array:
    """By how much the predicted wrench may be off at random, (draws, n, 6): see `drawn_parameter_errors`, and an IMU
    that is turned in its mount by `uncertainty.imu_mount` [rad] about each axis.

    parameters (10 n_links,): what predicts the wrench along the samples `kept` of `signals`.
    """
    motion, mount = inertial_motion(robot, equation, signals, kept), robot.uncertainty.imu_mount
    errors = np.asarray(equation.base_wrenches(motion, drawn_parameter_errors(robot)[:DELAY_DRAWS]))
    if mount == 0:
        return errors
    turns = mount * np.random.default_rng(SEED + 1).standard_normal((DELAY_DRAWS, 3))
    turned = np.tensordot(turns, by_imu_turn(robot, equation, signals, kept, parameters), 1)
    return errors + turned if len(errors) else turned


def by_imu_turn(
    robot: RobotModel, equation: Equation, signals: InertialSignals, kept: slice, parameters: Array
) -> Array:
    """How the wrench that `parameters` predict changes with the angle [rad] by which the IMU is turned about each of
    its axes, (3, n, 6)."""
    turns = [pin.exp3(by * axis) for by in (TURN, -TURN) for axis in np.eye(3)]
    motions = turned_motions(robot, equation, signals, kept, turns)
    wrenches = np.array([equation.base_wrenches(motion, parameters[None])[0] for motion in motions])
    return np.asarray((wrenches[:3] - wrenches[3:]) / (2 * TURN))


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
