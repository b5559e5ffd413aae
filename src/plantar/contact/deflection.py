"""Bush deflection, its rate and its wrench from encoders, IMU and force sensors (paper 3.2).

The sole stands flat on level ground, so the world's up n in the bush frame gives both angles:

    n = Ry(pitch) Rx(roll) e_z   =>   pitch = atan2(n_x, n_z),   roll = -asin(n_y)

and, as n only turns with the frame it is seen from, n_dot = -ω × n, with the bush frame's own angular
velocity ω, gives their rates without differentiating. Yaw of the IMU never enters.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin

from plantar import _core
from plantar.conventions import GRAVITY, Array, skew
from plantar.errors import DataError
from plantar.robot.kinematics import KinematicTree, packed_frame
from plantar.robot.model import Placement, RobotModel

LEAST_LOAD = 0.02  # of the robot's weight: a foot that carries less has no centre of pressure


@dataclass(frozen=True)
class BushState:
    """One foot through one motion; N samples.

    deflection: (N, 2), pitch and roll of the sole relative to the ankle [rad]; rate: (N, 2) [rad/s];
    wrench: (N, 6), of the environment on the robot at the bush centre, in the bush frame [N, N·m];
    torque: (N, 2), generalised, about the bush's pitch and roll axes [N·m];
    force_z: (N,), along the vertical [N];
    cop: (N, 2), centre of pressure in the sole frame [m], NaN where the foot carries too little;
    sole_position: (N, 3), sole origin from the IMU in world axes [m];
    heading: (N,), of the sole's x axis in the world [rad].
    """

    deflection: Array
    rate: Array
    wrench: Array
    torque: Array
    force_z: Array
    cop: Array
    sole_position: Array
    heading: Array


@dataclass(frozen=True)
class FootMotion:
    """What the kinematics alone say: `up` (N, 3), in the bush frame; `encoder_rate` (N, 2), the part of the rate that
    joints turn, the IMU held [rad/s]; `imu_turn` (N, 2, 3), change of pitch and roll with a turn of the IMU about its
    own x, y and z [rad/rad]; the others as in `BushState`."""

    up: Array
    deflection: Array
    rate: Array
    sole_position: Array
    heading: Array
    encoder_rate: Array
    imu_turn: Array


@dataclass(frozen=True)
class FootPath:
    """The joints from the IMU to one bush and the frames in between, as the native core takes them.

    joints: their columns in positions and velocities, in the order of the path.
    """

    joints: tuple[int, ...]
    frames: tuple[Array, ...]
    slides: tuple[bool, ...]
    signs: tuple[float, ...]
    bush: Array
    sole: Array


def bush_states(
    robot: RobotModel,
    positions: Array,
    velocities: Array,
    orientation: Array,
    angular_velocity: Array,
    wrenches: Mapping[str, Array],
) -> dict[str, BushState]:
    """The state of every foot of a robot through a motion of N samples.

    positions, velocities: (N, n_joints) in the robot's joint order [rad or m, and per second]; only joints
    between the IMU and a foot are read; orientation: w x y z, IMU to world, (N, 4), of any length > 0;
    angular_velocity: of the IMU in its own frame, (N, 3) [rad/s]; wrenches: as recorded, (N, 6), by foot.
    NaN in, NaN out.

    Raises RobotError when the robot file has no IMU, DataError when an array has the wrong shape.
    """
    motions = foot_motions(robot, positions, velocities, orientation, angular_velocity)
    return loaded(robot, motions, wrenches)


def foot_motions(
    robot: RobotModel, positions: Array, velocities: Array, orientation: Array, angular_velocity: Array
) -> dict[str, FootMotion]:
    """What the kinematics say of every foot; arguments and errors as of `bush_states`."""
    samples, joints = len(orientation), len(robot.joint_names)
    _expect("positions", positions, (samples, joints))
    _expect("velocities", velocities, (samples, joints))
    _expect("orientation", orientation, (samples, 4))
    _expect("angular velocity", angular_velocity, (samples, 3))
    arrays = positions, velocities, orientation, angular_velocity
    return {name: foot_motion(path_to(robot, name)[0], *arrays) for name in robot.feet}


def loaded(
    robot: RobotModel, motions: Mapping[str, FootMotion], wrenches: Mapping[str, Array]
) -> dict[str, BushState]:
    """What the force sensors say added to the motions; `wrenches` and errors as of `bush_states`."""
    least = LEAST_LOAD * max(robot.mass * GRAVITY, 1.0)
    states = {}
    for name, foot in robot.feet.items():
        motion, to_bush = motions[name], robot.frame(foot.bush)[1].inverse()
        _expect(f"wrench of foot '{name}'", wrenches[name], (len(motion.up), 6))
        sensor, sole = (
            packed_frame(to_bush * robot.frame(part.placement)[1]) for part in (foot.wrench, foot.sole)
        )
        rows = _core.sole_load(sensor, foot.wrench.sign, wrenches[name], motion.up, sole, least)
        states[name] = BushState(
            deflection=motion.deflection,
            rate=motion.rate,
            wrench=rows[0:6].T,
            torque=rows[6:8].T,
            force_z=rows[8],
            cop=rows[9:11].T,
            sole_position=motion.sole_position,
            heading=motion.heading,
        )
    return states


def path_to(
    robot: RobotModel, name: str, place: Placement | None = None
) -> tuple[FootPath, pin.SE3, pin.SE3]:
    """The chain from a robot's IMU to one foot's bush, the sole's placement in the bush frame, and what takes a
    placement in the ankle's joint there. `place`: of the bush, where it is not the robot file's.
    """
    imu, foot = robot.required_imu, robot.feet[name]
    bush = robot.frame(place or foot.bush)
    to_bush = bush[1].inverse()
    sole = to_bush * robot.frame(foot.sole.placement)[1]
    return foot_path(robot.tree, robot.frame(imu.placement), bush, sole), sole, to_bush


def foot_path(
    tree: KinematicTree, imu: tuple[int, pin.SE3], bush: tuple[int, pin.SE3], sole: pin.SE3
) -> FootPath:
    """The chain from an IMU to a bush.

    imu, bush: (the joint of the Pinocchio model that carries the frame, the placement in that joint's frame);
    sole: its placement in the bush frame when the bush is not deflected.
    """
    first = 2 if tree.floating else 1
    path = tree.path(imu[0] - first, bush[0] - first)
    # The core's joints turn about z, so every frame it is given is turned by `to_axis`, z onto the axis.
    onward = imu[1].inverse()
    frames = []
    for joint, sign in path:
        placement = pin.SE3(tree.rotations[joint], tree.translations[joint])
        to_axis = pin.SE3(_rotation_from_z(*tree.axes[joint].tolist()), np.zeros(3))
        if sign > 0:
            frames.append(packed_frame(onward * placement * to_axis))
            onward = to_axis.inverse()
        else:
            frames.append(packed_frame(onward * to_axis))
            onward = (placement * to_axis).inverse()
    return FootPath(
        joints=tuple(joint for joint, _ in path),
        frames=tuple(frames),
        slides=tuple(bool(tree.slides[joint]) for joint, _ in path),
        signs=tuple(float(sign) for _, sign in path),
        bush=packed_frame(onward * bush[1]),
        sole=packed_frame(sole),
    )


def foot_motion(
    path: FootPath, positions: Array, velocities: Array, orientation: Array, angular_velocity: Array
) -> FootMotion:
    """Angles, rates and sole position of one foot, for N samples at once; arguments as in `bush_states`."""
    rows = _core.foot_chain(
        path.frames,
        path.slides,
        path.signs,
        path.bush,
        path.sole,
        [positions[:, joint] for joint in path.joints],
        [velocities[:, joint] for joint in path.joints],
        orientation,
        angular_velocity,
    )
    return FootMotion(
        rows[0:3].T,
        rows[3:5].T,
        rows[5:7].T,
        rows[7:10].T,
        rows[10],
        rows[11:13].T,
        rows[13:19].T.reshape(-1, 2, 3),
    )


def onto_sole(vector: Array, pitch: Array, roll: Array) -> Array:
    """From the bush frame to the deflected one: (Ry(pitch) Rx(roll))ᵀ, (N, 3)."""
    x, y, z = vector.T
    cp, sp, cr, sr = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    level = sp * x + cp * z
    return np.column_stack([cp * x - sp * z, cr * y + sr * level, cr * level - sr * y])


def _expect(what: str, values: Array, shape: Sequence[int]) -> None:
    if values.shape != tuple(shape):
        raise DataError(f"{what}: an array of shape {values.shape} (valid: {tuple(shape)})")


@lru_cache(maxsize=256)
def _rotation_from_z(x: float, y: float, z: float) -> Array:
    """A rotation whose third column is the unit axis `x, y, z`, (3, 3)."""
    axis = np.array([x, y, z])
    turned = skew(axis)
    first = -turned[:, np.argmin(np.abs(axis))]
    first /= np.sqrt(first @ first)
    return np.array([first, turned @ first, axis]).T
