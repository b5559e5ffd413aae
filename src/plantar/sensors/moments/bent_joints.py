"""Joints that bend where their encoders do not see it, such as those behind gears, and what Newton's law shows of them.

The feet then push from other places and in other directions than the encoders say. A leg that gives way tilts its
force sensor, which the horizontal forces show, and shifts the body over the foot, which the moments show.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from plantar.conventions import GRAVITY, NORMAL95, Array
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.delays.sensor_delay import SensorDelay, beside_encoders
from plantar.sensors.moments.bending_odds import bending_odds
from plantar.sensors.moments.joint_torques import carrying_joints, leg_chains, torques_along
from plantar.sensors.moments.moment_fit import MomentFit
from plantar.sensors.moments.sensor_errors import compliance_columns

BENT = "joints_bend"
# rad, with the robot's weight at a metre: deviation of what stiff joints seem to bend by. A URDF's legs that are a
# little too short do as much; 24 simulated robots under wrong URDFs seemed to by no more than this and noise explain.
USUAL = 0.004
# Chance that joints bend, from which logs are put right by it. Of 72 simulated robots whose joints are stiff none comes
# above 0.49; of 55 whose joints bend all but three that hardly do, or whose ankles alone do, above 0.52.
LIKELY = 0.5
# Chance from which it is left open: logs stay as they are, and numbers are as sure as what joints may bend by. Eight of
# those 72 come above it.
OPEN = 0.4
ANKLE = 2  # joints next to the foot, which may bend alone: most are driven together, by linkages of their own
# Joints that bend accelerate the links, which changes torques by up to a tenth: after these passes a hundredth is left.
PASSES = 3


class JointBending(NamedTuple):
    """How far joints bend beyond their encoders, in the order of the robot's joints.

    `compliances` (joints,) [rad/(N.m)] that logs are put right by, and what is left open of them, `covariance` (joints,
    joints). `mean`, `std`: what the moments show of all of them together; None where they show nothing.
    """

    compliances: Array
    covariance: Array
    mean: float | None = None
    std: float | None = None

    @property
    def found(self) -> bool:
        """Whether logs are to be put right."""
        return bool(self.compliances.any())

    def by_joint(self, robot: RobotModel) -> dict[str, float]:
        """The compliance of each joint that logs are put right by."""
        pairs = zip(robot.joint_names, self.compliances.tolist(), strict=True)
        return {name: value for name, value in pairs if value}

    @classmethod
    def told(cls, robot: RobotModel) -> JointBending:
        """What the robot file allows for, the same in all joints."""
        joints = len(robot.joint_names)
        variance = robot.uncertainty.joint_compliance**2
        return cls(np.zeros(joints), np.full((joints, joints), variance))


def joint_bending(robot: RobotModel, fit: MomentFit | None, put_right: Array | None = None) -> JointBending:
    """What the moments of a robot's motion show, beside what its file says, of the joints that carry it.

    put_right: by which compliances (joints,) [rad/(N.m)] the logs were put straight that the moments are of.
    """
    told = JointBending.told(robot)
    if fit is None:
        return told
    groups, columns = carrying_joints(robot), compliance_columns(robot)
    values, load, every = fit.values[columns], robot.mass * GRAVITY, np.ones(len(groups))
    first = [joints[0] for joints in groups]
    if put_right is not None:
        values = values + put_right[first]
    covariance = (USUAL / load) ** 2 * (np.outer(every, every) + np.eye(len(every)))
    for part in fit.parts:  # of few degrees of freedom: Student's variance
        covariance += part.freedom / (part.freedom - 2) * part.covariance[columns, columns]
    weights = np.linalg.solve(covariance, every)
    weights /= weights.sum()
    mean, std = float(weights @ values), float(np.sqrt(weights @ covariance @ weights))
    chains = leg_chains(robot)
    legs, ankles = (
        np.isin(first, [joint for chain in chains for joint in chain[-last:]]).astype(float)
        for last in (max(map(len, chains)), ANKLE)
    )
    size = robot.uncertainty.joint_compliance
    odds = bending_odds(load * values, load**2 * covariance, (every, legs, ankles), load * size)
    if not size and (odds.chance < OPEN or mean < 0):  # what bends against its load is another fault
        return told._replace(mean=mean, std=std)
    spread = np.zeros((len(told.compliances), len(groups)))
    for place, joints in enumerate(groups):
        spread[joints, place] = 1 / load
    if not size and odds.chance < LIKELY:
        about_stiff = odds.covariance + np.outer(odds.mean, odds.mean)
        return told._replace(covariance=spread @ about_stiff @ spread.T, mean=mean, std=std)
    return JointBending(spread @ odds.mean, spread @ odds.covariance @ spread.T, mean, std)


def joint_bending_notes(robot: RobotModel, bending: JointBending) -> list[Note]:
    """By how much joints were taken to bend, where logs were put right."""
    if not bending.found:
        return []
    stds = np.sqrt(np.diag(bending.covariance))
    each = ", ".join(
        f"{robot.joint_names[joint]} {1e3 * bending.compliances[joint]:.3f} ± {1e3 * NORMAL95 * stds[joint]:.3f}"
        for joint in (joints[0] for joints in carrying_joints(robot))
    )
    text = (
        f"the moments of the robot's motion show joints that bend beyond their encoders, as behind gears: {each} "
        "mrad/(N·m) (95 %; of the other legs' likewise). Angles are put right by it, and what it leaves open widens K "
        "and C (encoders on the links' side of the gears see all of it)"
    )
    return [Note(BENT, "info", text)]


def stored_bends(robot: RobotModel, compliances: Mapping[str, float]) -> Array:
    """Of each joint (joints,) [rad/(N.m)], by what a result holds of those that bend."""
    return np.array([compliances.get(joint, 0.0) for joint in robot.joint_names])


def put_straight(
    robot: RobotModel,
    log: MotionLog,
    compliances: Array,
    delay: SensorDelay,
    parameters: Array | None = None,
) -> MotionLog:
    """The log with joints where their links are, which bend by `compliances` (joints,) beyond their encoders; with
    `delay` its sensors were read. parameters: as of `torques_along`."""
    positions, at_once = log.positions(robot), beside_encoders(robot, log, delay)
    names = [f"joint.{robot.joint_names[place]}.position" for place in np.flatnonzero(compliances)]
    bent = positions
    for _ in range(PASSES):
        turned = dict(zip(names, bent[:, compliances != 0].T, strict=True))
        bent = positions + compliances * torques_along(robot, at_once.with_columns(turned), parameters)
    columns = dict(zip(names, bent[:, compliances != 0].T, strict=True))
    return log.with_columns({name: values for name, values in columns.items() if log.has(name)})
