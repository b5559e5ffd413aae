"""How Newton's law changes as joints bend beyond their encoders."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import Contact
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion
from plantar.robot.model import RobotModel
from plantar.sensors.moments.joint_torques import joint_torques
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.sensors.newton_sides import carried
from plantar.signals.filters import differentiate

STEP = 1e-7  # rad/(N.m), for the slope: far below what any joint bends, far above rounding


def bending_torques(robot: RobotModel, residual: NewtonEulerResidual, quick: bool) -> Array:
    """The torques [N.m] that bend the joints, with both derivatives, (3, n, joints): at the samples of the residual.
    quick: whether what bends is accelerated as well.

    Of a standing robot it hardly is, and the torques' noise, white as it is, stays white without.
    """
    equation, period = equation_of(robot.floating_model), residual.pair.period
    motion = inertial_motion(
        robot, equation, residual.signals, residual.kept, encoders_late=residual.encoders_late
    )
    torques = joint_torques(robot, motion, residual.parameters, residual.readings)
    if not quick:
        return np.stack([torques, *np.zeros((2, *torques.shape))])
    rates = differentiate(torques, period)
    return np.stack([torques, rates, differentiate(rates, period)])


def by_bending(
    robot: RobotModel, residual: NewtonEulerResidual, groups: Sequence[Sequence[int]], torques: Array
) -> list[Array]:
    """How what is predicted beyond the measured changes as each group of joints bends, (n, 6) [N, N.m per rad/(N.m)].
    torques: of the joints at the samples of the residual, with both derivatives, (3, n, joints)."""
    equation = equation_of(robot.floating_model)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]

    def missing(bends: Array) -> Array:
        late = residual.encoders_late
        bent = inertial_motion(
            robot, equation, residual.signals, residual.kept, encoders_late=late, bends=bends
        )
        transfers = [equation.base_transfer(bent.positions, contact) for contact in contacts]
        predicted = equation.base_wrenches(bent, residual.parameters[None])[0]
        return np.asarray(predicted - np.sum(carried(transfers, residual.readings), axis=0))

    slopes = []
    for joints in groups:
        bends = np.zeros_like(torques)
        bends[..., joints] = STEP * torques[..., joints]
        slopes.append((missing(bends) - missing(-bends)) / (2 * STEP))
    return slopes
