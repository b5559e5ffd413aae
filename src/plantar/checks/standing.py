"""Do the feet's wrenches balance gravity, and if not: what exchanged or reversed makes them do it?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY, Array, rotation_from_quaternion
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.robot.model import Imu, RobotModel

SAMPLES = 50  # spread over the log: enough to tell
BETTER = 0.5  # share of the misfit that must be left after the change
NOTABLE = 0.02  # m: a moment arm below it is within the model's own error
ALIKE = 0.1  # of the misfit: changes that do as well as the best are named with it
CERTAIN_MOMENT_ARM, CERTAIN = (
    0.05,
    0.1,
)  # m, and share left: no error of masses or mounting is undone so well by chance
UNEXPLAINED = 0.12  # m: beyond any sole; masses, encoder zeros or the sensors' places are off
FARTHEST = 1.5  # m: no posture and no mass is that far off
LEANING = np.radians(
    3.5
)  # between the ground's usual force and the IMU's up: more than zeros of sensors make
LEAST_TILT = np.radians(0.5)  # usual: less of it is noise of the forces
SIMILAR, COHERENT = (
    1.5,
    0.9,
)  # ratio of two tilts, and their correlation whatever the direction, to be compared
TURNED = np.radians(10)  # accelerations turn the force by some degrees too
IMPOSSIBLE = np.radians(30)  # no mounting, zero or push is that far off
MOST_NAMED = 3
COMPONENTS = ("force.x", "force.y", None, "torque.x", "torque.y", None)  # force.z is judged by its own sign


@dataclass(frozen=True)
class _Sides:
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
        return _usual(self.moment_arms.sum(axis=(1, 2)))

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
        if _usual(up) < LEAST_TILT or not 1 / SIMILAR < _usual(push) / _usual(up) < SIMILAR:
            return 0.0, np.inf
        alike = min(1.0, float(np.hypot(along, across)) / sizes)
        spread = np.sqrt((1 - alike**2) / len(up)) / alike if alike > COHERENT else np.inf
        return float(np.arctan2(across, along)), float(spread)


@dataclass(frozen=True)
class _Stance:
    """Some samples of a loaded robot: attitude of the IMU (n, 4), joints (n, n_joints), wrench of each foot (n, 6)."""

    robot: RobotModel
    imu: Imu
    orientation: Array
    positions: Array
    wrenches: list[Array]

    def sides(self) -> _Sides:
        robot = self.robot
        placements = [self.imu.placement, *(foot.wrench.placement for foot in robot.feet.values())]
        centre, rotations, translations = self._poses([robot.frame(placement) for placement in placements])
        attitude = rotation_from_quaternion(self.orientation)
        up = np.einsum("nij,nj->ni", rotations[0], attitude[:, 2])
        level = np.eye(3) - up[:, :, None] * up[:, None, :]
        found, force = np.zeros((len(up), len(robot.feet), 6, 3)), np.zeros((len(up), 3))
        for k, wrench in enumerate(self.wrenches):
            axes = rotations[k + 1].transpose(0, 2, 1)
            arm = (translations[k + 1] - centre)[:, None, :]
            found[:, k, :3] = np.cross(arm, axes) * wrench[:, :3, None]
            found[:, k, 3:] = axes * wrench[:, 3:, None]
            force += np.einsum("nij,ni->nj", axes, wrench[:, :3])
        size = np.maximum(np.linalg.norm(force, axis=1), 1.0)[:, None]
        return _Sides(found @ level[:, None] / size[:, None, None], up, force / size)

    def reversed_joint(self, joint: int) -> _Stance:
        positions = self.positions.copy()
        positions[:, joint] *= -1
        return replace(self, positions=positions)

    def exchanged(self) -> _Stance:
        return replace(self, wrenches=self.wrenches[::-1])

    def _poses(self, frames: Sequence[tuple[int, pin.SE3]]) -> tuple[Array, Array, Array]:
        """Centre of mass (n, 3), and rotations (f, n, 3, 3) and translations (f, n, 3) of frames, in the root link."""
        robot, model = self.robot, self.robot.model
        data, count = model.createData(), len(self.positions)
        configurations = np.tile(pin.neutral(model), (count, 1))
        for joint, angles in enumerate(self.positions.T, start=1):
            at = model.idx_qs[joint]
            if model.nqs[joint] == 1:
                configurations[:, at] = angles
            else:
                configurations[:, at], configurations[:, at + 1] = np.cos(angles), np.sin(angles)
        # The root link is fixed in `model`, and Pinocchio leaves what does not move out of the centre of mass.
        root, moving = model.inertias[0], robot.mass - model.inertias[0].mass
        centre, poses = np.empty((count, 3)), np.empty((len(frames), count, 4, 4))
        for sample, configuration in enumerate(configurations):
            centre[sample] = pin.centerOfMass(model, data, configuration)
            for k, (carrier, _) in enumerate(frames):
                poses[k, sample] = data.oMi[carrier].homogeneous
        poses = poses @ np.array([placement.homogeneous for _, placement in frames])[:, None]
        return (
            (root.mass * root.lever + moving * centre) / robot.mass,
            poses[..., :3, :3],
            poses[..., :3, 3],
        )


def check_balance(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """Exchanged wrenches, reversed signs of a wrench's component or a joint, or a misfit that none of them explains.

    The moment of the feet's wrenches about the centre of mass, over the load, is a moment arm [m] that stays small
    while the robot stands or sways; an operator's push adds centimetres.
    """
    stance = _stance(robot, log)
    if stance is None:
        return
    sides = stance.sides()
    as_is = sides.misfit
    if as_is <= NOTABLE and sides.lean <= LEANING:
        yield from _turned(stance, sides)
        return
    in_metres = sides.moment_arms.copy()
    in_metres[:, :, 3:] /= 1000
    if as_is > FARTHEST:
        text = f"columns 'wrench.*': balance gravity only to {as_is:.3g} m about the centre of mass"
        millimetres = _usual(in_metres.sum(axis=(1, 2))) < 0.1 * as_is
        valid = "valid: torques in N·m; these look like N·mm" if millimetres else "valid: below 0.02 m"
        yield Finding("torque_unit" if millimetres else "balance", f"{text} ({valid})", True)
        return
    exchanged = stance.exchanged().sides().misfit
    left = {**_reversed_joints(stance, sides), **_reversed_components(stance, sides)}
    best = min(left.values(), default=np.inf)
    if as_is > NOTABLE and exchanged < BETTER * as_is and exchanged < best + ALIKE * as_is:
        text = "the feet's wrenches look swapped: exchanged, they balance gravity far better"
        yield Finding("swapped_feet", f"{text} (check the sensors' names)", True)
    elif as_is > NOTABLE and best < BETTER * as_is:
        alike = sorted((name for name in left if left[name] < best + ALIKE * as_is), key=left.__getitem__)
        text = f"{' or '.join(alike[:MOST_NAMED])}: reversed, the wrenches balance gravity to {100 * best:.1f} cm"
        joint = "'joint." in alike[0]
        certain = (as_is > CERTAIN_MOMENT_ARM and best < CERTAIN * as_is) or sides.lean > IMPOSSIBLE
        valid = "valid: the signs of URDF and robot file"
        yield Finding("sign", f"{text} instead of {100 * as_is:.1f} cm ({valid})", joint and certain)
    elif sides.lean > LEANING:
        text = f"columns 'imu.{stance.imu.name}.*': the ground's force leans {np.degrees(sides.lean):.1f} deg from up"
        where = "check the IMU's rpy, the joints above the feet, the wrenches' zeros"
        valid = f"valid: below {np.degrees(LEANING):.1f} deg; {where}"
        yield Finding("force_leans", f"{text} ({valid})", bool(sides.lean > IMPOSSIBLE))
    elif as_is > UNEXPLAINED:
        text = f"columns 'wrench.*': balance gravity only to {100 * as_is:.1f} cm about the URDF's centre of mass"
        where = "check the encoders' zeros, where the wrenches are measured, and the masses"
        yield Finding("balance", f"{text} (valid: below {100 * NOTABLE:.0f} cm; {where})")
    else:
        yield from _turned(stance, sides)


def _turned(stance: _Stance, sides: _Sides) -> Iterator[Finding]:
    """An IMU that is turned about the vertical: its tilts are not those that the ground's force shows."""
    turn, spread = sides.turn
    if abs(turn) > max(TURNED, 3 * spread):
        text = f"columns 'imu.{stance.imu.name}.*': tilts another way than the ground's force in the robot, turned by "
        valid = f"valid: within {np.degrees(TURNED):.0f} deg; check the IMU's rpy"
        yield Finding("imu_turned", f"{text}{np.degrees(turn):.0f} deg about the vertical ({valid})")


def _stance(robot: RobotModel, log: MotionLog) -> _Stance | None:
    """Samples in which the feet carry the robot, or None where there are too few."""
    imu = robot.imu
    orientation = log.orientation(imu.name) if imu is not None else None
    if imu is None or orientation is None or len(robot.feet) != 2:
        return None
    wrenches = [foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()]
    positions = log.positions(robot)
    whole = np.isfinite(np.column_stack([orientation, positions, *wrenches])).all(axis=1)
    whole &= np.linalg.norm(np.nan_to_num(orientation), axis=1) > 0.5
    loaded = whole & (sum(np.abs(w[:, 2]) for w in wrenches) > 0.3 * robot.mass * GRAVITY)
    rows = np.flatnonzero(loaded)[:: max(1, int(loaded.sum() // SAMPLES))]
    if rows.size < 10:
        return None
    return _Stance(robot, imu, orientation[rows], positions[rows], [wrench[rows] for wrench in wrenches])


def _reversed_joints(stance: _Stance, sides: _Sides) -> dict[str, float]:
    """What is left of the misfit [m] with one joint between IMU and feet reversed, by the joint's column.

    Where the force then leans from up still, the joint does not explain what is wrong.
    """
    robot = stance.robot
    path = frozenset().union(
        *(robot.joints_between(stance.imu.placement, foot.bush) for foot in robot.feet.values())
    )
    tried = {
        f"column 'joint.{name}.position'": stance.reversed_joint(k).sides()
        for k, name in enumerate(robot.joint_names)
        if name in path and np.any(stance.positions[:, k])
    }
    allowed = max(LEANING, BETTER * sides.lean)
    return {name: trial.misfit for name, trial in tried.items() if trial.lean < allowed}


def _reversed_components(stance: _Stance, sides: _Sides) -> dict[str, float]:
    """The same with a component of one or both wrenches reversed, where it also follows the motion far better: a
    sensor's zero or a mass in the wrong place is no reversed sign."""
    moment_arms = sides.moment_arms
    total = moment_arms.sum(axis=(1, 2))
    moving = _usual(total - np.median(total, axis=0))
    left: dict[str, float] = {}
    sensors = [foot.wrench.name for foot in stance.robot.feet.values()]
    for component, part in enumerate(COMPONENTS):
        if part is None:
            continue
        each = [total - 2 * moment_arms[:, k, component] for k in range(len(sensors))]
        both = total - 2 * moment_arms[:, :, component].sum(axis=1)
        names = [f"column 'wrench.{sensor}.{part}'" for sensor in sensors]
        trials = dict(zip(names, each, strict=True))
        # A foot without load has nothing to reverse: the pair counts only where both take part.
        if _usual(both) < 0.8 * min(_usual(one) for one in each):
            trials[f"columns 'wrench.*.{part}'"] = both
        for name, trial in trials.items():
            if _usual(trial - np.median(trial, axis=0)) < BETTER * moving:
                left[name] = _usual(trial)
    return left


def _usual(vectors: Array) -> float:
    """Usual length of vectors (n, 3): the median, which a few bad samples do not move."""
    return float(np.median(np.linalg.norm(vectors, axis=1)))
