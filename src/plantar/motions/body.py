"""Whole-body inverse kinematics of a robot whose feet stay where they stand."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
import pink
import pinocchio as pin
from numpy.typing import NDArray
from pink.limits import ConfigurationLimit
from pink.tasks import ComTask, FrameTask, PostureTask, Task

from plantar.conventions import Array
from plantar.errors import MotionError
from plantar.notes import listing
from plantar.robot.model import Placement, RobotModel

CHEST = "plantar.chest"
REACHED = 1e-3  # m: how far a foot or the chest may be from where it should be
STEPS = 3  # Gauss-Newton steps from one knot to the next
AT_LIMIT = 0.01  # rad from a limit: a joint stands at it
BENT = 0.5  # rad at most, by which joints of the legs are bent before a posture is looked for
MOVED = 0.1  # rad: less is no bending


class Body:
    """A robot with a floating base and frames on its soles and chest.

    The chest is the link that carries the IMU; its frame there has the robot's axes, x forward and z up, when every
    joint is at neutral. Raises MotionError where the robot has no IMU, fewer than two feet, or legs with joints that
    follow others.
    """

    def __init__(self, robot: RobotModel) -> None:
        if robot.imu is None or set(robot.feet) != {"left", "right"}:
            message = "motions are planned for a left and a right foot and a chest that carries an IMU"
            raise MotionError(message, path=robot.path, valid="a robot file with imu, left and right")
        if bound := sorted(robot.path_joints & robot.following_joints.keys()):
            message = f"motions are planned for joints that move by themselves, not for {listing(bound)}"
            raise MotionError(message, path=robot.urdf_path, valid="legs without <mimic>")
        self.robot = robot
        self.model = robot.floating_model.copy()
        self.chest_link = robot.imu.placement.link
        for name, foot in robot.feet.items():
            self._add_frame(self.sole(name), robot.frame(foot.sole.placement))
        joint, pose = robot.frame(Placement(self.chest_link, np.zeros(3), np.zeros(3)))
        self._add_frame(CHEST, (joint, pose * pin.SE3(self._axes_in(joint, pose), np.zeros(3))))
        self.data = self.model.createData()

    @staticmethod
    def sole(foot: str) -> str:
        """Name of the frame on a foot's sole."""
        return f"plantar.{foot}.sole"

    @cached_property
    def joints(self) -> tuple[str, ...]:
        return tuple(self.model.names)[2:]

    @cached_property
    def _places(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Where each joint's first number stands in a configuration, and which joints have cosine and sine there."""
        joints = tuple(self.model.joints)[2:]
        return np.array([joint.idx_q for joint in joints]), np.flatnonzero(
            [joint.nq == 2 for joint in joints]
        )

    @cached_property
    def _limit(self) -> ConfigurationLimit:
        return ConfigurationLimit(self.model, config_limit_gain=0.9)  # longer to make than to solve a step

    def neutral(self, posture: Mapping[str, float] | None = None) -> Array:
        """Configuration with the joints at `posture`, else at 0, and inside their limits with room to move."""
        q: Array = np.array(pin.neutral(self.model))
        for name, angle in (posture or {}).items():
            self._set(q, name, angle)
        room = 0.1
        for joint in self.model.joints[2:]:
            if joint.nq == 1:
                low, high = (
                    self.model.lowerPositionLimit[joint.idx_q],
                    self.model.upperPositionLimit[joint.idx_q],
                )
                margin = min(room, (high - low) / 4) if posture is None else 0.0
                if low < high:
                    q[joint.idx_q] = np.clip(q[joint.idx_q], low + margin, high - margin)
        return q

    @cached_property
    def leg_joints(self) -> frozenset[int]:
        """Numbers of the joints that carry a foot, the root's among them."""
        frames = [self.model.frames[self.model.getFrameId(self.sole(foot))] for foot in self.robot.feet]
        return frozenset(joint for frame in frames for joint in self.model.supports[frame.parentJoint])

    @cached_property
    def _bounded(self) -> NDArray[np.intp]:
        """Where the legs' joints that have limits stand in a configuration."""
        places = [
            self.model.joints[joint].idx_q for joint in self.leg_joints if self.model.joints[joint].nq == 1
        ]
        low, high = self.model.lowerPositionLimit[places], self.model.upperPositionLimit[places]
        return np.array(places, dtype=np.intp)[np.flatnonzero(low < high)]

    def bent(self, q: Array) -> Array:
        """A copy of `q` with every joint of the legs towards the middle of its range: knees bend the right way."""
        bent, places = q.copy(), self._bounded
        middle = (self.model.lowerPositionLimit + self.model.upperPositionLimit)[places] / 2
        bent[places] = np.clip(middle, -BENT, BENT)
        return bent

    def room(self, q: Array, moved: Array) -> float:
        """The least room [rad] that a joint of the legs has at `q`, the way it came by `moved` (nq,): of those that
        moved."""
        places = self._bounded[np.abs(moved[self._bounded]) > MOVED]
        low, high = self.model.lowerPositionLimit[places], self.model.upperPositionLimit[places]
        return float(np.min(np.where(moved[places] > 0, high - q[places], q[places] - low), initial=np.inf))

    def at_limits(self, q: Array) -> str:
        """Which joints of the legs are at their limits, as the end of a sentence; nothing where none is."""
        places = self._bounded
        low, high = self.model.lowerPositionLimit[places], self.model.upperPositionLimit[places]
        numbers = {self.model.joints[joint].idx_q: joint for joint in self.leg_joints}
        at = places[np.minimum(q[places] - low, high - q[places]) < AT_LIMIT]
        names = [self.model.names[numbers[place]] for place in at]
        limits = "its limit" if len(names) == 1 else "their limits"
        return f", with {listing(names)} at {limits}" if names else ""

    def shifted(self, q: Array, posture: Mapping[str, float]) -> Array:
        """A copy of `q` with some joints set."""
        changed = q.copy()
        for name, angle in posture.items():
            self._set(changed, name, angle)
        return changed

    def pose(self, q: Array, frame: str) -> pin.SE3:
        """Pose of a frame in the world."""
        pin.framesForwardKinematics(self.model, self.data, q)
        return self.data.oMf[self.model.getFrameId(frame)].copy()

    def centre_of_mass(self, q: Array) -> Array:
        return np.array(pin.centerOfMass(self.model, self.data, q))

    def positions(self, q: Array) -> Array:
        """Joint positions, one a joint, in the order of `joints`."""
        places, circles = self._places
        found = q[places]
        found[circles] = np.arctan2(q[places[circles] + 1], q[places[circles]])
        return np.asarray(found)

    def solve(self, q: Array, tasks: list[Task], posture: Array, steps: int) -> Array:
        """`steps` Gauss-Newton steps towards the tasks, `posture` where they leave freedom."""
        rest = PostureTask(cost=1e-2, gain=0.3)
        rest.set_target(posture)
        configuration = pink.Configuration(self.model, self.data, q, copy_data=False)
        for _ in range(steps):
            velocity = pink.solve_ik(
                configuration,
                [*tasks, rest],
                1.0,
                solver="daqp",
                limits=[self._limit],
                damping=1e-9,
                safety_break=False,
            )
            configuration.integrate_inplace(velocity, 1.0)
        return np.array(configuration.q)

    def foot_tasks(self, soles: Mapping[str, pin.SE3]) -> list[Task]:
        """Soles held at their poses in the world."""
        tasks = []
        for name, target in soles.items():
            task = FrameTask(self.sole(name), position_cost=100.0, orientation_cost=100.0)
            task.set_target(target)
            tasks.append(task)
        return tasks

    def chest_task(self, target: pin.SE3, *, position: bool = True) -> FrameTask:
        task = FrameTask(CHEST, position_cost=10.0 if position else 0.0, orientation_cost=3.0)
        task.set_target(target)
        return task

    def root_task(self, target: pin.SE3) -> FrameTask:
        """The root link's attitude in the world; its place costs nothing."""
        task = FrameTask(self.robot.model.frames[1].name, position_cost=0.0, orientation_cost=1.0)
        task.set_target(target)
        return task

    def centre_task(self, target: Array, *, height: float = 0.0) -> ComTask:
        """Centre of mass over a point; `height` is the cost of its z."""
        task = ComTask(cost=np.array([10.0, 10.0, height]))
        task.set_target(target)
        return task

    def _set(self, q: Array, name: str, angle: float) -> None:
        joint = self.model.joints[self.model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = angle if joint.nq == 1 else (np.cos(angle), np.sin(angle))

    def _axes_in(self, joint: int, pose: pin.SE3) -> Array:
        """The robot's axes, forward, left and up at neutral, in a frame that is fixed to a joint: (3, 3)."""
        self.data = self.model.createData()
        q = self.neutral()
        yaw = self.heading(q)
        pin.framesForwardKinematics(self.model, self.data, q)
        frame = self.data.oMi[self._carrier(joint)] * pose
        return np.array(frame.rotation.T @ pin.exp3(np.array([0.0, 0.0, yaw])))

    def heading(self, q: Array) -> float:
        """Angle [rad] about the world's z axis from x to where the soles point."""
        forward = sum(
            (self.pose(q, self.sole(name)).rotation[:, 0] for name in self.robot.feet), start=np.zeros(3)
        )
        return float(np.arctan2(forward[1], forward[0]))

    def _carrier(self, joint: int) -> int:
        """A joint of the robot's model in the floating one; the root link's is the free-flyer."""
        return int(self.model.getJointId(self.robot.model.names[joint])) if joint else 1

    def _add_frame(self, name: str, place: tuple[int, pin.SE3]) -> None:
        joint, pose = place
        self.model.addFrame(pin.Frame(name, self._carrier(joint), 0, pose, pin.FrameType.OP_FRAME), False)
