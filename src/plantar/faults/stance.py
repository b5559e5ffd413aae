"""What a stance weighs against each other: the moments of the feet's wrenches, gravity, and the IMU's up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from plantar.conventions import FORCE, GRAVITY, Array, Mask, rotation_from_quaternion
from plantar.logs.motion_log import MotionLog
from plantar.robot.kinematics import centre_of_mass
from plantar.robot.model import Imu, RobotModel
from plantar.signals.segments import complete, spread_out

SAMPLES = 50  # spread over the log: enough to tell
# s, of the wrenches about each sample: a structure that hums moves no mass, and balances nothing
AVERAGED = 0.1
LEAST_TILT = np.radians(0.5)  # usual: less of it is noise of the forces
# Ratio of two tilts, and their correlation whatever the direction, to be compared.
SIMILAR, COHERENT = 1.5, 0.9


@dataclass(frozen=True)
class StanceSides:
    """What a stance weighs against each other, in the root link's frame.

    `moment_arms` (n, feet, 6, 3) [m]: level moment about the centre of mass of each component of each foot's wrench,
    over the load; their sum is zero while the robot stands or sways. `up` (n, 3) as IMU and joints have it,
    `push` (n, 3) the ground's force, both of unit length: on average alike.
    """

    moment_arms: Array
    up: Array
    push: Array

    @property
    def misfit(self) -> float:
        return usual(self.moment_arms.sum(axis=(1, 2)))

    @property
    def moving(self) -> float:
        """The misfit less its median."""
        total = self.moment_arms.sum(axis=(1, 2))
        return usual(total - np.median(total, axis=0))

    @property
    def lean(self) -> float:
        """Angle between the ground's usual force and up [rad]."""
        apart = float(np.linalg.norm(np.median(self.push - self.up, axis=0)))
        return 2 * float(np.arcsin(min(1.0, apart / 2)))

    @property
    def turn(self) -> tuple[float, float]:
        """Angle by which up's changes must be turned about the vertical to be the force's, and its deviation [rad]."""
        parts = [side - side.mean(axis=0) for side in (self.up, self.push)]
        axis = self.push.mean(axis=0)
        axis /= max(float(np.linalg.norm(axis)), 1e-9)
        up, push = (part - np.outer(part @ axis, axis) for part in parts)
        along, across = float(np.sum(up * push)), float(np.sum(np.cross(up, push) @ axis))
        sizes = float(np.sqrt(np.sum(up**2) * np.sum(push**2)))
        # A swaying robot's forces also accelerate it, which is no tilt: only what is as large as the tilt counts.
        if usual(up) < LEAST_TILT or not 1 / SIMILAR < usual(push) / usual(up) < SIMILAR:
            return 0.0, np.inf
        alike = min(1.0, float(np.hypot(along, across)) / sizes)
        spread = np.sqrt((1 - alike**2) / len(up)) / alike if alike > COHERENT else np.inf
        return float(np.arctan2(across, along)), float(spread)


@dataclass(frozen=True)
class Stance:
    """Some samples of a loaded robot: attitude of the IMU (n, 4), joints (n, n_joints), wrench of each foot (n, 6), the
    mean of the moment about the sample."""

    robot: RobotModel
    imu: Imu
    orientation: Array
    positions: Array
    wrenches: list[Array]

    def sides(self) -> StanceSides:
        root, axes, arms = self._posed
        up = root[:, 2]
        level = np.eye(3) - up[:, :, None] * up[:, None, :]
        found, force = np.zeros((len(up), len(self.robot.feet), 6, 3)), np.zeros((len(up), 3))
        for k, wrench in enumerate(self.wrenches):
            found[:, k, :3] = arms[k] * wrench[:, :3, None]
            found[:, k, 3:] = axes[k] * wrench[:, 3:, None]
            force += np.einsum("nij,ni->nj", axes[k], wrench[:, :3])
        size = np.maximum(np.linalg.norm(force, axis=1), 1.0)[:, None]
        return StanceSides(found @ level[:, None] / size[:, None, None], up, force / size)

    def scaled_joint(self, joint: int, scale: float) -> Stance:
        positions = self.positions.copy()
        positions[:, joint] *= scale
        return replace(self, positions=positions)

    def exchanged_joints(self, first: int, second: int) -> Stance:
        positions = self.positions.copy()
        positions[:, [first, second]] = positions[:, [second, first]]
        return replace(self, positions=positions)

    def exchanged_wrenches(self) -> Stance:
        return self._feeling(self.wrenches[::-1])

    def turned_wrenches(self, feet: Sequence[int], degrees: int) -> Stance:
        """What the sensors of some feet read if they sit turned farther about their own z axes."""
        turn = np.kron(np.eye(2), pin.rpy.rpyToMatrix(0.0, 0.0, np.radians(degrees)))
        return self._feeling([w @ turn.T if k in feet else w for k, w in enumerate(self.wrenches)])

    def world_wrenches(self) -> Stance:
        """What the sensors read if the columns hold their wrenches in the world's axes."""
        root, each, _ = self._posed
        turned = list[Array]()
        for wrench, axes in zip(self.wrenches, each, strict=True):
            parts = wrench.reshape(-1, 2, 3) @ (root @ axes.transpose(0, 2, 1))
            turned.append(parts.reshape(-1, 6))
        return self._feeling(turned)

    def sole_wrenches(self) -> Stance:
        """What the sensors read if they turn with soles that stand level, below the rubber, and not with the ankles."""
        root, each, _ = self._posed
        turned = list[Array]()
        for wrench, axes, foot in zip(self.wrenches, each, self.robot.feet.values(), strict=True):
            sensor, sole = (
                self.robot.frame(one)[1].rotation for one in (foot.wrench.placement, foot.sole.placement)
            )
            up, upright = (axes @ root[:, 2, :, None])[..., 0], sensor.T @ sole[:, 2]
            turn = np.cross(upright, up)  # from the sole's axis to the vertical, of soles that lean little
            parts = wrench.reshape(-1, 2, 3)
            turned.append((parts + np.cross(turn[:, None], parts)).reshape(-1, 6))
        return self._feeling(turned)

    def _feeling(self, wrenches: list[Array]) -> Stance:
        """The same poses, which are not found again, with other wrenches."""
        other = replace(self, wrenches=wrenches)
        vars(other)["_posed"] = self._posed
        return other

    @cached_property
    def _posed(self) -> tuple[Array, list[Array], list[Array]]:
        """The root link's rotation in the world by the IMU; of each foot's sensor, in the root link, its axes, and the
        moments about the centre of mass of unit forces along them; (n, 3, 3) each, the moments in m."""
        rotations, places = self.robot.tree.poses(self.positions)
        centre = centre_of_mass(self.robot.model, rotations, places)
        carrier, mount = self.robot.frame(self.imu.placement)
        imu = rotations[carrier] @ mount.rotation
        root = rotation_from_quaternion(self.orientation) @ imu.transpose(0, 2, 1)
        axes, arms = list[Array](), list[Array]()
        for foot in self.robot.feet.values():
            carrier, mount = self.robot.frame(foot.wrench.placement)
            at = places[carrier] + rotations[carrier] @ mount.translation
            axes.append((rotations[carrier] @ mount.rotation).transpose(0, 2, 1))
            arms.append(np.cross((at - centre)[:, None, :], axes[-1]))
        return root, axes, arms


def stance_of(robot: RobotModel, log: MotionLog) -> Stance | None:
    """Samples in which the feet carry the robot, or None where there are too few."""
    imu = robot.imu
    orientation = log.orientation(imu.name) if imu is not None else None
    if imu is None or orientation is None or len(robot.feet) != 2:
        return None
    wrenches = [foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()]
    positions = log.positions(robot)
    whole = complete(orientation, positions, *wrenches)
    whole &= np.linalg.norm(np.nan_to_num(orientation), axis=1) > 0.5
    loaded = whole & (sum(np.linalg.norm(w[:, FORCE], axis=1) for w in wrenches) > 0.3 * robot.mass * GRAVITY)
    rows = spread_out(np.flatnonzero(loaded), SAMPLES)
    if rows.size < 10:
        return None
    means = [_about(wrench, rows, whole, round(AVERAGED / 2 / log.period)) for wrench in wrenches]
    return Stance(robot, imu, orientation[rows], positions[rows], means)


def _about(values: Array, rows: NDArray[np.intp], whole: Mask, reach: int) -> Array:
    """Means (n, k) of values (N, k) over the whole samples at most `reach` from each of the rows (n,)."""
    window = np.clip(rows[:, None] + np.arange(-reach, reach + 1), 0, len(values) - 1)
    weights = whole[window] / whole[window].sum(axis=1, keepdims=True)
    return np.asarray(np.einsum("nw,nwk->nk", weights, np.where(whole[:, None], values, 0.0)[window]))


def usual(vectors: Array) -> float:
    """Usual length of vectors (n, 3): the median, which a few bad samples do not move."""
    return float(np.median(np.linalg.norm(vectors, axis=1)))
