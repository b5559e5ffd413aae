"""The joints that carry the robot, and the torques behind their gears."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import Contact, model_parameters
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion, inertial_signals
from plantar.dynamics.motion import Motion
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import Placement, RobotModel
from plantar.sensors.newton_euler import CUTOFF, with_gyroscope


def carrying_joints(robot: RobotModel) -> list[list[int]]:
    """Places of the joints that the feet's numbers depend on: `leg_joints`, and each between the root and the IMU."""
    legs = leg_joints(robot)
    if robot.imu is None:
        return legs
    in_legs = {joint for group in legs for joint in group}
    return [*legs, *([joint] for joint in _above(robot, robot.imu.placement) if joint not in in_legs)]


def leg_joints(robot: RobotModel) -> list[list[int]]:
    """Places of the joints between the URDF's root and each foot, those of all legs together that are equally far down;
    each by itself where legs differ."""
    chains = leg_chains(robot)
    if len({len(chain) for chain in chains}) > 1:
        return [[joint] for joint in sorted({joint for chain in chains for joint in chain})]
    return [sorted(set(joints)) for joints in zip(*chains, strict=True)]


def leg_chains(robot: RobotModel) -> list[list[int]]:
    """Places of the joints between the URDF's root and each foot, from the root on."""
    return [_above(robot, foot.bush) for foot in robot.feet.values()]


def _above(robot: RobotModel, placement: Placement) -> list[int]:
    """Places of the joints between the root and a placement."""
    return [joint - 1 for joint in robot.model.supports[robot.frame(placement)[0]] if joint]


def joint_torques(robot: RobotModel, motion: Motion, parameters: Array | None, wrenches: Array) -> Array:
    """By which torques (n, joints) [N.m] what the feet's sensors read, `wrenches` (n, 6 feet), and the weight and the
    inertia of the links turn the joints of a robot in `motion` (eq. 1).

    parameters: of the links, (10 n_links,); None leaves them out.
    """
    equation = equation_of(robot.floating_model)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]
    feet = np.split(wrenches, len(contacts), axis=1)
    torques = equation.inverse_dynamics(motion, parameters, contacts, feet)
    return np.asarray(-torques[equation.first_joint_row :].T)


def torques_along(robot: RobotModel, log: MotionLog, parameters: Array | None = None) -> Array:
    """`joint_torques` along an evenly sampled log, (n, joints) [N.m]; between those of its neighbours where
    a foot's wrench is not known.

    parameters: of the links above the force sensors, (10 n_links,); the URDF's for None. Of an IMU that does not say
    how the robot moves, only what the feet's sensors read counts.
    """
    positions = log.positions(robot)
    wrenches = np.hstack([foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()])
    still = np.zeros_like(positions)
    resting = Motion(np.zeros((len(positions), 9)), positions, still, still)
    torques = _bridged(joint_torques(robot, resting, None, wrenches))
    complete = with_gyroscope(robot, log)
    if complete is not None:
        equation = equation_of(robot.floating_model)
        signals = inertial_signals(robot, complete, CUTOFF)
        motion = inertial_motion(robot, equation, signals, slice(None))
        own = model_parameters(robot.floating_model) if parameters is None else parameters
        torques += np.nan_to_num(joint_torques(robot, motion, own, np.zeros_like(wrenches)))
    return torques


def _bridged(values: Array) -> Array:
    """Rows (n, k) that are not known, between those that are: what jumps would seem to accelerate. Zeros of none."""
    known, every = np.isfinite(values).all(axis=1), np.arange(len(values))
    if not known.any():
        return np.zeros_like(values)
    return np.column_stack([np.interp(every, every[known], column[known]) for column in values.T])
