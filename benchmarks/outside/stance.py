"""Legs that hold a pelvis over two standing soles: Newton's method on the feet's poses, joints kept in their ranges."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.robot.model import RobotModel

CROUCH = 0.06  # of the leg's length
CLEAR = 0.02  # m at least between the soles
CLOSE = 1e-6  # m and rad
STEPS = 200
TRIES = 30
DAMPING = 1e-6
HEAVY = 0.012  # of weight times the leg's length: what a joint may carry aside that is swung in full


class Stance:
    """A robot on both soles. `q` (nq,) of the floating model is how it stands at rest, `width` how far apart [m]."""

    def __init__(self, robot: RobotModel) -> None:
        self.robot, self.model = robot, robot.floating_model
        self.data = self.model.createData()
        self.frames = {
            name: (joint + 1, place)  # the free joint comes first
            for name, foot in robot.feet.items()
            for joint, place in [robot.frame(foot.sole.placement)]
        }
        self.legs = {name: self._leg(joint) for name, (joint, _) in self.frames.items()}
        neutral = pin.neutral(self.model)
        self._kinematics(neutral)
        forward = self._sole(next(iter(self.frames))).rotation[:, 0]
        neutral[3:7] = pin.Quaternion(pin.rpy.rpyToMatrix(0, 0, -np.arctan2(forward[1], forward[0]))).coeffs()
        self._kinematics(neutral)
        poses = {name: self._sole(name) for name in self.frames}
        mean = np.mean([pose.translation for pose in poses.values()], axis=0)
        aside = {name: float((pose.translation - mean)[1]) for name, pose in poses.items()}
        half = max(float(np.ptp(np.array(f.sole.polygon)[:, 1])) / 2 for f in robot.feet.values()) + CLEAR / 2
        self.width = 2 * max(half, *map(abs, aside.values()))
        self.soles = {
            name: pin.SE3(np.eye(3), np.array([0.0, np.sign(y) * self.width / 2, 0.0]))
            for name, y in aside.items()
        }
        self.length = float(-mean[2])
        self.q = self._standing(neutral)

    def _leg(self, joint: int) -> list[int]:
        chain = list[int]()
        while joint > 1:
            chain.append(self.model.joints[joint].idx_v)
            joint = self.model.parents[joint]
        return chain

    def _kinematics(self, q: Array) -> None:
        pin.computeJointJacobians(self.model, self.data, q)

    def _sole(self, name: str) -> pin.SE3:
        joint, place = self.frames[name]
        return self.data.oMi[joint] * place

    def solve(self, q: Array, turned: Mapping[str, Array] | None = None) -> tuple[Array, float]:
        """The legs' angles that put the soles in place under the root of `q`, and how far they still are from it; each
        sole `turned` (3, 3) against the floor, as far as it would be if it were not pressed on it."""
        q = q.copy()
        left = np.inf
        soles = self.soles
        if turned is not None:
            soles = {name: pin.SE3(turned[name], sole.translation) for name, sole in soles.items()}
        for _ in range(STEPS):
            self._kinematics(q)
            left = 0.0
            for name, columns in self.legs.items():
                joint, place = self.frames[name]
                error = pin.log6(self._sole(name).actInv(soles[name])).vector
                left = max(left, float(np.abs(error).max()))
                jacobian = place.toActionMatrixInverse() @ pin.getJointJacobian(
                    self.model, self.data, joint, pin.LOCAL
                )
                own = jacobian[:, columns]
                step = own.T @ np.linalg.solve(own @ own.T + DAMPING * np.eye(6), error)
                moved = np.zeros(self.model.nv)
                moved[columns] = np.clip(step, -0.2, 0.2)
                q = pin.integrate(self.model, q, moved)
            q[7:] = np.clip(q[7:], self.model.lowerPositionLimit[7:], self.model.upperPositionLimit[7:])
            if left < CLOSE:
                break
        return q, left

    def _standing(self, neutral: Array) -> Array:
        """Crouched, its centre of mass over the middle of the bushes."""
        random = np.random.default_rng(0)
        found = None
        for _ in range(TRIES):
            q = neutral.copy()
            q[2] = (1 - CROUCH) * self.length
            for columns in self.legs.values():
                moved = np.zeros(self.model.nv)
                moved[columns] = random.uniform(-0.5, 0.5, len(columns))
                q = pin.integrate(self.model, q, moved)
            q, left = self.solve(q)
            if left < 1e-4 and (found is None or np.linalg.norm(q[7:]) < np.linalg.norm(found[7:])):
                found = q
        if found is None:
            raise ValueError(f"{self.robot.name}: no way to stand crouched")
        for _ in range(20):
            found[:2] -= self.lean(found)
            found, _ = self.solve(found)
        return found

    def lean(self, q: Array) -> Array:
        """The centre of mass from the middle of the bushes (2,) [m], forward and to the left."""
        centre = np.array(pin.centerOfMass(self.model, self.data, q))
        self._kinematics(q)
        bushes = []
        for foot in self.robot.feet.values():
            joint, place = self.robot.frame(foot.bush)
            bushes.append((self.data.oMi[joint + 1] * place).translation)
        return (centre - np.mean(bushes, axis=0))[:2]

    def share(self, column: int) -> float:
        """How far a joint is swung beside a light one, at most 1: less the more of the weight it carries aside."""
        joint = next(j for j in range(1, self.model.njoints) if self.model.joints[j].idx_v == column)
        pin.centerOfMass(self.model, self.data, self.q)
        arm = float(np.linalg.norm(self.data.com[joint])) * self.data.mass[joint]
        return float(min(1.0, HEAVY * self.data.mass[0] * self.length / max(arm, 1e-9)))
