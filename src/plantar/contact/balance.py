"""Balance: where the zero-moment point goes, and how far inside the support polygon it stays.

The zero-moment point (ZMP) is where the ground's total force would have to act on the floor to make the
horizontal moment vanish. It is planned from the motion by inverse dynamics and measured from the feet's wrenches.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin

from plantar.contact.phases import LIFTING_SHARE
from plantar.contact.polygon import convex_hull, inside_distance
from plantar.conventions import FORCE, GRAVITY, TORQUE, Array
from plantar.errors import DataError, MotionError
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel


@dataclass(frozen=True)
class Balance:
    """The ZMP of one motion, (N, 2) [m] on the floor, in the frame of `polygon` (n, 2), the support polygon.

    NaN where the feet carry nothing. `outlines` are the soles that stand, (k, 2) each, in the same frame.
    """

    motion: str
    time: Array = field(repr=False)
    zmp: Array = field(repr=False)
    outlines: Mapping[str, Array] = field(repr=False)

    @property
    def polygon(self) -> Array:
        """The convex hull of the soles that stand, counter-clockwise."""
        return convex_hull(np.vstack(list(self.outlines.values())))

    @property
    def margin(self) -> Array:
        """Distance from the ZMP to the polygon's border, (N,) [m]; negative outside, NaN in the air."""
        known = np.isfinite(self.zmp).all(axis=1)
        margin = np.full(len(self.zmp), np.nan)
        margin[known] = inside_distance(self.zmp[known], self.polygon)
        return margin

    def worst(self) -> tuple[float, float]:
        """Time [s] and margin [m] of the moment nearest to falling; DataError where the feet never carry."""
        margin = self.margin
        if not np.isfinite(margin).any():
            raise DataError("no foot carries the robot", path=self.motion)
        place = int(np.nanargmin(margin))
        return float(self.time[place]), float(margin[place])


def require_balance(balance: Balance, least: float = 0.005) -> None:
    """MotionError, saying when and by how much, when the ZMP comes nearer than `least` [m] to the border."""
    time, margin = balance.worst()
    if margin >= least:
        return
    where = f"leaves the support polygon by {-1e3 * margin:.1f} mm"
    if margin >= 0:
        where = f"comes within {1e3 * margin:.1f} mm of the support polygon's border"
    message = f"{balance.motion}: the zero-moment point {where}"
    raise MotionError(message, time=time, valid=f"at least {1e3 * least:.0f} mm inside")


def sole_outlines(robot: RobotModel, soles: Mapping[str, Array]) -> dict[str, Array]:
    """Outlines on the floor, (k, 2) each, of soles that stand at the poses (4, 4) `soles`."""
    outlines = {}
    for name, pose in soles.items():
        corners = robot.feet[name].sole.polygon
        outlines[name] = corners @ pose[:2, :2].T + pose[:2, 3]
    return outlines


def planned_wrench(model: pin.Model, q: Array, v: Array, a: Array) -> Array:
    """Wrench of the ground that a motion needs, about the world's origin, in the world's axes, (N, 6).

    `model` has a free-flyer; q (N, nq), v and a (N, nv) as Pinocchio's, by inverse dynamics (eq. 1, base rows).
    """
    data = model.createData()
    wrench = np.empty((len(q), 6))
    for row in range(len(q)):
        tau = pin.rnea(model, data, q[row], v[row], a[row])
        in_world = pin.XYZQUATToSE3(q[row, :7]).act(pin.Force(tau[:6]))
        wrench[row, FORCE], wrench[row, TORQUE] = in_world.linear, in_world.angular
    return wrench


def zero_moment_point(wrench: Array, least: float) -> Array:
    """ZMP on the floor z = 0 of wrenches about the world's origin, (N, 2); NaN where force.z < `least` [N]."""
    force = np.where(wrench[:, 2] > least, wrench[:, 2], np.nan)
    return np.column_stack([-wrench[:, 4] / force, wrench[:, 3] / force])


def measured_balance(robot: RobotModel, log: MotionLog, soles: Mapping[str, Array] | None) -> Balance:
    """ZMP from the measured wrenches, over the soles that stand.

    `soles`: where they stand, (4, 4) each; without it they are put on the floor as the first sample's encoders
    say, the world between them. A foot that never carries a twentieth of the weight is no part of the polygon.
    Raises DataError when the robot file has no feet.
    """
    if not robot.feet:
        raise DataError("has no feet, so there is no balance to measure", path=robot.path)
    poses = dict(soles) if soles is not None else flat_soles(robot, log.positions(robot)[0])
    # With less a foot is in the air, and has no centre of pressure.
    least = LIFTING_SHARE * robot.mass * GRAVITY
    total, carrying = np.zeros((len(log), 6)), {}
    for name, foot in robot.feet.items():
        if name not in poses:
            continue
        wrench = foot.wrench.sign * log.wrench(foot.wrench.name)
        _, sensor = robot.frame(foot.wrench.placement)
        _, sole = robot.frame(foot.sole.placement)
        to_world = poses[name] @ (sole.inverse() * sensor).homogeneous
        force, torque = wrench[:, FORCE] @ to_world[:3, :3].T, wrench[:, TORQUE] @ to_world[:3, :3].T
        if np.nanmedian(force[:, 2]) < least:
            continue
        carrying[name] = poses[name]
        total[:, FORCE] += force
        total[:, TORQUE] += torque + np.cross(to_world[:3, 3], force)
    if not carrying:
        raise DataError("no foot carries the robot", path=log.source)
    return Balance(log.name, log.time, zero_moment_point(total, least), sole_outlines(robot, carrying))


def flat_soles(robot: RobotModel, positions: Array) -> dict[str, Array]:
    """Poses of the soles on the floor, (4, 4) each, as joint positions (n,) place them: middle at the origin."""
    found = soles_in_root(robot, positions)
    first = np.linalg.inv(next(iter(found.values())))
    poses = {name: first @ pose for name, pose in found.items()}
    middle = np.mean([pose[:2, 3] for pose in poses.values()], axis=0)
    flat = {}
    for name, pose in poses.items():
        yaw = np.arctan2(pose[1, 0], pose[0, 0])
        flat[name] = np.eye(4)
        flat[name][:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
        flat[name][:2, 3] = pose[:2, 3] - middle
    return flat


def soles_in_root(robot: RobotModel, positions: Array) -> dict[str, Array]:
    """Poses of the soles in the root link's frame, (4, 4) each, at joint positions (n,) in the robot's order."""
    model, data = robot.model, robot.model.createData()
    pin.forwardKinematics(model, data, robot.configuration(positions))
    found = {}
    for name, foot in robot.feet.items():
        joint, placement = robot.frame(foot.sole.placement)
        found[name] = np.array((data.oMi[joint] * placement).homogeneous)
    return found
