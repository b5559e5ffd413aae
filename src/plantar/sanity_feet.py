"""Swapped feet: do the wrenches balance gravity better when left and right are exchanged?"""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY, Array, rotation_from_quaternion
from plantar.log import MotionLog
from plantar.robot import RobotModel

SAMPLES = 50  # spread over the log: enough to tell
BETTER = 0.5  # share of the misfit that must be left after the exchange
NOTABLE = 0.02  # m: a lever below it is within the model's own error


def swapped_feet(robot: RobotModel, log: MotionLog) -> bool:
    """Whether two feet's wrenches, exchanged, put the centre of pressure under the centre of mass far better.

    Quasi-static: the moment of both wrenches about the centre of mass, over the weight, as a lever [m].
    """
    imu = robot.imu
    if imu is None or len(robot.feet) != 2:
        return False
    orientation = log.orientation(imu.name)
    if orientation is None:
        return False
    wrenches = [foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()]
    positions = log.positions(robot)
    whole = np.isfinite(np.column_stack([orientation, positions, *wrenches])).all(axis=1)
    whole &= np.linalg.norm(np.nan_to_num(orientation), axis=1) > 0.5
    loaded = whole & (sum(np.abs(w[:, 2]) for w in wrenches) > 0.3 * robot.mass * GRAVITY)
    rows = np.flatnonzero(loaded)[:: max(1, int(loaded.sum() // SAMPLES))]
    if rows.size < 10:
        return False
    data = robot.model.createData()
    levers = np.array(
        [_levers(robot, data, positions[i], orientation[i], [w[i] for w in wrenches]) for i in rows]
    )
    as_is, exchanged = np.sqrt(np.mean(levers**2, axis=0))
    return bool(as_is > NOTABLE and exchanged < BETTER * as_is)


def _levers(
    robot: RobotModel, data: pin.Data, position: Array, orientation: Array, wrenches: list[Array]
) -> tuple[float, float]:
    """Lever of the total wrench about the centre of mass, as recorded and with the feet exchanged [m]."""
    model = robot.model
    configuration = pin.neutral(model)
    for joint, angle in enumerate(position, start=1):
        at = model.idx_qs[joint]
        if model.nqs[joint] == 1:
            configuration[at] = angle
        else:
            configuration[at : at + 2] = np.cos(angle), np.sin(angle)
    # The root link is fixed in `model`, and Pinocchio leaves what does not move out of the centre of mass.
    root, moving = model.inertias[0], robot.mass - model.inertias[0].mass
    centre = (root.mass * root.lever + moving * pin.centerOfMass(model, data, configuration)) / robot.mass
    assert robot.imu is not None
    joint, in_joint = robot.frame(robot.imu.placement)
    up = (data.oMi[joint] * in_joint).rotation @ rotation_from_quaternion(orientation[None])[0][2]
    frames = []
    for foot in robot.feet.values():
        carrier, placement = robot.frame(foot.wrench.placement)
        frames.append(data.oMi[carrier] * placement)
    found = []
    for order in (wrenches, wrenches[::-1]):
        force, moment = np.zeros(3), np.zeros(3)
        for frame, wrench in zip(frames, order, strict=True):
            push = frame.rotation @ wrench[:3]
            force += push
            moment += frame.rotation @ wrench[3:] + np.cross(frame.translation - centre, push)
        level = moment - up * (moment @ up)
        found.append(float(np.linalg.norm(level) / max(abs(force @ up), 1.0)))
    return found[0], found[1]
