"""The walking robot's controller: what it adds to the planned joint positions, 200 times a second."""

from __future__ import annotations

import mujoco
import numpy as np

from plantar.conventions import Array
from plantar.motions.plan import Plan
from plantar.robot.model import RobotModel
from plantar.twin.simulation.physics import Physics
from plantar.twin.walking.balance_state import StateEstimator
from plantar.twin.walking.foot_control import FootControl
from plantar.twin.walking.stabiliser import Stabiliser


class WalkingControl:
    """Leads the servos' targets away from the plan, from one sample's correction to the next in a straight line."""

    def __init__(
        self, model: mujoco.MjModel, robot: RobotModel, plan: Plan, physics: Physics, joints: tuple[str, ...]
    ) -> None:
        self.estimator = StateEstimator(model, robot, plan, joints)
        self.stabiliser = Stabiliser(robot, plan)
        self.feet = FootControl(self.estimator, robot, plan, physics.bushes)
        pinocchio = self.estimator.model
        self._places = [int(pinocchio.joints[pinocchio.getJointId(name)].idx_v) for name in joints]
        self.correction = np.zeros(len(joints))

    def led(self, sample: int, data: mujoco.MjData, rows: Array) -> Array:
        """Targets (steps, n) of the sample's planned `rows`, after the sensors of its first step have been read."""
        state = self.estimator.read(sample, data)
        found = self.feet.correction(sample, state, self.stabiliser.ask(sample, state))[self._places]
        way = np.linspace(0.0, 1.0, len(rows))[:, None]
        led = rows + self.correction + way * (found - self.correction)
        self.correction = found
        return np.asarray(led)
