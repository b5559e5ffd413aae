"""How Newton's law changes as joints bend beyond their encoders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import Contact
from plantar.dynamics.equation import equation_of
from plantar.dynamics.motion import Motion
from plantar.robot.model import RobotModel
from plantar.sensors.moments.leg_torques import leg_torques
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.sensors.newton_sides import carried
from plantar.signals.filters import differentiate

STEP = 1e-7  # rad/(N.m), for the slope: far below what any joint bends, far above rounding


def bending_torques(robot: RobotModel, residual: NewtonEulerResidual, quick: bool) -> Array:
    """The torques [N.m] by which what the feet carry turns the joints, with both derivatives, (3, n, joints): at the
    samples of the residual. quick: whether what bends is accelerated as well.

    Of a standing robot it hardly is, and the torques' noise, white as it is, stays white without.
    """
    torques = leg_torques(robot, residual.signals.positions[residual.kept], residual.readings)
    if not quick:
        return np.stack([torques, *np.zeros((2, *torques.shape))])
    rates = differentiate(torques, residual.pair.period)
    return np.stack([torques, rates, differentiate(rates, residual.pair.period)])


def by_bending(
    robot: RobotModel,
    residual: NewtonEulerResidual,
    motion: Motion,
    legs: Sequence[Sequence[int]],
    torques: Array,
) -> list[Array]:
    """How what is predicted beyond the measured changes as each group of joints of `legs` bends, (n, 6) [N, N.m per
    rad/(N.m)]. motion: of the samples of the residual; torques: of its joints with both derivatives, (3, n, joints)."""
    equation = equation_of(robot.floating_model)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]

    def missing(bends: Array) -> Array:
        turned = np.stack([motion.positions, motion.velocities, motion.accelerations]) + bends
        bent = replace(motion, positions=turned[0], velocities=turned[1], accelerations=turned[2])
        transfers = [equation.base_transfer(bent.positions, contact) for contact in contacts]
        predicted = equation.base_wrenches(bent, residual.parameters[None])[0]
        return np.asarray(predicted - np.sum(carried(transfers, residual.readings), axis=0))

    slopes = []
    for joints in legs:
        bends = np.zeros_like(torques)
        bends[..., joints] = STEP * torques[..., joints]
        slopes.append((missing(bends) - missing(-bends)) / (2 * STEP))
    return slopes
