"""Joints that bend where their encoders do not see it: encoders on the motor's side of a gear, legs that give way.

The links turn by compliance·torque beyond what is read, of every joint of the leg, with the torque that the foot's
wrench makes in it. It counts as the bush's angle: nothing in the logs tells the two apart. What bends above the URDF's
root is not known so simply, and left out.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from plantar.contact.deflection import foot_motions
from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.dynamics import Contact
from plantar.dynamics.equation import equation_of
from plantar.dynamics.motion import Motion
from plantar.feet.interval_width.cause import Cause
from plantar.feet.place.bush_place import centre_columns
from plantar.feet.recording import Recording, within_stances
from plantar.feet.regression.load_torque import torque_of_angle
from plantar.feet.regression.tangent import Tangent
from plantar.robot.model import RobotModel
from plantar.signals.orientation import attitude

NAME = "joint compliance"
# rad/(N.m), over which a memory's slope is taken: joints bend by a small part of what makes it slip.
LITTLE = 1e-6


def joint_compliance_causes(robot: RobotModel, tangent: Tangent) -> list[Cause]:
    """What the robot file's `joint_compliance` makes of a fit, the same in all joints; none where that is 0.

    tangent: with all of the recordings' logs.
    """
    compliance, fit = robot.uncertainty.joint_compliance, tangent.fit
    if not compliance:
        return []
    column, size = ROTATIONAL_AXES.index(fit.axis), tangent.blocks[0].regressor.shape[1]

    def bent(one: Recording) -> Array:
        return torque_of_angle(one, fit, _bending(robot, one)[fit.foot][:, column], LITTLE)

    # Hips that bend look like a bush that is higher, which the number follows.
    placed = np.flatnonzero([*fit.moment_arms, fit.turned, *fit.imu_turned])
    changes = tangent.rows(bent)
    if not tangent.steps:
        tangent = tangent.beside(tangent.rows(lambda one: centre_columns(one, fit)[:, placed]))
    return [Cause(NAME, tangent.effect(changes)[:size], compliance)]


def _bending(robot: RobotModel, recording: Recording) -> dict[str, Array]:
    """By how much each bush's angles change with the compliance of all joints, (N, 2) [rad per rad/(N.m)], filtered as
    they are.

    Links below a joint weigh little beside what the foot carries: they are left out of its torque.
    """
    if NAME not in recording.kept:
        log, positions = recording.log, recording.log.positions(robot)
        equation, still = equation_of(robot.floating_model), np.zeros_like(positions)
        contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]
        wrenches = [foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()]
        motion = Motion(np.zeros((len(log), 9)), positions, still, still)
        torques = equation.inverse_dynamics(motion, None, contacts, wrenches)[equation.first_joint_row :].T
        orientation, rates = attitude(log, robot.required_imu, [])
        # As joints that turn by their torques in a second would turn the bush.
        motions = foot_motions(robot, positions, np.nan_to_num(torques), orientation, np.zeros_like(rates))
        recording.kept[NAME] = {
            name: within_stances(
                one.encoder_rate, recording.period, recording.cutoff, recording.stances[name]
            )
            for name, one in motions.items()
        }
    return cast(dict[str, Array], recording.kept[NAME])
