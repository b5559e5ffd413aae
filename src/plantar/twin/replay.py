"""Identified feet in a simulator: a recording's joints played open loop on a fresh twin, and what it feels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np
from scipy.signal import detrend
from scipy.spatial.transform import Rotation

from plantar.contact.balance import flat_soles, soles_in_root
from plantar.contact.phases import LIFTING_SHARE
from plantar.conventions import GRAVITY, ROTATIONAL_AXES, Array, rotation_from_quaternion
from plantar.errors import DataError, MotionError, PlantarError
from plantar.logs.motion_log import MotionLog
from plantar.motions.plan import RATE, Hand, Plan
from plantar.results.feet import FeetResult
from plantar.robot.model import Foot, RobotModel
from plantar.signals.filters import low_pass
from plantar.twin.bush import Bush, Feet
from plantar.twin.holding_torques import holding_torques
from plantar.twin.log_at import check_whole, log_at
from plantar.twin.play import Progress, roll_each
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import exact_columns
from plantar.twin.simulation.mjcf import SERVO_ANGLE
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout

SMOOTH: Final = 10.0  # Hz: encoder steps are no motion
REFERENCE: Final = 1.0  # s at the start that zeros of force sensors are taken from, and that are not scored
MODELS: Final = ("kelvin_voigt", "hardening", "elastoplastic", "hardening_elastoplastic")
REQUIRED: Final = ("stiffness", "damping")  # of each axis that turns


@dataclass(frozen=True)
class Replayed:
    """One motion on one candidate's feet beside the recording, at `time` (N,).

    `torque` and `recorded_torque`: by (foot, axis), (N,) [N·m] at the bush, relative to their mean over the first
    second; `chest` and `recorded_chest`: pitch and roll of the IMU's link, (N, 2) [rad], the simulated one
    `moved_onto` the recorded.
    """

    motion: str
    feet: str
    time: Array
    torque: Mapping[tuple[str, str], Array]
    recorded_torque: Mapping[tuple[str, str], Array]
    chest: Array
    recorded_chest: Array

    def torque_error(self, foot: str, axis: str) -> float:
        """Mean absolute error of a foot's torque after the first second [N·m]."""
        scored = self.time > self.time[0] + REFERENCE
        return float(np.mean(np.abs(self.torque[foot, axis] - self.recorded_torque[foot, axis])[scored]))

    def chest_error(self, until: float = np.inf) -> tuple[float, float]:
        """Root mean square error of the chest's pitch and roll [rad], over the first `until` seconds."""
        scored = self.time <= self.time[0] + until
        pitch, roll = np.sqrt(np.mean((self.chest - self.recorded_chest)[scored] ** 2, axis=0))
        return float(pitch), float(roll)


def moved_onto(recorded: Array, other: Array) -> Array:
    """Attitudes `other` (N, 3, 3), body to world, less what a record's own world is turned by; (N, 3) up in the body.

    The bias and the slow drift of a recorded attitude (N, 3, 3) turn its world a little, by a straight line in time;
    they are not the feet's. The turn that brings `other` nearest to the record, by least squares over all samples,
    is taken out. Yaw does not enter.
    """
    leaning = np.einsum("nij,nj->ni", recorded, other[:, 2, :])  # the other's vertical in the record's world
    level = np.asarray(detrend(leaning[:, :2], axis=0))
    upright = np.sqrt(1.0 - np.sum(level**2, axis=1))
    return np.asarray(np.einsum("nji,nj->ni", recorded, np.column_stack([level, upright])))


def pitch_and_roll(up: Array) -> Array:
    """Pitch and roll, (N, 2) [rad], of a body that sees the world's up at `up` (N, 3)."""
    return np.column_stack([-np.arcsin(up[:, 0]), np.arctan2(up[:, 1], up[:, 2])])


def chest_attitude(robot: RobotModel, log: MotionLog) -> Array:
    """The attitude of the IMU's link, body to world, (N, 3, 3); its axes are the soles' at the first sample, however
    IMU and link are turned. Raises DataError where the log has none."""
    quaternions = log.orientation(robot.imu.name) if robot.imu is not None else None
    if robot.imu is None or quaternions is None:
        raise DataError("holds no attitude to compare with", path=log.source)
    first = log.positions(robot)[:1]
    joint, imu = robot.frame(robot.imu.placement)
    mount = robot.tree.poses(first)[0][joint, 0] @ imu.rotation
    soles = Rotation.from_matrix([pose[:3, :3] for pose in soles_in_root(robot, first[0]).values()]).mean()
    return np.asarray(rotation_from_quaternion(quaternions) @ mount.T @ soles.as_matrix())


def replay(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    candidates: Mapping[str, Feet | None],
    hands: Mapping[str, Hand] | None = None,
    progress: Progress | None = None,
) -> list[Replayed]:
    """Play recordings open loop on each candidate's feet (None: rigid ones), on all cores.

    Servos follow the recorded joints; `hands`, by motion, lead the robot where an operator did. Where a candidate
    lets the robot fall, that one is missing from the list. Raises DataError where a log holds no attitude.
    """
    plans = [plan_of(robot, log, (hands or {}).get(log.name)) for log in logs]
    records = [record_of(robot, log, plan) for log, plan in zip(logs, plans, strict=True)]
    pairs = [(place, feet) for feet in candidates for place in range(len(plans))]
    jobs = [
        (replace(plans[place], name=f"{plans[place].name} on {feet}"), Physics(bushes=candidates[feet]))
        for place, feet in pairs
    ]
    rollouts = zip(pairs, roll_each(jobs, robot, progress), strict=True)
    return [
        beside(robot, plans[place], feet, rollout, records[place])
        for (place, feet), rollout in rollouts
        if not isinstance(rollout, MotionError)
    ]


@dataclass(frozen=True)
class Record:
    """What a log holds at a plan's times: `torque` as in `Replayed`, `attitude` (N, 3, 3) of the IMU, body to world."""

    torque: Mapping[tuple[str, str], Array]
    attitude: Array


def record_of(robot: RobotModel, log: MotionLog, plan: Plan) -> Record:
    """A log at the times of its plan. Raises DataError where it holds no attitude."""
    record = log_at(log, log.time[0] + plan.time)
    made = Record(_torques(robot, record), chest_attitude(robot, record))
    check_whole(log, "the attitudes", plan.time, made.attitude)
    check_whole(log, "the wrenches", plan.time, np.column_stack(list(made.torque.values())))
    return made


def beside(robot: RobotModel, plan: Plan, feet: str, rollout: Rollout, record: Record) -> Replayed:
    """A rollout of a plan on some feet beside what was recorded."""
    played = MotionLog(plan.name, plan.time, exact_columns(rollout, robot, cut_feet(describe(robot), robot)))
    chest = pitch_and_roll(moved_onto(record.attitude, chest_attitude(robot, played)))
    recorded = pitch_and_roll(record.attitude[:, 2, :])
    return Replayed(plan.name, feet, plan.time, _torques(robot, played), record.torque, chest, recorded)


def feet_of(result: FeetResult) -> Feet:
    """The bushes that a result describes.

    Where the twin has no element for an axis' model, the spring and damper that fit its motions best are played; z
    keeps the twin's own where the result has none.

    Raises PlantarError when a foot has no stiffness or damping of pitch or roll.
    """
    linear = {
        (axis.foot, axis.axis): axis.linear_equivalent for axis in result.models if axis.model not in MODELS
    }
    played = {field.name for field in fields(Bush)}
    values: dict[str, dict[str, float]] = {}
    for row in result.parameters:
        name = f"{row.axis}_{row.name}"
        if (row.foot, row.axis) in linear or name not in played or row.value is None:
            continue
        if row.axis != "z" or row.value > 0:
            values.setdefault(row.foot, {})[name] = row.value
    for (foot, axis), found in linear.items():
        terms = {f"{axis}_stiffness": found.stiffness, f"{axis}_damping": found.damping}
        values.setdefault(foot, {}).update(terms)
    for foot, own in values.items():
        missing = {f"{axis}_{term}" for axis in ROTATIONAL_AXES for term in REQUIRED} - own.keys()
        if missing:
            raise PlantarError(f"the result has no {min(missing)} of the {foot} foot")
    return {foot: Bush(**own) for foot, own in values.items()}


def plan_times(log: MotionLog) -> Array:
    """Of the samples of a log's plan, from its first sample on [s]."""
    return np.arange(int((log.time[-1] - log.time[0]) * RATE + 1e-6) + 1) / RATE


def plan_of(robot: RobotModel, log: MotionLog, hand: Hand | None = None) -> Plan:
    """The recorded joints as a plan at 200 Hz, from where the first sample stands on flat soles.

    A servo's give is added, so that it stands where the recorded one did: under the recorded efforts, or, of a joint
    that has none, under those that hold the robot against gravity on the recorded wrenches.
    """
    time = plan_times(log)
    recorded = log_at(log, log.time[0] + time)
    positions = recorded.positions(robot)
    check_whole(log, "the joints", time, positions)
    limits = {body.joint: body.effort for body in describe(robot).bodies[1:]}
    held = holding_torques(robot, recorded)
    for place, joint in enumerate(robot.joint_names):
        effort = recorded.joint(joint, "effort")
        effort = held[:, place] if effort is None else np.nan_to_num(effort)
        positions[:, place] += effort * SERVO_ANGLE / limits[joint]
    positions = low_pass(positions, 1 / RATE, SMOOTH)
    soles = flat_soles(robot, recorded.positions(robot)[0])
    least = LIFTING_SHARE * robot.mass * GRAVITY
    standing = frozenset(
        name
        for name, foot in robot.feet.items()
        if np.nanmedian(_bush_wrench(robot, foot, recorded)[0][:, 2]) > least
    )
    if not standing:
        raise DataError("no foot carries the robot", path=log.source)
    base = np.tile(_root(robot, recorded.positions(robot)[0], soles, standing), (time.size, 1, 1))
    stance = {name: soles[name] for name in soles if name in standing}
    return Plan(log.name, time, robot.joint_names, positions, base, standing, stance, hand)


def _root(
    robot: RobotModel, positions: Array, soles: Mapping[str, Array], standing: AbstractSet[str]
) -> Array:
    """Pose (4, 4) of the root that puts one sole where it stands and no corner of the others below the ground.

    Encoders are not exact and legs bend, so that a second sole may end millimetres deep: stiff ground would throw the
    robot over.
    """
    first = min(standing)
    placed = soles_in_root(robot, positions)
    root = np.asarray(soles[first] @ np.linalg.inv(placed[first]))
    heights = [
        (root @ placed[name] @ np.array([*corner, 0.0, 1.0]))[2]
        for name in standing
        for corner in robot.feet[name].sole.polygon
    ]
    root[2, 3] -= min(0.0, *heights)
    return root


def _torques(robot: RobotModel, log: MotionLog) -> dict[tuple[str, str], Array]:
    """Pitch and roll torque at each foot's bush centre, less its mean over the first second."""
    torques = {}
    for name, foot in robot.feet.items():
        torque = _changed(log, _bush_wrench(robot, foot, log)[1])
        torques[name, "pitch"], torques[name, "roll"] = torque[:, 1], torque[:, 0]
    return torques


def _bush_wrench(robot: RobotModel, foot: Foot, log: MotionLog) -> tuple[Array, Array]:
    """Force and torque (n, 3) on the robot at the bush centre, in the bush's own axes [N, N·m]."""
    wrench = foot.wrench.sign * log.wrench(foot.wrench.name)
    to_bush = (robot.frame(foot.bush)[1].inverse() * robot.frame(foot.wrench.placement)[1]).homogeneous
    force, torque = wrench[:, :3] @ to_bush[:3, :3].T, wrench[:, 3:] @ to_bush[:3, :3].T
    return force, torque + np.cross(to_bush[:3, 3], force)


def _changed(log: MotionLog, values: Array) -> Array:
    return np.asarray(values - values[log.time < log.time[0] + REFERENCE].mean(axis=0))
