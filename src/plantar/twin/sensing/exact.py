"""What perfect sensors would have recorded of a rollout, and what no sensor can see."""

from __future__ import annotations

import numpy as np

from plantar.conventions import GRAVITY, Array, rotation_from_quaternion
from plantar.robot.model import RobotModel
from plantar.twin.robots.foot import CutFoot
from plantar.twin.simulation.rollout import Rollout

Columns = dict[str, Array]


def exact_columns(rollout: Rollout, robot: RobotModel, feet: dict[str, CutFoot]) -> Columns:
    """The log's columns without any imperfection, each (N,), at the rollout's time."""
    columns: Columns = {}
    for quantity, values in (
        ("position", rollout.positions),
        ("velocity", rollout.velocities),
        ("effort", rollout.efforts),
    ):
        for place, joint in enumerate(rollout.joints):
            columns[f"joint.{joint}.{quantity}"] = values[:, place]
    if robot.imu is not None:
        for quantity, axes in (
            ("orientation", "wxyz"),
            ("angular_velocity", "xyz"),
            ("linear_acceleration", "xyz"),
        ):
            values = rollout.sensors[f"imu.{quantity}"]
            columns |= labelled(f"imu.{robot.imu.name}.{quantity}", axes, values)
    for name, foot in robot.feet.items():
        wrench = foot.wrench.sign * sensor_wrench(rollout, feet[name])
        columns |= labelled(f"wrench.{foot.wrench.name}.force", "xyz", wrench[:, :3])
        columns |= labelled(f"wrench.{foot.wrench.name}.torque", "xyz", wrench[:, 3:])
    return columns


def truth_columns(rollout: Rollout, feet: dict[str, CutFoot]) -> Columns:
    """Bush states and torques, contact forces and the root's pose: what only the twin knows.

    `<foot>.deflection.*` [m, rad], `<foot>.rate.*`, `<foot>.torque.*` (generalised, of the whole bush; z is a force),
    `<foot>.beside.*` (the part that is no linear spring or damper), `<foot>.contact.*` (force of the floor in the
    world, and centre of pressure in the sole's frame, NaN in the air), `<foot>.sole.*` (place in the world),
    `<foot>.tilt.*` (of the sole against the floor, which gives way a little [rad]), `base.*`.
    """
    columns = labelled("base", ("x", "y", "z", "qw", "qx", "qy", "qz"), rollout.base)
    for name, foot in feet.items():
        axes = ("z", "pitch", "roll")
        columns |= labelled(f"{name}.deflection", axes, rollout.bush[name])
        columns |= labelled(f"{name}.rate", axes, rollout.bush_rates[name])
        columns |= labelled(f"{name}.torque", axes, bush_forces(rollout, name))
        columns |= labelled(f"{name}.beside", ("pitch", "roll"), rollout.rubber[name])
        force, pressure = _contact(rollout, foot)
        columns |= labelled(f"{name}.contact.force", "xyz", force)
        columns |= labelled(f"{name}.contact.cop", "xy", pressure)
        columns |= labelled(f"{name}.sole", "xyz", rollout.sensors[f"{name}.place"])
        up = _up_in_sole(rollout, name)
        tilt = np.column_stack([np.arctan2(up[:, 0], up[:, 2]), -np.arcsin(np.clip(up[:, 1], -1.0, 1.0))])
        columns |= labelled(f"{name}.tilt", ("pitch", "roll"), tilt)
    if rollout.hand.shape[1]:
        columns |= labelled("hand.force", "xyz", rollout.hand)
    return columns


def bush_forces(rollout: Rollout, foot: str) -> Array:
    """Generalised force of the bush on the ankle in z, pitch and roll, (N, 3): force.z, then torques.

    The moment is about the bush's moved centre; pitch turns about the ankle's y axis, roll about `Ry(pitch) x`.
    """
    wrench = _at_bush(rollout, foot)
    pitch = rollout.bush[foot][:, 1]
    roll = wrench[:, 3] * np.cos(pitch) - wrench[:, 5] * np.sin(pitch)
    return np.column_stack([wrench[:, 2], wrench[:, 4], roll])


def sensor_wrench(rollout: Rollout, foot: CutFoot) -> Array:
    """The environment's wrench on the foot in the sensor's frame, (N, 6).

    The sensor hangs above the bush and carries the sole; as on the robot, the sole's weight is taken off, so it
    reads zero in the air.
    """
    wrench = _at_bush(rollout, foot.name)
    up = np.einsum("nij,nj->ni", _ankle_to_sole(rollout, foot.name), _up_in_sole(rollout, foot.name))
    force = wrench[:, :3] + foot.mass * GRAVITY * up
    centre = np.zeros_like(force)
    centre[:, 2] = rollout.bush[foot.name][:, 0]
    to_sensor = np.linalg.inv(foot.sensor) @ foot.bush
    rotation, offset = to_sensor[:3, :3], to_sensor[:3, 3]
    force, torque = force @ rotation.T, wrench[:, 3:] @ rotation.T
    return np.column_stack([force, torque + np.cross(centre @ rotation.T + offset, force)])


def labelled(prefix: str, axes: str | tuple[str, ...], values: Array) -> Columns:
    """Columns `<prefix>.<axis>` of an array (N, k)."""
    return {f"{prefix}.{axis}": values[:, place] for place, axis in enumerate(axes)}


def _at_bush(rollout: Rollout, foot: str) -> Array:
    """Wrench of the sole on the ankle at the bush's moved centre, in the bush's axes on the ankle, (N, 6).

    MuJoCo's sensors give the parent's action on the child in the child's axes: the opposite, turned.
    """
    turn = _ankle_to_sole(rollout, foot)
    parts = [
        -np.einsum("nij,nj->ni", turn, rollout.sensors[f"{foot}.{kind}"]) for kind in ("force", "torque")
    ]
    return np.column_stack(parts)


def _ankle_to_sole(rollout: Rollout, foot: str) -> Array:
    """R_ankle_sole = Ry(pitch) Rx(roll), (N, 3, 3)."""
    _, pitch, roll = rollout.bush[foot].T
    cp, sp, cr, sr, zero = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll), np.zeros_like(pitch)
    rows = ((cp, sp * sr, sp * cr), (zero, cr, -sr), (-sp, cp * sr, cp * cr))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _up_in_sole(rollout: Rollout, foot: str) -> Array:
    return rotation_from_quaternion(rollout.sensors[f"{foot}.sole"])[:, 2, :]


def _contact(rollout: Rollout, foot: CutFoot) -> tuple[Array, Array]:
    """The floor's force in the world, (N, 3), and the centre of pressure in the sole's plane, (N, 2)."""
    turn = _ankle_to_sole(rollout, foot.name)
    wrench = _at_bush(rollout, foot.name)
    weight = foot.mass * GRAVITY * _up_in_sole(rollout, foot.name)
    force = np.einsum("nji,nj->ni", turn, wrench[:, :3]) + weight  # in the sole's axes
    torque = np.einsum("nji,nj->ni", turn, wrench[:, 3:])
    to_sole = np.linalg.inv(foot.sole) @ foot.bush
    force, torque = force @ to_sole[:3, :3].T, torque @ to_sole[:3, :3].T
    torque = torque + np.cross(np.broadcast_to(to_sole[:3, 3], force.shape), force)
    loaded = force[:, 2] > 1.0
    safe = np.where(loaded, force[:, 2], np.nan)
    pressure = np.column_stack([-torque[:, 1] / safe, torque[:, 0] / safe])
    world = rotation_from_quaternion(rollout.sensors[f"{foot.name}.sole"]) @ np.linalg.inv(to_sole[:3, :3])
    return np.einsum("nij,nj->ni", world, force), pressure
