"""An IMU's acceleration where no accelerometer is recorded: that of a point over soles that stand.

A sole that stands does not move, so that the IMU's acceleration is the opposite of the sole's as seen from the IMU, by
encoders and orientation. Feet count by the share of the load that they carry.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plantar.contact.deflection import FootMotion, foot_motion, path_to
from plantar.conventions import FORCE, GRAVITY, Array, rotation_from_quaternion
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import unit_quaternions
from plantar.signals.resampling import shifted

# Hz: what is differentiated twice has no noise above it; far above what Newton's law is looked at below.
DERIVED = 20.0
LEAST_LOAD = 0.3  # of the weight, that the feet carry together: with less the robot hangs or jumps


class StandingAcceleration(NamedTuple):
    """The IMU's `proper` acceleration in its own frame, (N, 3) [m/s²], NaN where no foot carries the robot, and how it
    changes with the moment at which encoders are read, `by_encoders` (N, 3) [m/s³]."""

    proper: Array
    by_encoders: Array


def standing_acceleration(robot: RobotModel, log: MotionLog) -> StandingAcceleration | None:
    """What soles say of an evenly sampled log; None without an IMU or its orientation."""
    imu = robot.imu
    read = None if imu is None else log.orientation(imu.name)
    if read is None:
        return None
    orientation, positions, period = unit_quaternions(read), log.positions(robot), log.period
    motions, forces = standing_feet(robot, log, orientation)
    loads = np.clip(np.column_stack(list(forces.values())), 0.0, None)
    total = loads.sum(axis=1, keepdims=True)
    shares = loads / np.where(total > LEAST_LOAD * robot.mass * GRAVITY, total, np.nan)
    rotation = rotation_from_quaternion(orientation)

    def proper(feet: dict[str, FootMotion]) -> Array:
        places = low_pass(np.hstack([foot.sole_position for foot in feet.values()]), period, DERIVED)
        away = differentiate(differentiate(places, period), period).reshape(len(places), -1, 3)
        world = -np.einsum("nf,nfi->ni", shares, away) + [0.0, 0.0, GRAVITY]
        return np.asarray(np.einsum("nij,ni->nj", rotation, world))

    late, early = (
        proper(sole_motions(robot, shifted(positions, period, by), orientation)) for by in (period, -period)
    )
    return StandingAcceleration(proper(motions), (late - early) / (2 * period))


def standing_feet(
    robot: RobotModel, log: MotionLog, orientation: Array
) -> tuple[dict[str, FootMotion], dict[str, Array]]:
    """Where the soles of a log are, without rates, and what each foot carries (N,) [N].

    orientation: unit quaternions w x y z, IMU to world, (N, 4).
    """
    motions, forces = sole_motions(robot, log.positions(robot), orientation), dict[str, Array]()
    for name, foot in robot.feet.items():
        _, _, to_bush = path_to(robot, name)
        turn = (to_bush * robot.frame(foot.wrench.placement)[1]).rotation
        read = foot.wrench.sign * log.wrench(foot.wrench.name)[:, FORCE] @ turn.T
        forces[name] = np.einsum("ni,ni->n", motions[name].up, read)
    return motions, forces


def sole_motions(robot: RobotModel, positions: Array, orientation: Array) -> dict[str, FootMotion]:
    """Where the soles are by joints (N, n_joints) and unit quaternions (N, 4), without rates."""
    still, velocities = np.zeros((len(positions), 3)), np.zeros_like(positions)
    paths = {name: path_to(robot, name)[0] for name in robot.feet}
    return {
        name: foot_motion(path, positions, velocities, orientation, still) for name, path in paths.items()
    }
