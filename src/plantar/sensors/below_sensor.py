"""What hangs below the feet's force sensors, from what they read while a foot swings.

A sensor measures what passes through it: in the air nothing but the weight and the inertia of the part below it. Its
share of the last link is in no URDF, so the ten inertial parameters of that part are unknown; a walking foot, which
accelerates as much as gravity does, shows them. Left out, they pass for wrong forces, torques and delays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from plantar.contact.phases import LANDING_SHARE, widened
from plantar.conventions import FORCE, GRAVITY, TORQUE, Array, Mask
from plantar.dynamics import Contact, Equation
from plantar.dynamics.equation import ALL_PARAMETERS, BASE_ROWS, PER_LINK
from plantar.dynamics.motion import Motion
from plantar.robot.model import Foot, RobotModel
from plantar.sensors.air_zero import air_zero
from plantar.sensors.load_errors import APART

LANDING = 0.15  # s around contact: the low-pass smears it
SHORTEST = 1.0  # s in the air: less is hardly more than the noise
LEAST_NOISE = 1e-3  # N, N.m: a dead sensor reads without any
WORSE = 1.1  # times the squares of what Newton's law misses: by less, chance tells
REWEIGHTED = 10  # times: rows are weighed by what is left of them as a rule, samples by what is left in them
HALF = 0.455  # of a normal error's variance: the median of its squares
STRAY = 3.0  # times what is left as a rule: a foot that still carries a little, as before a first step, is no swing


class BelowSensors(NamedTuple):
    """What hangs below the feet's force sensors.

    Its inertial `parameters`, added up by link, (10 n_links,); the sensors' `zeros`, (6 feet,) [N, N·m], which a
    sensor that was zeroed with its foot in the air has for the weight of that part.
    """

    parameters: Array
    zeros: Array


def below_sensors(
    robot: RobotModel, equation: Equation, motion: Motion, readings: Array, period: float
) -> BelowSensors:
    """What swings show of it; nothing of a foot that never leaves the ground.

    Least squares of eq. 1's base rows over the samples in which a foot is in the air. The last link's own size is the
    prior's deviation: what no swing shows stays near nothing.

    readings: the sensors' low-passed wrenches along `motion`, in their own frames, with the sign of what the ground
    does to the robot, (N, 6 feet).
    """
    parameters, zeros = np.zeros((len(equation.links), PER_LINK)), np.zeros((len(robot.feet), 6))
    for place, foot in enumerate(robot.feet.values()):
        contact, own = Contact(*robot.frame(foot.wrench.placement)), readings[:, 6 * place : 6 * place + 6]
        body, swings = robot.model.inertias[contact.link], _in_air(own, robot.mass * GRAVITY, period)
        if np.count_nonzero(swings) * period < SHORTEST or body.mass <= 0:
            continue
        aloft = motion.select(swings)
        masks = [ALL_PARAMETERS * (link == contact.link) for link in range(len(equation.links))]
        inertia = equation.regressor(aloft, masks)[:BASE_ROWS].transpose(2, 0, 1)
        carried = equation.base_transfer(aloft.positions, contact)
        read = (carried @ own[swings][:, :, None])[..., 0]
        radius = np.sqrt(np.trace(body.matrix()[TORQUE, TORQUE]) / (2 * body.mass))
        sizes = body.mass * np.repeat([1.0, radius, np.trace(_plate(foot)) / 3], [1, 3, 6])
        largest = LANDING_SHARE * robot.mass * GRAVITY
        columns = np.concatenate([-inertia, carried], axis=2)
        values = _least_squares(
            columns, read, np.append(sizes, np.full(6, largest)), foot, min(period / APART, 1.0)
        )
        parameters[contact.link] += values[:PER_LINK]
        zeros[place] = values[PER_LINK:]
    return BelowSensors(parameters.ravel(), zeros.ravel())


def counts_below(missed: Array, hangs: Array) -> bool:
    """Whether the URDF's last links count what `hangs` below the sensors, as they do as a rule: not where what Newton's
    law without this part has `missed` becomes clearly more with it taken off. Soles that a lab made are in no URDF.

    Both (n, 6) about the root link; by the moments, since forces are wrong in proportion to the load.
    """
    missed, hangs = missed[:, TORQUE], hangs[:, TORQUE]
    return bool(np.sum((missed - hangs) ** 2) <= WORSE * np.sum(missed**2))


def _in_air(reading: Array, weight: float, period: float) -> Mask:
    """Samples (N,) in which a foot's reading (N, 6) is that of a foot in the air, clear of landing and lift-off.

    A sensor whose zero is as large as what a foot in the air may read shows its swings beside that zero.
    """
    force = reading[:, FORCE]
    time: Array = period * np.arange(len(force), dtype=np.float64)
    zero = air_zero(time, reading, np.asarray(np.linalg.norm(force, axis=1)), weight)
    touching = (
        np.linalg.norm(force - (0.0 if zero is None else zero.middle[FORCE]), axis=1) > LANDING_SHARE * weight
    )
    return np.asarray(~widened(touching, round(LANDING / period)))


def _plate(foot: Foot) -> Array:
    """Rotational inertia (3, 3) for each kilogram of a plate as large as the sole, about its middle, in its link's axes
    [m²]."""
    along, across = np.ptp(foot.sole.polygon, axis=0) ** 2 / 12
    turn = foot.sole.placement.rotation
    return np.asarray(turn @ np.diag([across, along, along + across]) @ turn.T)


def _least_squares(columns: Array, read: Array, sizes: Array, foot: Foot, share: float) -> Array:
    """Coefficients (k,) of `columns` (n, 6, k) for `read` (n, 6), of which a `share` is independent.

    `sizes` (k,): deviations of the coefficients before it from nothing, of a rotational inertia from that of a plate
    like the foot's sole: a foot hardly turns while it swings, and what no swing shows is needed where it lands.
    """
    weights, scaled, usual = np.ones((1, 6)), columns * sizes, np.zeros(len(sizes))
    for _ in range(REWEIGHTED):
        weighed = weights[..., None] * scaled
        normal = np.tensordot(weighed, scaled, ((0, 1), (0, 1))) + np.eye(len(sizes))
        values = sizes * np.linalg.solve(
            normal, np.tensordot(weighed, read, ((0, 1), (0, 1))) + usual / sizes
        )
        left = (read - columns @ values) ** 2
        rule = LEAST_NOISE**2 + np.median(left, axis=0) / HALF
        strays = np.mean(left / rule, axis=1, keepdims=True) / STRAY**2
        weights = share / (rule * (1 + strays) ** 2)
        usual[4:PER_LINK] = _as_plate(foot, values[0], values[1:4])
    return np.asarray(values)


def _as_plate(foot: Foot, mass: float, moment: Array) -> Array:
    """The rotational inertia (6,) of a plate like the sole of `mass` and with `moment` (3,), mass times place, about
    the link's origin, in Pinocchio's order; zeros of no mass."""
    if mass <= 0:
        return np.zeros(6)
    sole, place = foot.sole.placement.xyz, moment / mass
    # Noise of the moment over that of a mass of nearly nothing is no place.
    farthest = float(np.linalg.norm(sole) + np.linalg.norm(np.ptp(foot.sole.polygon, axis=0)))
    place *= farthest / max(float(np.linalg.norm(place)), farthest)
    return np.asarray(pin.Inertia(mass, place, mass * _plate(foot)).toDynamicParameters()[4:])
