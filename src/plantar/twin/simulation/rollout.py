"""The physics of one motion: MuJoCo steps, sampled at 200 Hz, exact and without noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.errors import MotionError
from plantar.motions.plan import RATE, Plan
from plantar.robot.model import RobotModel
from plantar.twin.robots.description import Description
from plantar.twin.simulation.mjcf import SERVO_TIME, Scene, mjcf_text, quaternion_from_rotation
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.stepping import Force, Stepper
from plantar.twin.walking.control import WalkingControl

FALLEN = 0.35  # rad: a root this far from its plan is no longer balancing


@dataclass(frozen=True)
class Rollout:
    """What happened, at the plan's time (N,): every array exact, in the world or in MuJoCo's sensors' frames.

    `base` (N, 7) root position and quaternion w x y z; `positions`, `velocities`, `efforts` (N, n) in the order
    of `joints`; `sensors`: by MJCF sensor name (N, k); `bush`: by foot, (N, 3) z, pitch, roll; `bush_rates` the
    same; `rubber`: by foot, (N, 2) torque of what stands beside the linear spring, pitch and roll.
    """

    name: str
    time: Array
    joints: tuple[str, ...]
    base: Array
    positions: Array
    velocities: Array
    efforts: Array
    sensors: Mapping[str, Array]
    bush: Mapping[str, Array]
    bush_rates: Mapping[str, Array]
    rubber: Mapping[str, Array]
    hand: Array


def scene_xml(robot: RobotModel, plan: Plan, physics: Physics, look: Description | None = None) -> str:
    """The MJCF that a rollout of `plan` steps through."""
    held = None if plan.hand is None else plan.hand.held
    hand = (plan.hand.spring, plan.hand.damper) if plan.hand else (0.0, 0.0)
    scene = Scene(physics.floor, physics.friction, held, hand, physics.timestep)
    return mjcf_text(robot, physics.bushes, scene, look)


def roll_out(
    robot: RobotModel,
    plan: Plan,
    physics: Physics,
    xml: str,
    progress: Callable[[float], None] | None = None,
    force: Callable[[mujoco.MjModel], Force] | None = None,
) -> Rollout:
    """Play a plan on the scene `xml` (from `scene_xml`). Releases the GIL while it steps.

    `progress` is called once a second of motion with the share done; `force` makes, for the scene's model, what each
    step calls to apply a force of its own. Raises MotionError when the robot falls.
    """
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    joints = tuple(model.joint(place).name for place in range(1, model.njnt))
    joints = tuple(name for name in joints if name in plan.joints)
    control = _targets(plan, joints, physics.timestep)
    _place(data, plan, joints)
    stepper = Stepper(model, data, physics, robot, None if force is None else force(model))
    parts = control.shape[0] // plan.time.size
    walking = None if plan.walk is None else WalkingControl(model, robot, plan, physics, joints)
    if walking is None:
        stepper.blind(np.repeat(control[:1], round(physics.settle / physics.timestep), axis=0))
    else:
        stand = np.repeat(control[:1], parts, axis=0)
        for _ in range(round(physics.settle * RATE)):
            stepper.sensed(stand[0] + walking.correction)
            stepper.blind(walking.led(0, data, stand)[1:])
    recorder = _Recorder(model, joints, robot, plan.time.size)
    for sample in range(plan.time.size):
        stepper.at(plan.time[sample])
        recorder.place(sample, data)
        rows = control[sample * parts : (sample + 1) * parts]
        stepper.sensed(rows[0] if walking is None else rows[0] + walking.correction)
        recorder.outputs(sample, data)
        stepper.blind((rows if walking is None else walking.led(sample, data, rows))[1:])
        _check_upright(plan, sample, data)
        if progress is not None and sample % int(RATE) == 0:
            progress(sample / plan.time.size)
    return recorder.finish(plan)


class _Recorder:
    """Arrays that fill up sample by sample."""

    def __init__(self, model: mujoco.MjModel, joints: tuple[str, ...], robot: RobotModel, size: int) -> None:
        self.model, self.joints = model, joints
        self.feet = [foot for foot in robot.feet if _has_joint(model, f"{foot}.z")]
        self.all_feet = tuple(robot.feet)
        self.qpos, self.qvel = np.empty((size, model.nq)), np.empty((size, model.nv))
        self.sensors = np.empty((size, model.nsensordata))
        self.effort = np.empty((size, model.nu))
        self.applied = np.empty((size, model.nv))

    def place(self, sample: int, data: mujoco.MjData) -> None:
        self.qpos[sample] = data.qpos

    def outputs(self, sample: int, data: mujoco.MjData) -> None:
        self.qvel[sample] = data.qvel
        self.sensors[sample], self.effort[sample] = data.sensordata, data.actuator_force
        self.applied[sample] = data.qfrc_applied

    def finish(self, plan: Plan) -> Rollout:
        model, count, size = self.model, len(self.joints), len(self.qpos)
        q = [int(model.joint(name).qposadr[0]) for name in self.joints]
        v = [int(model.joint(name).dofadr[0]) for name in self.joints]
        bush = {f: [f"{f}.z", f"{f}.pitch", f"{f}.roll"] for f in self.feet}
        still = {f: np.zeros((size, 3)) for f in self.all_feet}

        def columns(array: Array, address: str) -> dict[str, Array]:
            return still | {
                f: array[:, [int(getattr(model.joint(name), address)[0]) for name in names]]
                for f, names in bush.items()
            }

        sensors = {
            (s := model.sensor(i)).name: self.sensors[:, int(s.adr[0]) : int(s.adr[0] + s.dim[0])]
            for i in range(model.nsensor)
        }
        return Rollout(
            plan.name, plan.time, self.joints, self.qpos[:, :7], self.qpos[:, q], self.qvel[:, v],
            self.effort[:, :count], sensors, columns(self.qpos, "qposadr"), columns(self.qvel, "dofadr"),
            {f: -part[:, 1:] for f, part in columns(self.applied, "dofadr").items()}, self.effort[:, count:],
        )  # fmt: skip


def _has_joint(model: mujoco.MjModel, name: str) -> bool:
    return bool(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) >= 0)


def _targets(plan: Plan, joints: tuple[str, ...], timestep: float) -> Array:
    """Inputs of the servos, then of the hand where there is one, at every step, (M, nu).

    Targets that jump less often shake the links, and the accelerometer aliases it. A servo is kp (target - q) - kv q̇;
    the planned rate times kv/kp on top of the target makes it follow the rate too.
    """
    steps = round(1 / (RATE * timestep))
    fine = np.minimum(np.arange(plan.time.size * steps) * timestep, plan.time[-1])
    spline = CubicSpline(plan.time, plan.positions[:, [plan.joints.index(name) for name in joints]])
    control = np.asarray(spline(fine) + SERVO_TIME * spline(fine, 1))
    if plan.hand is None:
        return control
    path = CubicSpline(plan.time, plan.hand.path)
    return np.hstack([control, path(fine) + plan.hand.damper / plan.hand.spring * path(fine, 1)])


def _place(data: mujoco.MjData, plan: Plan, joints: tuple[str, ...]) -> None:
    data.qpos[:3] = plan.base[0, :3, 3]
    data.qpos[3:7] = quaternion_from_rotation(plan.base[0, :3, :3])
    for name in joints:
        data.joint(name).qpos[0] = plan.positions[0, plan.joints.index(name)]


def _check_upright(plan: Plan, sample: int, data: mujoco.MjData) -> None:
    w, x, y, z = data.qpos[3:7].tolist()
    up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])  # in the root
    lean = np.arccos(min(1.0, float(plan.base[sample, 2, :3] @ up)))  # yaw never lets a robot fall
    if not lean < FALLEN:
        message = f"{plan.name}: the robot falls, it leans {np.degrees(lean):.0f}° away from its plan"
        fell = float(plan.time[sample])
        raise MotionError(message, time=fell, valid="a smaller or slower motion", fell=fell)
