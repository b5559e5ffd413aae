"""The physics of one motion: MuJoCo steps, sampled at 200 Hz, exact and without noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.errors import MotionError, located
from plantar.motions.plan import RATE, Plan
from plantar.robot import RobotModel
from plantar.twin.description import Description
from plantar.twin.mjcf import SERVO_TIME, Scene, mjcf_text, quaternion_from_rotation
from plantar.twin.physics import Physics
from plantar.twin.rubber import Rubber

CONTROL_RATE = (
    4000.0  # Hz, every step: targets that jump less often shake the links, and the accelerometer aliases it
)
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
) -> Rollout:
    """Play a plan on the scene `xml` (from `scene_xml`). Releases the GIL while it steps.

    `progress` is called once a second of motion with the share done. Raises MotionError when the robot falls.
    """
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    joints = tuple(model.joint(place).name for place in range(1, model.njnt))
    joints = tuple(name for name in joints if name in plan.joints)
    control, anchor = _targets(plan, joints)
    _place(data, plan, joints)
    stepper = _Stepper(model, data, physics, robot)
    per_control = round(1 / (CONTROL_RATE * physics.timestep))
    controls = round(CONTROL_RATE / RATE)
    data.ctrl[: len(joints)] = control[0]
    if anchor is not None:
        data.ctrl[len(joints) :] = anchor[0]
    stepper.step(round(physics.settle / physics.timestep))
    recorder = _Recorder(model, joints, robot, plan.time.size)
    for sample in range(plan.time.size):
        stepper.at(plan.time[sample])
        recorder.state(sample, data)
        for part in range(controls):
            data.ctrl[: len(joints)] = control[sample * controls + part]
            if anchor is not None:
                data.ctrl[len(joints) :] = anchor[sample * controls + part]
            if part == 0:
                # sensors and efforts belong to the state a step starts from
                stepper.step(1)
                recorder.outputs(sample, data, stepper)
                stepper.step(per_control - 1)
            else:
                stepper.step(per_control)
        _check_upright(plan, sample, data)
        if progress is not None and sample % int(RATE) == 0:
            progress(sample / plan.time.size)
    return recorder.finish(plan)


class _Stepper:
    """Steps the model, with the rubber and the slippery seconds that MuJoCo does not know."""

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, physics: Physics, robot: RobotModel
    ) -> None:
        self.model, self.data, self.physics = model, data, physics
        self.rubber: dict[str, Rubber] = {}
        self.columns: dict[str, list[int]] = {}
        if physics.bushes is None:
            return
        for foot in robot.feet:
            self.columns[foot] = [int(model.joint(f"{foot}.{axis}").dofadr[0]) for axis in ("pitch", "roll")]
            if not physics.bushes[foot].is_linear:
                self.rubber[foot] = Rubber(physics.bushes[foot])
        self.angles = {
            foot: [int(model.joint(f"{foot}.{axis}").qposadr[0]) for axis in ("pitch", "roll")]
            for foot in self.rubber
        }

    def at(self, time: float) -> None:
        """Set the floor's friction for this moment."""
        friction = self.physics.friction
        for slip in self.physics.slips:
            if slip.start <= time < slip.end:
                friction = slip.friction
        self.model.geom_friction[0, 0] = friction

    def step(self, count: int) -> None:
        if not self.rubber:
            mujoco.mj_step(self.model, self.data, count)
            return
        qpos, applied = self.data.qpos, self.data.qfrc_applied
        for _ in range(count):
            for foot, rubber in self.rubber.items():
                (pitch, roll), (pitch_dof, roll_dof) = self.angles[foot], self.columns[foot]
                applied[pitch_dof] = -rubber.pitch.torque(qpos[pitch])
                applied[roll_dof] = -rubber.roll.torque(qpos[roll])
            mujoco.mj_step(self.model, self.data)


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

    def state(self, sample: int, data: mujoco.MjData) -> None:
        self.qpos[sample], self.qvel[sample] = data.qpos, data.qvel

    def outputs(self, sample: int, data: mujoco.MjData, stepper: _Stepper) -> None:
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


def _targets(plan: Plan, joints: tuple[str, ...]) -> tuple[Array, Array | None]:
    """Servo targets at the control rate, (M, n), and the hand's, (M, 3) or None.

    A servo is kp (target - q) - kv q̇; the planned rate times kv/kp on top of the target makes it follow the rate too.
    """
    fine = np.arange(plan.time.size * round(CONTROL_RATE / RATE)) / CONTROL_RATE
    fine = np.minimum(fine, plan.time[-1])
    spline = CubicSpline(plan.time, plan.positions[:, [plan.joints.index(name) for name in joints]])
    control = spline(fine) + SERVO_TIME * spline(fine, 1)
    if plan.hand is None:
        return control, None
    path = CubicSpline(plan.time, plan.hand.path)
    return control, path(fine) + plan.hand.damper / plan.hand.spring * path(fine, 1)


def _place(data: mujoco.MjData, plan: Plan, joints: tuple[str, ...]) -> None:
    data.qpos[:3] = plan.base[0, :3, 3]
    data.qpos[3:7] = quaternion_from_rotation(plan.base[0, :3, :3])
    for name in joints:
        data.joint(name).qpos[0] = plan.positions[0, plan.joints.index(name)]


def _check_upright(plan: Plan, sample: int, data: mujoco.MjData) -> None:
    planned = quaternion_from_rotation(plan.base[sample, :3, :3])
    lean = 2 * np.arccos(min(1.0, abs(float(planned @ data.qpos[3:7]))))
    if not lean < FALLEN:
        message = f"{plan.name}: the robot falls, it leans {np.degrees(lean):.0f}° away from its plan"
        raise MotionError(located(message, time=float(plan.time[sample]), valid="a smaller or slower motion"))
