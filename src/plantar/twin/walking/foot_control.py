"""How a position-controlled leg makes its foot carry what it should: by the rubber's deflection.

A foot on a bush carries a torque when the ankle turns against the sole. The leg turns it by the deflection that the
bush's known stiffness asks for, follows the robot's own lean, and corrects what the force sensor still misses
(Kajita 2010). A foot in the air is kept level and at its height while the body leans.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.motions.plan import RATE, Plan
from plantar.robot.model import RobotModel
from plantar.twin.bush import Feet
from plantar.twin.simulation.mjcf import SERVO_ANGLE
from plantar.twin.walking.balance_state import State, StateEstimator
from plantar.twin.walking.stabiliser import Asked

CORRECTED: Final = 8.0  # 1/s: how fast the force sensors' torque and load are brought to what is asked
FORGOTTEN: Final = 0.15  # s, in which corrections of a foot in the air fade
YIELDING: Final = 30.0  # 1/s: how fast a leg gives way to a floor that comes before its time
LEVELLED: Final = 0.05  # s, in which a foot that swings takes up its height, and gives it up when it stands
LEG_STIFFNESS: Final = 1e6  # N/m of a leg's servos, beside which the bush's is the soft one
MOST_TURNED, MOST_LENGTHENED = 0.25, 0.03  # rad and m: a leg that corrects more has lost its balance


class FootControl:
    """Corrections of the planned joint positions, sample by sample."""

    def __init__(self, estimator: StateEstimator, robot: RobotModel, plan: Plan, bushes: Feet | None) -> None:
        assert plan.walk is not None
        self.estimator, self.plan, self.walk = estimator, plan, plan.walk
        self.feet = tuple(robot.feet)
        self.positions = plan.positions[:, [plan.joints.index(name) for name in estimator.joints]]
        model = estimator.model
        carriers = {
            foot: set(model.supports[model.frames[frame].parentJoint])
            for foot, frame in estimator.frames.items()
        }
        self.legs = {}
        self.compliance, self.lag, self.vertical = {}, {}, {}
        for foot in self.feet:
            others = set().union(*(carriers[other] for other in self.feet if other != foot))
            own = sorted(carriers[foot] - others)
            self.legs[foot] = np.array([model.joints[joint].idx_v for joint in own])
            servo = model.upperEffortLimit[self.legs[foot]][-2:].min() / SERVO_ANGLE
            bush = None if bushes is None else bushes[foot]
            stiffness = (
                np.full(2, np.inf) if bush is None else np.array([bush.roll_stiffness, bush.pitch_stiffness])
            )
            damping = np.zeros(2) if bush is None else np.array([bush.roll_damping, bush.pitch_damping])
            self.compliance[foot] = 1 / stiffness + 1 / servo
            self.lag[foot] = damping / stiffness
            self.vertical[foot] = 1 / LEG_STIFFNESS + (0.0 if bush is None else 1 / bush.z_stiffness)
        self.deflection = {
            foot: np.zeros(2) for foot in self.feet
        }  # that the bush's own model gives the asked torque
        self.turned = {
            foot: np.zeros(2) for foot in self.feet
        }  # correction by the force sensor, roll and pitch
        self.lowered = dict.fromkeys(self.feet, 0.0)  # the same of the load
        self.lifted = dict.fromkeys(self.feet, 0.0)  # m, against the lean

    def correction(self, sample: int, state: State, asked: dict[str, Asked]) -> Array:
        """What to add to the planned joint positions [rad], (nv,) in Pinocchio's order, so that the feet carry what is
        asked."""
        period = 1 / RATE
        carrying = [foot for foot in self.feet if self.walk.stands[foot][sample]]
        self._correct_loads(carrying, state, asked)
        q = self.estimator.configuration(self.positions[sample], pin.SE3(self.plan.base[sample]))
        model, data = self.estimator.model, self.estimator.data
        pin.computeJointJacobians(model, data, q)
        found = np.zeros(model.nv)
        for foot in self.feet:
            stands, want = foot in carrying, asked[foot]
            target = want.torque * self.compliance[foot]
            self.deflection[foot] += (target - self.deflection[foot]) * period / (self.lag[foot] + period)
            if stands:
                miss = want.torque - state.torque[foot]
                self.turned[foot] -= CORRECTED * period * miss * self.compliance[foot]
            else:
                self.turned[foot] *= 1 - period / FORGOTTEN
                self.lowered[foot] *= 1 - period / FORGOTTEN
                self.lowered[foot] -= YIELDING * period * state.load[foot] * self.vertical[foot]
            sole = self.walk.soles[foot][sample, :3, :3]
            lean = (sole.T @ state.lean)[:2]
            level = 0.0 if stands else self._height_lost(foot, carrying, state)
            self.lifted[foot] += (level - self.lifted[foot]) * period / LEVELLED
            turn = np.clip(self.turned[foot] - self.deflection[foot] - lean, -MOST_TURNED, MOST_TURNED)
            down = self.lowered[foot] + want.load * self.vertical[foot]
            up = np.clip(self.lifted[foot] - down, -MOST_LENGTHENED, MOST_LENGTHENED)
            jacobian = pin.getFrameJacobian(model, data, self.estimator.frames[foot], pin.LOCAL)[
                :, self.legs[foot]
            ]
            found[self.legs[foot]] = np.linalg.lstsq(jacobian, np.array([0, 0, up, *turn, 0]), rcond=1e-3)[0]
        return found

    def _correct_loads(self, carrying: list[str], state: State, asked: dict[str, Asked]) -> None:
        """The longer leg carries more: only the difference between two feet that stand can be chosen."""
        if len(carrying) < 2:
            return
        miss = {foot: asked[foot].load - state.load[foot] for foot in carrying}
        mean = sum(miss.values()) / len(miss)
        for foot in carrying:
            self.lowered[foot] += CORRECTED / RATE * (miss[foot] - mean) * self.vertical[foot]

    def _height_lost(self, foot: str, carrying: list[str], state: State) -> float:
        """How far a foot must be lifted, [m], to be at its height above the floor though the body leans."""
        pivot = state.place[carrying[0]]
        return -float(np.cross(state.lean, state.place[foot] - pivot)[2])
