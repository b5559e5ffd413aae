"""The rows of Newton's law of one log: what they miss, and a column for each error of a sensor or a link."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import FORCE, TORQUE, Array
from plantar.dynamics import Contact, Equation
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion
from plantar.robot.kinematics import centre_of_mass
from plantar.robot.model import RobotModel
from plantar.sensors.load_errors import APART
from plantar.sensors.model_errors import imu_turn_slopes, link_errors
from plantar.sensors.newton_euler import CUTOFF, NewtonEulerResidual
from plantar.sensors.newton_sides import SLOW
from plantar.sensors.sensor_errors import directions, sensor_errors, zero_deviations
from plantar.signals.filters import gain, low_pass, without_slow_cosines

RATE = 20.0  # Hz of the samples that take part: above it nothing has passed the filter
BAND = 2.0  # Hz: the robot moves below it, and most of the sensors' noise is above
KEPT_PER_BAND = 5.0  # samples for each period of BAND: far above what has passed the filter
TOGETHER = 32  # columns that are made at a time
PARTS = 8  # of a log, as long as each other: what fits without one of them says how well it is known


class MomentErrors(NamedTuple):
    """What one log's rows of Newton's law miss and the columns that may explain it, multiplied with each other.

    The rows are the six of Newton's law, or, of a log without an accelerometer, the moments about the centre of mass:
    how the robot accelerates does not enter them. `products` (rows, parts, c + 1, c + 1) are those of what is missing,
    then its columns, in each part of the log without what the sensors' noise adds to them; `power` (rows, c + 1,
    c + 1) their means over all samples, with it. `share`: of a sample, that counts as an independent one.

    The columns are, in this order: torques about pitch of each foot, torques about roll of each foot, what else
    each foot's sensor may get wrong, the IMU's turn about its three axes, and the delays of each foot, of the
    encoders, of the gyroscope, and of all torques about pitch and about roll behind the forces. Behind them stands
    what one deviation of the URDF's links adds, and the log's own zeros of each channel of each foot, with deviations
    `zeros` (z,): at an arm that moves with the robot, a zero does not stay a constant.
    """

    products: Array
    power: Array
    share: float
    zeros: Array


class MomentRow(NamedTuple):
    """One row of Newton's law: `signals` (n, c + 1) each `period` [s] are what it misses and its columns; `noise`
    (n, k) is what of some of them, which are `noisy` (k,), is too quick to be the robot's: of none of a walk."""

    signals: Array
    period: float
    noisy: Array
    noise: NDArray[np.float32]


def moment_errors(robot: RobotModel, residual: NewtonEulerResidual, steps: bool) -> MomentErrors:
    """Of one log in which Newton's law closes; `steps`: whether feet step in it."""
    products, power, share = [], [], 0.0
    for row in moment_rows(robot, residual, steps):
        stride = 1 if steps else max(1, round(1 / (KEPT_PER_BAND * BAND * row.period)))
        own = row.signals[::stride]
        products.append(_products(own))
        power.append(products[-1].sum(axis=0) / len(own))
        share = stride * row.period / APART
        below = _below_to_above(row.period) / stride
        products[-1][:, row.noisy[:, None], row.noisy] -= below * _products(row.noise)
    return MomentErrors(np.array(products), np.array(power), share, zero_deviations(robot))


def moment_rows(robot: RobotModel, residual: NewtonEulerResidual, steps: bool) -> Iterator[MomentRow]:
    """Row by row: all at once would be the largest array of any log.

    Of a standing robot what is slower than BAND. A walk moves faster, and so strongly that noise is small beside it.
    """
    residual = residual.thinned(max(1, round(1 / (RATE * residual.pair.period))))
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
    by_motion = [*-by_mount, *residual.rates, residual.by_encoders, -by_gyroscope]
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
        # Readings and links' accelerations. Slopes are smooth: their noise is not white, and small below BAND.
        links = len(signals) - len(zeros) - len(by_links)
        noisy = np.r_[:of_sensors, links : links + len(by_links)][: 0 if steps else None]
        slow = np.empty((len(missing), len(signals)))
        noise = np.empty((len(missing), len(noisy)), dtype=np.float32)
        for first in range(0, len(signals), TOGETHER):
            some = slice(first, first + TOGETHER)
            # Without what postures and drifting zeros do to them.
            quick = without_slow_cosines(np.column_stack(signals[some]), period, SLOW)
            slow[:, some] = quick if steps else low_pass(quick, period, BAND)
            own = (first <= noisy) & (noisy < first + TOGETHER)
            noise[:, own] = (quick - slow[:, some])[:, noisy[own] - first]
        yield MomentRow(slow, period, noisy, noise)


def _about(centre: Array | None, rows: Array) -> Array:
    """Rows (..., n, 6) of Newton's law with the moments about `centre` (n, 3) [m], without forces; all for None."""
    if centre is None:
        return rows
    moments = rows[..., TORQUE] - np.cross(centre, rows[..., FORCE])
    return np.concatenate([np.zeros_like(moments), moments], axis=-1)


def _products(columns: NDArray[Any]) -> Array:
    """Of columns (n, k) with each other, in each part of the log, (parts, k, k)."""
    return np.array([part.T @ part for part in np.array_split(columns, PARTS)])


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
        alone[:, 3:, 3:] = [np.outer(along, along) for along in directions(robot, foot)]
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


def _below_to_above(period: float) -> float:
    """Power of white noise below BAND over that above it, behind the filters that both have passed.

    The feet's own readings are in the columns and in what is missing: their noise, multiplied with itself, would pass
    for arms of centimetres. Above BAND is hardly anything else.
    """
    hertz = np.linspace(0.0, 0.5 / period, 2000)
    passed, slow = (gain(hertz, period, cutoff) for cutoff in (CUTOFF, BAND))
    return float(np.sum((passed * slow) ** 2) / np.sum((passed * (1 - slow)) ** 2))
