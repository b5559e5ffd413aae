"""Joints that bend where their encoders do not see it: encoders on the motor's side of a gear, legs that give way.

The links turn by compliance·torque beyond what is read, of every joint between the IMU and the foot, with the torque
that the feet's wrenches, the links' weight and their inertia make in it. It counts as the bush's angle: what nothing in
the logs tells of it widens the bush's numbers.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from plantar.contact.deflection import foot_motions
from plantar.conventions import ROTATIONAL_AXES, ROUNDING, Array
from plantar.feet.interval_width.cause import Cause
from plantar.feet.place.bush_place import centre_columns
from plantar.feet.recording import Recording, within_stances
from plantar.feet.regression.load_torque import torque_of_angle
from plantar.feet.regression.tangent import Tangent
from plantar.robot.model import RobotModel
from plantar.sensors.moments.bent_joints import JointBending
from plantar.sensors.moments.joint_torques import torques_along
from plantar.signals.orientation import attitude

NAME = "joint compliance"
# rad/(N.m), over which a memory's slope is taken: joints bend by a small part of what makes it slip.
LITTLE = 1e-6


def joint_compliance_causes(robot: RobotModel, tangent: Tangent, bending: JointBending) -> list[Cause]:
    """What is left open of how joints bend makes of a fit; none where nothing is.

    tangent: with all of the recordings' logs.
    """
    if not bending.covariance.any():
        return []
    variances, directions = np.linalg.eigh(bending.covariance)
    open_ones = variances > ROUNDING * variances[-1]
    fit, ways = tangent.fit, np.sqrt(variances[open_ones]) * directions[:, open_ones]
    column, size = ROTATIONAL_AXES.index(fit.axis), tangent.blocks[0].regressor.shape[1]

    def bent(one: Recording) -> Array:
        angles = _bending(robot, one, ways)[fit.foot][..., column]
        return np.column_stack([torque_of_angle(one, fit, angle, LITTLE) for angle in angles])

    # Hips that bend look like a bush that is higher, which the number follows.
    placed = np.flatnonzero([*fit.moment_arms, fit.turned, *fit.imu_turned])
    changes = tangent.rows(bent)
    if not tangent.steps:
        tangent = tangent.beside(tangent.rows(lambda one: centre_columns(one, fit)[:, placed]))
    return [Cause(NAME, np.linalg.norm(tangent.effect(changes)[:size], axis=1), 1.0)]


def _bending(robot: RobotModel, recording: Recording, ways: Array) -> dict[str, Array]:
    """By how much each bush's angles change as joints bend by each of the `ways` (joints, m) [rad/(N.m)], (m, N, 2)
    [rad], filtered as they are."""
    if NAME not in recording.kept:
        log, positions = recording.log, recording.log.positions(robot)
        torques = torques_along(robot, log)
        orientation, rates = attitude(log, robot.required_imu, [])
        still = np.zeros_like(rates)
        # As joints that turn by their torques in a second would turn the bush.
        each = [foot_motions(robot, positions, torques * way, orientation, still) for way in ways.T]
        recording.kept[NAME] = {
            name: np.array([
                within_stances(one[name].encoder_rate, recording.period, recording.cutoff, stances)
                for one in each
            ])
            for name, stances in recording.stances.items()
        }  # fmt: skip
    return cast(dict[str, Array], recording.kept[NAME])
