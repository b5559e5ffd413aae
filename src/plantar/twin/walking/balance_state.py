"""How a walking robot stands as its own sensors tell it: lean, centre of mass, load and torque of each foot.

The stabiliser's sensors are exact, at 200 Hz: what a log's sensors add comes afterwards, in `sensors`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.motions.plan import Plan
from plantar.robot.model import RobotModel

TOUCHING: Final = 1.0  # N: less is no load to speak of


@dataclass(frozen=True)
class State:
    """One sample. `lean` (3,) [rad]: rotation of the root away from its plan, about the world's axes, yaw left out;
    `centre` and `centre_rate` (3,) [m, m/s]: of mass, in the plan's world; by foot, `load` [N] and `torque` (2,) [N·m]
    about the bush's roll and pitch axes, and `place` (3,) [m] of the bush's centre as planned.
    """

    lean: Array
    centre: Array
    centre_rate: Array
    load: Mapping[str, float]
    torque: Mapping[str, Array]
    place: Mapping[str, Array]


class StateEstimator:
    """Reads a model's state as the robot can: its encoders, its attitude and turn rate, its force sensors.

    Where it stands in the plan's world follows from the feet that carry it: their bushes are over where they should
    be. A foot that has slipped is believed at its planned place, as on a robot without cameras; so is the yaw.
    """

    def __init__(self, model: mujoco.MjModel, robot: RobotModel, plan: Plan, joints: tuple[str, ...]) -> None:
        self.plan, self.joints = plan, joints
        self.model = robot.floating_model.copy()
        self.feet = tuple(robot.feet)
        self.frames = {}
        for name, foot in robot.feet.items():
            joint, pose = robot.frame(foot.bush)
            carrier = int(self.model.getJointId(robot.model.names[joint])) if joint else 1
            frame = pin.Frame(f"plantar.{name}.bush", carrier, 0, pose, pin.FrameType.OP_FRAME)
            self.frames[name] = int(self.model.addFrame(frame, False))
        self.data = self.model.createData()
        self._neutral: Array = pin.neutral(self.model)
        self._joints = [self.model.joints[self.model.getJointId(name)] for name in joints]
        self._q = [int(model.joint(name).qposadr[0]) for name in joints]
        self._v = [int(model.joint(name).dofadr[0]) for name in joints]
        self._sensors = {
            (foot, kind): int(model.sensor(f"{foot}.{kind}").adr[0])
            for foot in self.feet
            for kind in ("force", "torque")
        }
        assert plan.walk is not None
        self._places = {}
        for name, foot in robot.feet.items():
            to_bush = (robot.frame(foot.sole.placement)[1].inverse() * robot.frame(foot.bush)[1]).homogeneous
            self._places[name] = (plan.walk.soles[name] @ to_bush)[:, :3, 3]

    def configuration(self, positions: Array, base: pin.SE3) -> Array:
        """Pinocchio's q for joint positions in the order of `joints`."""
        q = self._neutral.copy()
        q[:7] = pin.SE3ToXYZQUAT(base)
        for joint, value in zip(self._joints, positions, strict=True):
            q[joint.idx_q : joint.idx_q + joint.nq] = (
                value if joint.nq == 1 else (np.cos(value), np.sin(value))
            )
        return q

    def read(self, sample: int, data: mujoco.MjData) -> State:
        """The state at the plan's sample, from the engine's state and the sensors of its last step."""
        planned = self.plan.base[sample, :3, :3]
        measured = pin.Quaternion(*data.qpos[3:7]).toRotationMatrix()
        away = measured @ planned.T
        yaw = np.arctan2(away[1, 0] - away[0, 1], away[0, 0] + away[1, 1])
        measured = pin.exp3(np.array([0.0, 0.0, -yaw])) @ measured
        q = self.configuration(data.qpos[self._q], pin.SE3(measured, np.zeros(3)))
        v = np.zeros(self.model.nv)
        v[3:6] = data.qvel[3:6]
        for joint, at in zip(self._joints, self._v, strict=True):
            v[joint.idx_v] = data.qvel[at]
        centre = np.array(pin.centerOfMass(self.model, self.data, q, v))
        rate = np.array(self.data.vcom[0])
        load: dict[str, float] = {}
        torque: dict[str, Array] = {}
        place: dict[str, Array] = {}
        for foot in self.feet:
            at = self._sensors[foot, "force"]
            load[foot] = max(
                -float(data.sensordata[at + 2]), 0.0
            )  # the parent's action on the child: the opposite
            at = self._sensors[foot, "torque"]
            torque[foot] = -np.array(data.sensordata[at : at + 2])
            place[foot] = self._places[foot][sample]
        total = max(sum(load.values()), TOUCHING)
        for foot, frame in self.frames.items():
            share = load[foot] / total
            pose = pin.updateFramePlacement(self.model, self.data, frame)
            centre += share * (place[foot] - pose.translation)
            moved = pin.getFrameVelocity(self.model, self.data, frame, pin.LOCAL_WORLD_ALIGNED).linear
            rate -= share * np.array(moved)
        return State(pin.log3(measured @ planned.T), centre, rate, load, torque, place)
