"""A robot in plain MuJoCo: servos follow a table of positions, soles hang on springs, dampers and sliding elements.

MuJoCo reads the URDF and solves everything; what slides is stepped here. Nothing of plantar's twin is used.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from outside.rubber import Hinge, Rubber, weight_times_height
from plantar.conventions import Array
from plantar.robot.model import Foot, Placement, RobotModel

STEP = 1e-3  # s
SETTLE = 3.0  # s, in which the servos hold the first row
# Share of the robot's mass, and m² over it: below the force sensors and still, a sole weighs on nothing and lets steps
# be long. One that is lifted is lighter.
SOLE, LIFTED_SOLE = (0.05, 1e-3), (0.02, 4e-4)
SERVO = 20.0  # times weight times height [N·m/rad]
SERVO_DAMPING = 0.02  # s, over the stiffness
GEAR_DAMPING = 0.002  # s, likewise, of gears that bend
ROTOR = 1e-4  # s², inertia over the stiffness
# Stiff beside any rubber: solref and solimp. Light soles sink more: stiffer under these.
FLOOR, HARD_FLOOR, PARTS = (-2.5e5, -1e3), (-5e5, -1.4e3), 2
HARD = 0.999
SMALLEST = 1e-6  # kg·m²
ENTRIES = {(0, 0): "ixx", (1, 1): "iyy", (2, 2): "izz", (0, 1): "ixy", (0, 2): "ixz", (1, 2): "iyz"}
AXES = (("pitch", [0, 1, 0]), ("roll", [1, 0, 0]))


@dataclass(frozen=True)
class Motion:
    """What is exactly so at each moment of `time` (n,), 1000 Hz.

    `joints` (n, joints) [rad]; `orientation` (n, 4) w x y z, `turning` (n, 3) [rad/s] and `pull` (n, 3) [m/s²] of the
    IMU; `wrenches` of each foot (n, 6), force then torque; `tilt` [rad] the largest of a sole against the floor.
    """

    time: Array
    joints: Array
    orientation: Array
    turning: Array
    pull: Array
    wrenches: Mapping[str, Array]
    tilt: float


# Makes, for a model, what leads each row's targets away by the robot's state before the step.
Leads = Callable[[mujoco.MjModel], Callable[[int, mujoco.MjData], Array]]


def play(
    robot: RobotModel,
    start: Array,
    targets: Array,
    rubber: Mapping[str, Rubber],
    leads: Leads | None = None,
    gears: float = 0.0,
) -> Motion:
    """Play `targets` (n, joints) at 1000 Hz from the root's pose `start` (7,) x y z, w x y z; `gears` [rad/(N·m)]: by
    which every joint bends beyond its motor, where it is read."""
    model = _model(robot, rubber, lifted=leads is not None, gears=gears)
    lead = None if leads is None else leads(model)
    data = mujoco.MjData(model)
    names = list(robot.joint_names)
    places = np.array([model.joint(name).qposadr[0] for name in names])
    data.qpos[:7], data.qpos[places] = start, targets[0]
    sliding = [_Sliding(model, foot, axis, hinge) for foot, axis, hinge in _sliding_hinges(rubber)]
    bodies = [i for f in rubber for i in (model.body(robot.feet[f].ankle).id, model.body(f"{f}.sole").id)]
    joints = np.zeros((len(targets), len(names)))
    read = np.zeros((len(targets), model.nsensordata))
    axes, centres = np.zeros((len(targets), len(bodies), 9)), np.zeros((len(targets), len(bodies), 3))
    for row in range(-round(SETTLE / STEP), len(targets)):
        data.ctrl[:] = targets[max(row, 0)]
        if lead is not None:
            data.ctrl[:] += lead(max(row, 0), data)
        for part in range(PARTS):
            for each in sliding:
                each.push(data)
            before = data.qpos[places]
            mujoco.mj_step(model, data)  # sensors and frames are those of the state before the step
            # A blow shorter than a row passes on what it gives; all else is as of the same moment.
            if row >= 0:
                now = (before, data.sensordata, data.xmat[bodies], data.xpos[bodies])
                for kept, found in zip((joints, read, axes, centres), now, strict=True):
                    kept[row] += (found - kept[row]) / (part + 1)
    turns = axes.reshape(len(targets), len(rubber), 2, 3, 3)
    wrenches, tilt = {}, 0.0
    for number, name in enumerate(rubber):
        foot, (ankle, sole) = robot.feet[name], turns[:, number].transpose(1, 0, 2, 3)
        aside = (sole @ _sole_axes(foot)[:, 2])[:, :2]
        tilt = max(tilt, float(np.linalg.norm(aside, axis=1).max()))
        # The ankle acts on the sole, the environment the other way round.
        acting = -read[:, 10 + 6 * number : 16 + 6 * number].reshape(-1, 2, 3) @ (ankle.mT @ sole).mT
        centre = np.einsum("tji,tj->ti", ankle, centres[:, 2 * number + 1] - centres[:, 2 * number])
        wrenches[name] = _moved(foot, acting[:, 0], acting[:, 1], centre)
    time = STEP * np.arange(len(targets))
    orientation = read[:, :4] / np.linalg.norm(read[:, :4], axis=1, keepdims=True)
    return Motion(time, joints, orientation, read[:, 4:7], read[:, 7:10], wrenches, tilt)


class _Sliding:
    """A spring of slip torque over slip angle that slides where its torque would be more."""

    def __init__(self, model: mujoco.MjModel, foot: str, axis: str, hinge: Hinge) -> None:
        joint = model.joint(f"{foot}.{axis}")
        self.position, self.dof = joint.qposadr[0], joint.dofadr[0]
        self.torque, self.angle = hinge.slip_torque, hinge.slip_angle
        self.stretch, self.last = 0.0, 0.0

    def push(self, data: mujoco.MjData) -> None:
        angle = float(data.qpos[self.position])
        self.stretch = float(np.clip(self.stretch + (angle - self.last) / self.angle, -1, 1))
        self.last = angle
        data.qfrc_applied[self.dof] = -self.torque * self.stretch


def _sliding_hinges(rubber: Mapping[str, Rubber]) -> list[tuple[str, str, Hinge]]:
    found = [(foot, axis, getattr(rubber[foot], axis)) for foot in rubber for axis, _ in AXES]
    return [each for each in found if each[2].slip_torque > 0]


def _model(
    robot: RobotModel, rubber: Mapping[str, Rubber], *, lifted: bool, gears: float = 0.0
) -> mujoco.MjModel:
    servo = SERVO * weight_times_height(robot)
    spec = mujoco.MjSpec.from_string(_bare(robot.urdf))
    spec.compiler.fusestatic, spec.compiler.balanceinertia = False, True
    spec.option.timestep = STEP / PARTS
    # What an implicit step integrates is not the acceleration that sensors read in it, and breaks Newton's law.
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
    spec.worldbody.first_body().add_freejoint()
    for joint in spec.joints:
        if joint.type == mujoco.mjtJoint.mjJNT_FREE:
            continue
        joint.limited, joint.frictionloss, joint.armature = False, 0.0, ROTOR * servo
        if gears and joint.name in robot.joint_names:
            gear = joint.parent.add_joint(
                name=f"{joint.name}.gear", type=joint.type, axis=joint.axis, pos=joint.pos
            )
            gear.stiffness[0], gear.damping[0] = 1 / gears, GEAR_DAMPING / gears
            gear.armature = gear.damping[0] * STEP / PARTS  # of light links an explicit step grows without it
    for name in robot.joint_names:
        actuator = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.set_to_position(kp=servo, kv=SERVO_DAMPING * servo)
    assert robot.imu is not None
    mount = robot.imu.placement
    spec.body(mount.link).add_site(name="imu", pos=mount.xyz, quat=_quaternion(mount))
    _add_sensors(spec, "imu", ("FRAMEQUAT", "GYRO", "ACCELEROMETER"))
    for name in rubber:
        _add_sole(spec, robot.feet[name], rubber[name], robot.mass, LIFTED_SOLE if lifted else SOLE)
    floor = spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5, 5, 0.1], friction=[1.0, 0.005, 0.0001]
    )
    floor.solref, floor.solimp[:2], floor.priority = HARD_FLOOR if lifted else FLOOR, HARD, 1
    return spec.compile()


def _bare(urdf: str) -> str:
    """Without shapes, and with inertias that a body can have."""
    root = ET.fromstring(urdf)
    for link in root.iter("link"):
        for kind in ("visual", "collision"):
            for shape in link.findall(kind):
                link.remove(shape)
        inertia = link.find("inertial/inertia")
        if inertia is None:
            continue
        given = np.zeros((3, 3))
        for (row, column), name in ENTRIES.items():
            given[row, column] = given[column, row] = float(inertia.get(name, 0))
        sizes, axes = np.linalg.eigh(given)
        if sizes[0] < SMALLEST:
            mended = axes @ np.diag(np.maximum(sizes, SMALLEST)) @ axes.T
            for place, name in ENTRIES.items():
                inertia.set(name, repr(float(mended[place])))
    return ET.tostring(root, encoding="unicode")


def _add_sole(
    spec: mujoco.MjSpec, foot: Foot, rubber: Rubber, mass: float, of_mass: tuple[float, float]
) -> None:
    holder = spec.body(foot.bush.link)
    sole = holder.add_body(name=f"{foot.name}.sole", pos=foot.bush.xyz, quat=_quaternion(foot.bush))
    sole.mass, sole.inertia, sole.explicitinertial = of_mass[0] * mass, 3 * [of_mass[1] * mass], True
    sole.ipos = [0, 0, 0]  # MuJoCo puts it at twice the place of the body else
    slide = sole.add_joint(name=f"{foot.name}.z", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
    slide.stiffness[0], slide.damping[0] = rubber.stiffness, rubber.damping
    for axis, direction in AXES:
        hinge = sole.add_joint(name=f"{foot.name}.{axis}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=direction)
        given = getattr(rubber, axis)
        hinge.stiffness[0], hinge.damping[0] = given.stiffness, given.damping
    sole.add_site(name=foot.name)
    _add_sensors(spec, foot.name, ("FORCE", "TORQUE"))
    turn, away = _sole_axes(foot), foot.bush.rotation.T @ (foot.sole.placement.xyz - foot.bush.xyz)
    outline = np.array(foot.sole.polygon)
    low, high = outline.min(0), outline.max(0)
    thick = 0.005
    centre = away + turn @ [*(low + high) / 2, thick]
    sole.add_geom(
        name=f"{foot.name}.box", type=mujoco.mjtGeom.mjGEOM_BOX, size=[*(high - low) / 2, thick], pos=centre,
        quat=Rotation.from_matrix(turn).as_quat(scalar_first=True),
    )  # fmt: skip


def _add_sensors(spec: mujoco.MjSpec, site: str, kinds: tuple[str, ...]) -> None:
    for kind in kinds:
        spec.add_sensor(
            name=f"{site}.{kind.lower()}", type=getattr(mujoco.mjtSensor, f"mjSENS_{kind}"),
            objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site,
        )  # fmt: skip


def _sole_axes(foot: Foot) -> Array:
    """The sole's axes in the bush's; both sit on one link."""
    return np.array(foot.bush.rotation.T @ foot.sole.placement.rotation)


def _quaternion(placement: Placement) -> Array:
    return np.array(Rotation.from_matrix(placement.rotation).as_quat(scalar_first=True))


def _moved(foot: Foot, force: Array, torque: Array, centre: Array) -> Array:
    """What the ankle's axes have at the bush's `centre` (n, 3), as the sensor reads it in its own place and axes."""
    sensor = foot.wrench.placement
    torque = torque + np.cross(centre - sensor.xyz, force)
    axes = foot.wrench.sign * sensor.rotation
    return np.hstack([force @ axes, torque @ axes])
