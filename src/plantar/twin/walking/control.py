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
    """Leads the servos' targets away from the plan, along a curve that follows each sample's correction smoothly.

    Straight lines from one correction to the next would turn just where sensors are read: a servo's acceleration jumps
    there and fades within the sample, so that forces and accelerations, always read before the jump, come up to a
    millisecond after what the joints' positions do.
    """

    def __init__(
        self, model: mujoco.MjModel, robot: RobotModel, plan: Plan, physics: Physics, joints: tuple[str, ...]
    ) -> None:
        self.estimator = StateEstimator(model, robot, plan, joints)
        self.stabiliser = Stabiliser(robot, plan)
        self.feet = FootControl(self.estimator, robot, plan, physics.bushes)
        pinocchio = self.estimator.model
        self._places = [int(pinocchio.joints[pinocchio.getJointId(name)].idx_v) for name in joints]
        self._last = np.zeros((3, len(joints)))

    @property
    def correction(self) -> Array:
        """Where the last sample's curve ends, (n,)."""
        return np.asarray((_shares(np.ones(1))[:, 1:] @ self._last)[0])

    def led(self, sample: int, data: mujoco.MjData, rows: Array) -> Array:
        """Targets (steps, n) of the sample's planned `rows`, after the sensors of its first step have been read."""
        state = self.estimator.read(sample, data)
        found = self.feet.correction(sample, state, self.stabiliser.ask(sample, state))[self._places]
        points = np.vstack([self._last, found])
        self._last = points[1:]
        return np.asarray(rows + _shares(np.arange(len(rows)) / len(rows)) @ points)


def _shares(way: Array) -> Array:
    """Shares (m, 4) of the last four corrections in their uniform cubic B-spline, `way` (m,) along its last piece.

    Its slope and its bend do not jump (C. de Boor, A Practical Guide to Splines, 1978).
    """
    left = 1 - way
    first, last = left**3, way**3
    return np.asarray(
        np.column_stack([first, 4 - 6 * way**2 + 3 * last, 4 - 6 * left**2 + 3 * first, last]) / 6
    )
