"""Logs of joints that bend beyond their encoders."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel


def before_gears(robot: RobotModel, log: MotionLog, compliance: float, joints: Sequence[str]) -> MotionLog:
    """The log with encoders on the motor's side of `joints` that bend by `compliance` [rad/(N.m)]: what a joint turns
    under the feet's wrenches lacks in its reading. Moments by Pinocchio's Jacobians, sample by sample."""
    model = robot.model
    data = model.createData()
    moments = np.zeros((len(log), len(joints)))
    places = [robot.frame(foot.wrench.placement) for foot in robot.feet.values()]
    wrenches = [foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()]
    rows = [model.idx_vs[model.getJointId(name)] for name in joints]
    for sample, positions in enumerate(log.positions(robot)):
        pin.computeJointJacobians(model, data, robot.configuration(positions))
        for (parent, placement), wrench in zip(places, wrenches, strict=True):
            jacobian = placement.inverse().action @ pin.getJointJacobian(model, data, parent, pin.LOCAL)
            moments[sample] += (jacobian.T @ wrench[sample])[rows]
    columns = [f"joint.{name}.position" for name in joints]
    read = [log.column(name) - compliance * own for name, own in zip(columns, moments.T, strict=True)]
    return log.with_columns(dict(zip(columns, read, strict=True)))
