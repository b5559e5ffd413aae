"""An IMU's acceleration where no accelerometer is recorded: that of a point over soles that stand.

A sole that stands does not move, so that the IMU's acceleration is the opposite of the sole's as seen from the IMU, by
encoders and orientation. Feet count by the share of the load that they carry.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from plantar.contact.deflection import FootMotion, foot_motion, path_to
from plantar.conventions import FORCE, GRAVITY, Array, rotation_from_quaternion
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import unit_quaternions
from plantar.signals.resampling import shifted

# Hz: what is differentiated twice has no noise above it; far above what Newton's law is looked at below.
DERIVED = 20.0
TURN = 0.01  # rad, for the slope of what the IMU reads
LEAST_LOAD = 0.3  # of the weight, that the feet carry together: with less the robot hangs or jumps


@dataclass(frozen=True)
class StandingImu:
    """An IMU over soles that stand.

    `orientation` (N, 4): unit quaternions w x y z, IMU to world; `positions` (N, n_joints) [rad or m]; `shares`
    (N, feet): of the load that each foot carries, NaN where all carry too little.
    """

    robot: RobotModel
    orientation: Array
    positions: Array
    shares: Array
    period: float

    @classmethod
    def of(cls, robot: RobotModel, log: MotionLog) -> StandingImu | None:
        """Of an evenly sampled log; None without an IMU or its orientation."""
        read = None if robot.imu is None else log.orientation(robot.imu.name)
        if read is None:
            return None
        orientation, positions = unit_quaternions(read), log.positions(robot)
        loads = standing_loads(robot, log, sole_motions(robot, positions, orientation))
        pushed = np.clip(np.column_stack(list(loads.values())), 0.0, None)
        total = pushed.sum(axis=1, keepdims=True)
        shares = pushed / np.where(total > LEAST_LOAD * robot.mass * GRAVITY, total, np.nan)
        return cls(robot, orientation, positions, shares, log.period)

    def proper(self, encoders_late: float = 0.0, turn: Array | None = None) -> Array:
        """Its proper acceleration in its own frame, (N, 3) [m/s²], of encoders that report late [s], and of an IMU that
        is turned by a rotation (3, 3) from where the robot file has it."""
        positions = shifted(self.positions, self.period, encoders_late) if encoders_late else self.positions
        soles = sole_motions(self.robot, positions, self.orientation).values()
        rotation = rotation_from_quaternion(self.orientation)
        places = np.hstack([sole.sole_position for sole in soles])
        if turn is not None:
            seen = np.einsum("nij,nfi->nfj", rotation, places.reshape(len(places), -1, 3)) @ turn
            places = np.einsum("nij,nfj->nfi", rotation, seen).reshape(places.shape)
        places = low_pass(places, self.period, DERIVED)
        away = differentiate(differentiate(places, self.period), self.period).reshape(len(places), -1, 3)
        world = -np.einsum("nf,nfi->ni", self.shares, away) + [0.0, 0.0, GRAVITY]
        return np.asarray(np.einsum("nij,ni->nj", rotation, world))

    @property
    def along_encoders(self) -> tuple[Array, Array]:
        """`proper`, and how it changes with the moment at which encoders are read, (N, 3) [m/s³]."""
        return self.proper(), (self.proper(self.period) - self.proper(-self.period)) / (2 * self.period)

    @property
    def by_turn(self) -> list[Array]:
        """How it changes as the IMU turns in its mount about each of its own axes, (N, 3) [m/s² per rad]."""
        ends = [[self.proper(turn=pin.exp3(by * axis)) for by in (TURN, -TURN)] for axis in np.eye(3)]
        return [(one - other) / (2 * TURN) for one, other in ends]


def sole_motions(robot: RobotModel, positions: Array, orientation: Array) -> dict[str, FootMotion]:
    """Where the soles are by joints (N, n_joints) and unit quaternions (N, 4), without rates."""
    still, velocities = np.zeros((len(positions), 3)), np.zeros_like(positions)
    paths = {name: path_to(robot, name)[0] for name in robot.feet}
    return {
        name: foot_motion(path, positions, velocities, orientation, still) for name, path in paths.items()
    }


def standing_loads(robot: RobotModel, log: MotionLog, soles: dict[str, FootMotion]) -> dict[str, Array]:
    """What each foot of a log carries along the vertical of its sole's motion, (N,) [N]."""
    loads = dict[str, Array]()
    for name, foot in robot.feet.items():
        _, _, to_bush = path_to(robot, name)
        turn = (to_bush * robot.frame(foot.wrench.placement)[1]).rotation
        read = foot.wrench.sign * log.wrench(foot.wrench.name)[:, FORCE] @ turn.T
        loads[name] = np.einsum("ni,ni->n", soles[name].up, read)
    return loads
