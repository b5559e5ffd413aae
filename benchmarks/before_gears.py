"""Logs of joints that bend beyond their encoders."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion, inertial_signals
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.sensors.newton_euler import with_gyroscope

CUTOFF = 8.0  # Hz of the links' accelerations


def before_gears(
    robot: RobotModel, log: MotionLog, compliance: float, joints: Sequence[str], links: bool = True
) -> MotionLog:
    """The log with encoders on the motor's side of `joints` that bend by `compliance` [rad/(N.m)]: what a joint turns
    under the feet's wrenches, and under the `links`' weight and inertia, lacks in its reading."""
    torques = torques_in(robot, log, links)
    columns = [f"joint.{name}.position" for name in joints]
    places = [robot.joint_names.index(name) for name in joints]
    read = [
        log.column(name) - compliance * torques[:, place] for name, place in zip(columns, places, strict=True)
    ]
    return log.with_columns(dict(zip(columns, read, strict=True)))


def torques_in(robot: RobotModel, log: MotionLog, links: bool = True) -> Array:
    """By which torques all joints are turned, (N, joints) [N.m], by Pinocchio's recursion, sample by sample; by the
    feet's wrenches alone without `links`, or where the IMU does not say how these move."""
    model, positions = pin.Model(robot.floating_model), log.positions(robot)
    model.gravity = pin.Motion.Zero()  # a root's proper acceleration holds it
    data, complete = model.createData(), with_gyroscope(robot, log) if links else None
    base, velocities, accelerations = np.zeros((len(log), 9)), *np.zeros((2, *positions.shape))
    if complete is None:
        for body in model.inertias:
            body.mass, body.inertia = 0.0, np.zeros((3, 3))
    else:
        signals = inertial_signals(robot, complete, CUTOFF)
        motion = inertial_motion(robot, equation_of(model), signals, slice(None))
        base, velocities, accelerations = motion.base, motion.velocities, motion.accelerations
    feet = [(robot.frame(foot.wrench.placement), foot.wrench) for foot in robot.feet.values()]
    read = [(place, wrench.sign * log.wrench(wrench.name)) for place, wrench in feet]
    torques = np.empty_like(positions)
    for row, own in enumerate(positions):
        outside = pin.StdVec_Force(model.njoints * [pin.Force.Zero()])
        for (joint, placement), wrenches in read:
            outside[joint + 1] += placement.act(pin.Force(wrenches[row]))  # behind the root's own joint
        q = np.r_[pin.neutral(model)[:7], robot.configuration(own)]
        v = np.r_[np.zeros(3), base[row, 3:6], velocities[row]]
        a = np.r_[base[row, :3], base[row, 6:], accelerations[row]]
        torques[row] = -pin.rnea(model, data, q, v, a, outside)[6:]
    return torques
