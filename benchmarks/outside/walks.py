"""Walks in plain MuJoCo: plantar plans the steps and keeps the robot up, everything else is this folder's own.

The controller is told rubber that is a little wrong, as a lab's would be.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import mujoco
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from outside.physics import SERVO_DAMPING, Motion, play
from outside.rubber import Rubber
from plantar.conventions import Array
from plantar.motions.plan import RATE, Plan
from plantar.robot.model import RobotModel
from plantar.twin.bush import Bush
from plantar.twin.play import planned
from plantar.twin.simulation.physics import Physics
from plantar.twin.walking.control import WalkingControl

WALKS = ("Walk8", "Walk12", "WalkQuick8", "WalkTurn", "Walk10")  # the last one validates
FALLEN = 0.5  # rad away from how the trunk began
TOLD = 0.9  # times the rubber's stiffness, that the controller is told
PARTS = round(1000 / RATE)


def walked(robot: RobotModel, name: str, rubber: Mapping[str, Rubber], gears: float = 0.0) -> Motion | None:
    """One walk; None where the robot falls. Raises MotionError where its legs do not reach."""
    plan = planned(name, robot)
    order = [plan.joints.index(joint) for joint in robot.joint_names]
    spline = CubicSpline(plan.time, plan.positions[:, order])
    fine = np.arange(0, plan.time[-1], 1 / (RATE * PARTS))
    targets = spline(fine) + SERVO_DAMPING * spline(fine, 1)
    start = plan.base[0]
    turn = Rotation.from_matrix(start[:3, :3]).as_quat(scalar_first=True)

    def leads(model: mujoco.MjModel) -> Callable[[int, mujoco.MjData], Array]:
        return _lead(model, robot, plan, rubber)

    motion = play(robot, np.r_[start[:3, 3], turn], targets, rubber, leads, gears)
    up = Rotation.from_quat(motion.orientation, scalar_first=True).as_matrix()[:, 2]  # in the IMU's axes
    leant = np.arccos(np.clip(up @ up[0], -1, 1))
    return motion if leant.max() < FALLEN else None


def _lead(
    model: mujoco.MjModel, robot: RobotModel, plan: Plan, rubber: Mapping[str, Rubber]
) -> Callable[[int, mujoco.MjData], Array]:
    control = WalkingControl(model, robot, plan, Physics(_told(rubber)), robot.joint_names)
    still = np.zeros((PARTS, len(robot.joint_names)))
    ahead, step = still, 0

    def lead(row: int, data: mujoco.MjData) -> Array:
        nonlocal ahead, step
        if step % PARTS == 0:
            ahead = control.led(row // PARTS, data, still)
        step += 1
        return ahead[(step - 1) % PARTS]

    return lead


def _told(rubber: Mapping[str, Rubber]) -> dict[str, Bush]:
    found = {}
    for foot, each in rubber.items():
        pitch, roll = each.pitch, each.roll
        found[foot] = Bush(
            TOLD * pitch.stiffness, pitch.damping, TOLD * roll.stiffness, roll.damping, each.stiffness, each.damping
        )  # fmt: skip
    return found
