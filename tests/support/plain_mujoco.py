"""A robot's URDF in plain MuJoCo: servos play a table of joint positions, soles hang on hinges with springs.

Nothing of the twin is used: MuJoCo reads the URDF, the rest is added here. What the sensors read is exact.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from plantar.logs.motion_log import MotionLog
from plantar.robot.model import Foot, RobotModel

TIMESTEP = 1e-3
RATE = 200.0  # Hz
SETTLE = 2.0  # s
SOLE_MASS = 0.3  # kg, taken off the ankle
SOLE_INERTIA = (0.02, 0.02, 0.02)  # kg·m²
SERVO, SERVO_DAMPING, ROTOR = 3e4, 300.0, 0.3  # N·m/rad, N·m·s/rad, kg·m²
SLIDE = (2e5, 1e3)  # N/m, N·s/m along the bush's z axis
BALL = 1e-3  # m, radius of the four points that touch the floor


@dataclass(frozen=True)
class Springs:
    """Stiffness and damping of one foot, pitch then roll [N·m/rad, N·m·s/rad]."""

    stiffness: tuple[float, float]
    damping: tuple[float, float]


@dataclass(frozen=True)
class Played:
    """`log`: what the robot recorded. `tilt`: the largest of each sole against the floor [rad]; `slid`: the farthest
    that one moved over it [m]; `sunk`: of the root from where it began [m]."""

    log: MotionLog
    tilt: float
    slid: float
    sunk: float


def play_plainly(robot: RobotModel, table: MotionLog, feet: Mapping[str, Springs]) -> Played:
    """Play `joint.NAME.position` of a table from its first row, on springs by foot."""
    model = _model(robot, feet)
    data = mujoco.MjData(model)
    names = [name for name in robot.joint_names if table.has(f"joint.{name}.position")]
    targets = table.stack([f"joint.{name}.position" for name in names])
    columns = [model.actuator(name).id for name in names]
    for name, value in zip(names, targets[0], strict=True):
        data.joint(name).qpos[0] = value
    data.qpos[3] = 1.0
    mujoco.mj_kinematics(model, data)
    data.qpos[2] = -min(data.geom(geom).xpos[2] - BALL for geom in _balls(model))
    kept = _Kept([], [], [], [])
    settling, every = round(SETTLE / TIMESTEP), round(1 / (RATE * TIMESTEP))
    moments = np.arange(0.0, table.time[-1] + TIMESTEP / 2, TIMESTEP)
    told = np.column_stack([np.interp(moments, table.time, target) for target in targets.T])
    for step in range(settling + len(told)):
        data.ctrl[columns] = told[max(0, step - settling)]
        if step >= settling and step % every == 0:
            mujoco.mj_forward(model, data)  # positions, velocities and forces of one moment
            kept.add(data)
        mujoco.mj_step(model, data)
    soles = [model.body(f"{foot}.sole").id for foot in feet]
    path, turned = np.array(kept.places)[:, soles], np.array(kept.turns)[:, soles]
    readings = _readings(robot, model, kept, names)
    return Played(
        MotionLog("outside", np.arange(len(path)) / RATE, readings),
        float(np.abs(turned[..., 6:8]).max()),
        float(np.abs(path[..., :2] - path[0, :, :2]).max()),
        float(np.ptp(path[..., 2])),
    )


@dataclass(frozen=True)
class _Kept:
    """What MuJoCo held at each sample: joints, sensors, and place and rotation matrix of every body."""

    joints: list[np.ndarray]
    sensors: list[np.ndarray]
    places: list[np.ndarray]
    turns: list[np.ndarray]

    def add(self, data: mujoco.MjData) -> None:
        for rows, row in zip(
            (self.joints, self.sensors, self.places, self.turns),
            (data.qpos, data.sensordata, data.xpos, data.xmat),
            strict=True,
        ):
            rows.append(row.copy())


def _model(robot: RobotModel, feet: Mapping[str, Springs]) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_string(robot.urdf)
    spec.compiler.fusestatic = False
    spec.option.timestep = TIMESTEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.worldbody.first_body().add_freejoint()
    for joint in spec.joints:
        if joint.type != mujoco.mjtJoint.mjJNT_FREE:
            joint.armature = ROTOR
            servo = spec.add_actuator(name=joint.name, target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            servo.set_to_position(kp=SERVO, kv=SERVO_DAMPING)
    for name, foot in robot.feet.items():
        _add_sole(spec, foot, feet[name])
    assert robot.imu is not None
    mount = robot.imu.placement
    spec.body(mount.link).add_site(name="imu", pos=mount.xyz)
    for kind in ("FRAMEQUAT", "GYRO", "ACCELEROMETER"):
        spec.add_sensor(
            name=kind, type=getattr(mujoco.mjtSensor, f"mjSENS_{kind}"), objtype=mujoco.mjtObj.mjOBJ_SITE, objname="imu"
        )  # fmt: skip
    floor = spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5, 5, 0.1], friction=[0.9, 0.005, 0.0001]
    )
    floor.solref, floor.solimp[:2], floor.priority = [-2e5, -1e3], [0.95, 0.95], 1
    return spec.compile()


def _add_sole(spec: mujoco.MjSpec, foot: Foot, springs: Springs) -> None:
    ankle = spec.body(foot.ankle)
    ankle.mass -= SOLE_MASS
    sole = ankle.add_body(name=f"{foot.name}.sole", pos=foot.bush.xyz)
    sole.mass, sole.inertia, sole.explicitinertial = SOLE_MASS, SOLE_INERTIA, True
    slide = sole.add_joint(name=f"{foot.name}.z", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
    slide.stiffness[0], slide.damping[0] = SLIDE
    for axis, direction, place in (("pitch", [0, 1, 0], 0), ("roll", [1, 0, 0], 1)):
        hinge = sole.add_joint(name=f"{foot.name}.{axis}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=direction)
        hinge.stiffness[0], hinge.damping[0] = springs.stiffness[place], springs.damping[place]
    sole.add_site(name=f"{foot.name}.bush")
    for number, (x, y) in enumerate(foot.sole.polygon):
        corner = foot.sole.placement.xyz - foot.bush.xyz + [x, y, BALL]
        sole.add_geom(name=f"{foot.name}.ball{number}", size=[BALL, 0, 0], pos=corner)
    for kind in ("FORCE", "TORQUE"):
        spec.add_sensor(
            name=f"{foot.name}.{kind}", type=getattr(mujoco.mjtSensor, f"mjSENS_{kind}"),
            objtype=mujoco.mjtObj.mjOBJ_SITE, objname=f"{foot.name}.bush",
        )  # fmt: skip


def _balls(model: mujoco.MjModel) -> list[str]:
    names = [model.geom(place).name for place in range(model.ngeom)]
    return [name for name in names if ".ball" in name]


def _readings(
    robot: RobotModel, model: mujoco.MjModel, kept: _Kept, joints: list[str]
) -> dict[str, np.ndarray]:
    """A log's columns."""
    assert robot.imu is not None
    positions, sensed = np.array(kept.joints), np.array(kept.sensors)
    turns = np.array(kept.turns).reshape(len(positions), -1, 3, 3)

    def sensor(name: str) -> np.ndarray:
        own = model.sensor(name)
        return sensed[:, own.adr[0] : own.adr[0] + own.dim[0]]

    found = {f"joint.{name}.position": positions[:, model.joint(name).qposadr[0]] for name in joints}
    for name, quantity, axes in (
        ("FRAMEQUAT", "orientation", "wxyz"),
        ("GYRO", "angular_velocity", "xyz"),
        ("ACCELEROMETER", "linear_acceleration", "xyz"),
    ):
        found |= _columns(f"imu.{robot.imu.name}.{quantity}", axes, sensor(name))
    for name, foot in robot.feet.items():
        ankle, sole = (turns[:, model.body(one).id] for one in (foot.ankle, f"{name}.sole"))
        # The sensor reads what the ankle does to the sole; the environment does the opposite to the robot.
        force, torque = (
            -np.einsum("nji,njk,nk->ni", ankle, sole, sensor(f"{name}.{kind}"))
            for kind in ("FORCE", "TORQUE")
        )
        torque += np.cross(foot.bush.xyz - foot.wrench.placement.xyz, force)
        for kind, values in (("force", force), ("torque", torque)):
            found |= _columns(f"wrench.{foot.wrench.name}.{kind}", "xyz", values)
    return found


def _columns(name: str, axes: str, values: np.ndarray) -> dict[str, np.ndarray]:
    return {f"{name}.{axis}": column for axis, column in zip(axes, values.T, strict=True)}
