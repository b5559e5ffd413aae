"""Rows of Newton's law: what each misses, and what each error of a sensor or of the URDF adds to it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import FORCE, TORQUE, Array
from plantar.dynamics import Contact, Equation
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion
from plantar.robot.kinematics import centre_of_mass
from plantar.robot.model import RobotModel
from plantar.sensors.model_errors import imu_turn_slopes, link_errors
from plantar.sensors.moments.joint_torques import carrying_joints
from plantar.sensors.moments.law_bending import bending_torques, by_bending
from plantar.sensors.moments.sensor_errors import bush_directions, sensor_errors
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.sensors.newton_sides import SLOW
from plantar.signals.filters import low_pass, without_slow_cosines

RATE = 20.0  # Hz of the samples that take part: above it nothing has passed the filter
BAND = 2.0  # Hz: the robot moves below it, and most of the sensors' noise is above
QUICKER = 4.0  # Hz: where noise grows from below to above it, it is that of encoders' accelerations
TOGETHER = 32  # columns that are made at a time


class LawRow(NamedTuple):
    """One row of Newton's law: `signals` (n, c + 1) each `period` [s] are what it misses and its columns; `noise`
    (2, n, c + 1) is what of them is too quick for a robot, below and above QUICKER: zero of columns with little of it,
    (2, 0, c + 1) of a walk."""

    signals: Array
    period: float
    noise: NDArray[np.float32]


def law_rows(robot: RobotModel, residual: NewtonEulerResidual, steps: bool) -> Iterator[LawRow]:
    """Row by row: all at once would be the largest array of any log.

    Of a standing robot what is slower than BAND; of a walk, which moves faster, than QUICKER, so strongly that noise is
    small beside it there. Above it coarse encoders' accelerations had passed for torques that read too much.
    """
    stride = max(1, round(1 / (RATE * residual.pair.period)))
    torques = None
    if residual.accelerated:  # moments alone show no bending legs beside torques that read too much
        # Before samples are left out: derivatives of few would be too small, and joints seem to bend more.
        torques = bending_torques(robot, residual, quick=steps)[:, ::stride]
    residual = residual.thinned(stride)
    equation, period = equation_of(robot.floating_model), residual.pair.period
    motion = inertial_motion(
        robot, equation, residual.signals, residual.kept, encoders_late=residual.encoders_late
    )
    centre = (
        None if residual.accelerated else centre_of_mass(robot.model, *robot.tree.poses(motion.positions))
    )
    read = [
        _SensorReadings.of(robot, equation, residual, place, motion.positions, centre)
        for place in range(len(robot.feet))
    ]
    zeros = [-channel for one in read for channel in one.transfer.transpose(2, 0, 1)]
    by_gyroscope, by_mount = _imu_slopes(robot, equation, residual)
    by_torques = np.sum([one.by_torques for one in read], axis=0)
    groups = carrying_joints(robot)
    by_bends = np.zeros((len(groups), len(motion.positions), 6))
    if torques is not None:
        by_bends -= by_bending(robot, residual, groups, torques)
    by_motion = [*-by_mount, *by_bends, *residual.rates, residual.by_encoders, -by_gyroscope]
    # Some at a time and in single precision: all together would be the largest array of any log.
    errors = link_errors(robot)
    by_links = [
        wrench.astype(np.float32)
        for first in range(0, len(errors), TOGETHER)
        for wrench in _about(centre, equation.base_wrenches(motion, errors[first : first + TOGETHER]))
    ]
    slopes = [*(_about(centre, rows) for rows in by_motion), *by_torques, *by_links, *zeros]
    # Both sides anew: those of the residual lost slow parts over all of the log, what an end of it then shows of them
    # would be no column's.
    (predicted,) = _about(centre, equation.base_wrenches(motion, residual.parameters[None]))
    missing = predicted - np.sum([one.measured for one in read], axis=0)
    del residual, motion  # of all samples
    for row in range(6) if centre is None else range(6)[TORQUE]:
        signals = [missing[:, row], *_in_order([one.columns(row) for one in read])]
        signals, of_sensors = [*signals, *(one[:, row] for one in slopes)], len(signals)
        # Readings, joints that bend by them, and links' accelerations. Other slopes are smooth: their noise is not
        # white, and small below BAND.
        noisy = np.zeros(len(signals), dtype=bool)
        noisy[:of_sensors] = noisy[-len(by_links) - len(zeros) : -len(zeros)] = True
        noisy[of_sensors + len(by_mount) :][: len(groups)] = True
        slow = np.empty((len(missing), len(signals)))
        noise = np.zeros((2, 0 if steps else len(missing), len(signals)), dtype=np.float32)
        for first in range(0, len(signals), TOGETHER):
            some = slice(first, first + TOGETHER)
            # Without what postures and drifting zeros do to them.
            quick = without_slow_cosines(np.column_stack(signals[some]), period, SLOW)
            slow[:, some] = low_pass(quick, period, QUICKER if steps else BAND)
            if not steps and noisy[some].any():
                fast = (quick - slow[:, some]) * noisy[some]
                noise[0][:, some] = low_pass(fast, period, QUICKER)
                noise[1][:, some] = fast - noise[0][:, some]
        yield LawRow(slow, period, noise)


def _about(centre: Array | None, rows: Array) -> Array:
    """Rows (..., n, 6) of Newton's law with the moments about `centre` (n, 3) [m], without forces; all for None."""
    if centre is None:
        return rows
    moments = rows[..., TORQUE] - np.cross(centre, rows[..., FORCE])
    return np.concatenate([np.zeros_like(moments), moments], axis=-1)


@dataclass(frozen=True)
class _SensorReadings:
    """What one foot's sensor reads, `wrench` (n, 6), its `transfer` (n, 6, 6) to the root, and the `errors` (k, 6, 6)
    that may act on what it reads: gains of the torques about pitch and roll, then those of `sensor_errors`.

    `by_torques` (2, n, 6): how the measured side changes with the moments at which these torques are read.
    """

    wrench: Array
    transfer: Array
    errors: Array
    by_torques: Array

    @classmethod
    def of(
        cls,
        robot: RobotModel,
        equation: Equation,
        residual: NewtonEulerResidual,
        place: int,
        positions: Array,
        centre: Array | None,
    ) -> _SensorReadings:
        """Of one of the feet, by its place; positions: of the joints (n, joints); centre: as of `_about`."""
        foot, own = [*robot.feet.values()][place], slice(6 * place, 6 * place + 6)
        transfer = equation.base_transfer(positions, Contact(*robot.frame(foot.wrench.placement)))
        transfer = _about(centre, transfer.transpose(2, 0, 1)).transpose(1, 2, 0)
        alone = np.zeros((2, 6, 6))
        alone[:, 3:, 3:] = [np.outer(along, along) for along in bush_directions(robot, foot)]
        by_torques = (transfer @ (alone @ residual.changes[:, own].T).transpose(2, 1, 0)).transpose(2, 0, 1)
        errors = np.concatenate([alone, sensor_errors(robot)[0]])
        return cls(residual.readings[:, own], transfer, errors, by_torques)

    @property
    def measured(self) -> Array:
        """What the wrench is at the root, (n, 6)."""
        return np.asarray((self.transfer @ self.wrench[..., None])[..., 0])

    def columns(self, row: int) -> Array:
        """What each error adds to one row of the measured side, (k, n)."""
        pairs = self.transfer[:, row, :, None] * self.wrench[:, None]
        return np.asarray(self.errors.reshape(-1, 36) @ pairs.reshape(-1, 36).T)


def _in_order(feet: Sequence[Array]) -> Iterator[Array]:
    """Columns (k, n) of each foot as `MomentErrors` has them: gains of pitch, gains of roll, then all others."""
    yield from (own[gain] for gain in range(2) for own in feet)
    yield from (column for own in feet for column in own[2:])


def _imu_slopes(robot: RobotModel, equation: Equation, residual: NewtonEulerResidual) -> tuple[Array, Array]:
    """How the prediction changes with the moment at which the gyroscope is read, (n, 6), and with the angle [rad] by
    which the IMU is turned about each of its axes, (3, n, 6).
    """
    signals, kept, step = residual.signals, residual.kept, residual.signals.period
    late, early = (
        equation.base_wrenches(
            inertial_motion(robot, equation, signals, kept, gyroscope_late=by), residual.parameters[None]
        )[0]
        for by in (step, -step)
    )
    by_mount = imu_turn_slopes(robot, equation, signals, kept, residual.parameters)
    return (late - early) / (2 * step), by_mount
