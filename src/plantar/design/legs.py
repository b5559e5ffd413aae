"""From displacements of the body to every joint: the legs hold the soles and carry the centre of mass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import pinocchio as pin

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.design.arms import arm_swing
from plantar.design.family import CHANNELS
from plantar.errors import MotionError
from plantar.motions.body import Body
from plantar.motions.stance import Stance, stand
from plantar.motions.upper import upper_joints
from plantar.motions.walk import SETTLED
from plantar.robot.model import RobotModel

STEPS: Final = 4  # Newton steps from one time to the next
REACHED: Final = 1e-6  # m and rad: less is not worth a step
MISSED: Final = 1e-3  # m and rad: more is out of reach
RISE: Final = 0.03  # of the centre of mass' height: knees are bent so far that the robot can rise by it
LOWERED: Final = np.arange(0.0, 0.151, 0.01)  # of that height: tried in this order
SPARE: Final = 0.03  # rad of every joint of the legs to its limit while standing
DAMPING: Final = 1e-8  # of the least squares: a leg that is nearly straight turns slowly instead of wildly


@dataclass(frozen=True)
class Legs:
    """A robot on two soles whose legs follow. `start`: where it stands; `upper` (nq,): a configuration that
    the joints of no leg keep; `arms` (nv,): joints of one swing [rad]."""

    body: Body
    start: Stance
    upper: Array
    arms: Array

    @classmethod
    def of(cls, robot: RobotModel, posture: Mapping[str, float] | None, ahead: float = 0.0) -> Legs:
        """A robot that stands in `posture`, or with bent knees and all else at neutral where None, the right foot
        `ahead` [m] of the left one."""
        body = Body(robot)
        start = stand(body, posture, {"right": (ahead, 0.0)})
        upper = start.configuration if posture is not None else body.neutral()
        return cls(body, start, upper, arm_swing(body, upper))

    @cached_property
    def model(self) -> pin.Model:
        """The body's model with a frame at each bush centre."""
        model, robot = self.body.model.copy(), self.body.robot
        for foot, entry in robot.feet.items():
            joint, pose = robot.frame(entry.bush)
            carrier = model.getJointId(robot.model.names[joint])
            model.addFrame(pin.Frame(self.bushes[foot], carrier, 0, pose, pin.FrameType.OP_FRAME), False)
        return model

    @cached_property
    def data(self) -> pin.Data:
        return self.model.createData()

    @cached_property
    def bushes(self) -> Mapping[str, str]:
        """Names of the frames at the bush centres, by foot."""
        return {foot: f"plantar.{foot}.bush" for foot in self.body.robot.feet}

    @cached_property
    def columns(self) -> Array:
        """Velocity indices that follow: the root and the joints of the legs."""
        free = {self.model.joints[self.model.getJointId(name)].idx_v for name in upper_joints(self.body)}
        return np.array([place for place in range(self.model.nv) if place not in free])

    @cached_property
    def rest(self) -> tuple[Array, Array, dict[str, pin.SE3]]:
        """Standing still: the configuration with the centre of mass over the middle of the bushes, that centre, and
        the bushes' poses. There no bush bends, so that soft feet carry the robot upright."""
        q = self.start.configuration
        root = pin.XYZQUATToSE3(q[:7]).rotation
        upright = pin.rpy.rotate("z", float(np.arctan2(root[1, 0], root[0, 0])))
        poses = {foot: self._pose(q, frame) for foot, frame in self.bushes.items()}
        high = np.array(pin.centerOfMass(self.model, self.data, q))
        high[:2] = np.mean([pose.translation[:2] for pose in poses.values()], axis=0)
        bent = self.body.bent(q)
        for lower in LOWERED:
            centre = high * [1.0, 1.0, 1.0 - lower]
            tasks = [
                *self.body.foot_tasks(self.start.soles),
                self.body.root_task(pin.SE3(upright, np.zeros(3))),
            ]
            near = self.body.solve(bent, [*tasks, self.body.centre_task(centre, height=10.0)], bent, SETTLED)
            try:
                near = self._with_legs_of(near, self.upper)
                q = self.solve(near, upright, centre, poses, SETTLED)
                higher = self.solve(q, upright, centre * [1.0, 1.0, 1.0 + RISE], poses, SETTLED)
            except MotionError:
                continue
            if self._inside(q) and self._inside(higher):
                return q, centre, poses
        message = "the legs cannot carry the body over its feet with bent knees"
        raise MotionError(message, path=self.body.robot.name, valid="legs of six joints each")

    @property
    def ahead(self) -> float:
        """How far the right sole stands ahead of the left one [m]."""
        left, right = (self.start.soles[foot].translation for foot in ("left", "right"))
        return float(right[0] - left[0])

    @cached_property
    def directions(self) -> Array:
        """Columns (3, 3) in which the channels move the centre of mass: across the line through the bushes, about which
        soft feet let the body lean, along it, and up."""
        left, right = (self.rest[2][foot].translation for foot in ("left", "right"))
        along = (left - right) * [1.0, 1.0, 0.0] / np.linalg.norm((left - right)[:2])
        up = np.array([0.0, 0.0, 1.0])
        return np.column_stack([np.cross(along, up), along, up])

    @cached_property
    def _bounded(self) -> list[tuple[int, float, float]]:
        """Of the legs' joints that have limits, the place in a configuration and both limits."""
        low, high = self.model.lowerPositionLimit, self.model.upperPositionLimit
        single = (joint for joint in self.model.joints[2:] if joint.nq == 1)
        places = [joint.idx_q for joint in single if joint.idx_v in self.columns]
        return [(place, low[place], high[place]) for place in places if low[place] < high[place]]

    def _inside(self, q: Array) -> bool:
        """Whether every bounded joint of the legs is within its limits, with a little room."""
        return all(low + SPARE <= q[place] <= high - SPARE for place, low, high in self._bounded)

    def follow(self, displacements: Array) -> Array:
        """Configurations (N, nq) of displacements (channels, N), each found from the one before."""
        rest, centre, poses = self.rest
        upright = self._pose(rest, self.body.robot.model.frames[1].name).rotation
        q, found = rest, np.empty((displacements.shape[1], rest.size))
        for row, value in enumerate(displacements.T):
            moved = dict(zip(CHANNELS, value, strict=True))
            if row and np.array_equal(value, displacements[:, row - 1]):
                found[row] = q
                continue
            swung = pin.integrate(self.model, rest, moved["arms"] * self.arms)
            q = self._with_legs_of(q, swung)
            target = centre + self.directions @ [moved["centre.x"], moved["centre.y"], moved["centre.z"]]
            trunk = pin.rpy.rpyToMatrix(moved["trunk.roll"], moved["trunk.pitch"], 0.0) @ upright
            tilted = {
                foot: pose * pin.SE3(_turned(moved[f"{foot}.pitch"], moved[f"{foot}.roll"]), np.zeros(3))
                for foot, pose in poses.items()
            }
            q = self.solve(q, trunk, target, tilted, STEPS)
            found[row] = q
        return found

    def solve(
        self, q: Array, trunk: Array, centre: Array, bushes: Mapping[str, pin.SE3], steps: int
    ) -> Array:
        """Newton steps of root and legs to the root's attitude, the centre of mass and the bushes' poses.

        Raises MotionError where they are out of reach.
        """
        model, columns = self.model, self.columns
        missed = np.inf
        for _ in range(steps + 1):
            error, rows = self._missed(q, trunk, centre, bushes)
            missed = float(np.abs(error).max())
            if missed < REACHED:
                return q
            matrix = rows[:, columns]
            step = matrix.T @ np.linalg.solve(matrix @ matrix.T + DAMPING * np.eye(len(matrix)), error)
            change = np.zeros(model.nv)
            change[columns] = step
            q = pin.integrate(model, q, change)
        if missed > MISSED:
            message = f"the legs cannot reach their places, they miss by {1e3 * missed:.1f} mm or mrad"
            raise MotionError(message, path=self.body.robot.name, valid="a smaller motion")
        return q

    def _missed(
        self, q: Array, trunk: Array, centre: Array, bushes: Mapping[str, pin.SE3]
    ) -> tuple[Array, Array]:
        """What is missing to the targets (m,), and how it goes with the velocities, (m, nv)."""
        model, data = self.model, self.data
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        root = model.getFrameId(self.body.robot.model.frames[1].name)
        errors = [pin.log3(data.oMf[root].rotation.T @ trunk)]
        rows = [pin.getFrameJacobian(model, data, root, pin.LOCAL)[3:]]
        rows.append(pin.jacobianCenterOfMass(model, data, q))
        errors.append(centre - data.com[0])
        for foot, pose in bushes.items():
            frame = model.getFrameId(self.bushes[foot])
            errors.append(pin.log6(data.oMf[frame].actInv(pose)).vector)
            rows.append(pin.getFrameJacobian(model, data, frame, pin.LOCAL))
        return np.concatenate(errors), np.vstack(rows)

    def _with_legs_of(self, legs: Array, upper: Array) -> Array:
        """The configuration `upper` with the root and the joints of the legs from `legs`."""
        q = upper.copy()
        q[:7] = legs[:7]
        for place in self.columns[6:]:
            joint = next(j for j in self.model.joints if j.idx_v <= place < j.idx_v + j.nv)
            q[joint.idx_q : joint.idx_q + joint.nq] = legs[joint.idx_q : joint.idx_q + joint.nq]
        return q

    def _pose(self, q: Array, frame: str) -> pin.SE3:
        pin.framesForwardKinematics(self.model, self.data, q)
        return self.data.oMf[self.model.getFrameId(frame)].copy()


def _turned(pitch: float, roll: float) -> Array:
    """Rotation of an ankle that lets the sole beneath it be bent by -pitch and -roll: the inverse of Ry·Rx of those."""
    assert ROTATIONAL_AXES == ("pitch", "roll")
    return np.asarray((pin.rpy.rotate("y", -pitch) @ pin.rpy.rotate("x", -roll)).T)
