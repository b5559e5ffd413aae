"""A rollout as it would have been on rubber of another stiffness, without rolling it out again.

The robot above the ankles moves as it did and the ground carries it as it did: torques and forces stay. Stiffer rubber
bends less under the same torque, and the ankles turn by what it bends less, so that leg and sole keep their attitude.
What this leaves out is that an ankle above the bush's centre moves aside by their distance times that angle.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from plantar.errors import RobotError
from plantar.robot.model import RobotModel
from plantar.twin.simulation.rollout import Rollout


def on_other_rubber(rollout: Rollout, robot: RobotModel, shares: Mapping[str, float]) -> Rollout:
    """The rollout with stiffness, damping and slip torque of each foot times its share.

    Args:
        rollout: of a standing motion. robot: its ankles turn in pitch, then in roll, right above the bush.
        shares: by foot, above 0; a foot that is not named keeps its rubber.

    Raises:
        RobotError: an ankle turns otherwise.
    """
    positions, velocities = rollout.positions.copy(), rollout.velocities.copy()
    bush, rates = dict(rollout.bush), dict(rollout.bush_rates)
    for foot, share in shares.items():
        pitch_joint, roll_joint = (rollout.joints.index(name) for name in ankle_joints(robot, foot))
        less = 1 - 1 / share
        pitch, roll = (less * bush[foot][:, axis] for axis in (1, 2))
        turned = {
            pitch_joint: pitch / np.cos(positions[:, roll_joint]),
            roll_joint: roll * np.cos(bush[foot][:, 1]),
        }
        for joint, angle in turned.items():
            positions[:, joint] += angle
            velocities[:, joint] += np.gradient(angle, rollout.time)
        scale = np.array([1.0, 1 / share, 1 / share])
        bush[foot], rates[foot] = bush[foot] * scale, rates[foot] * scale
    return replace(rollout, positions=positions, velocities=velocities, bush=bush, bush_rates=rates)


def ankle_joints(robot: RobotModel, foot: str) -> tuple[str, str]:
    """The names of the joints that turn an ankle in pitch and in roll. Raises RobotError where it has none such."""
    model = robot.model
    last = model.frames[model.getFrameId(robot.feet[foot].ankle)].parentJoint
    before = model.parents[last]
    kinds = (model.joints[before].shortname(), model.joints[last].shortname())
    if kinds != ("JointModelRY", "JointModelRX"):
        message = f"the {foot} ankle does not turn in pitch, then in roll"
        raise RobotError(message, path=robot.path, valid="the built-in robot")
    return model.names[before], model.names[last]
