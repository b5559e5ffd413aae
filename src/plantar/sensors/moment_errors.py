"""What may be wrong where the moments of eq. 1's base rows do not balance: one column for each error of a sensor."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from plantar.conventions import FORCE, GRAVITY, TORQUE, Array
from plantar.dynamics import Contact, Equation
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion
from plantar.robot.kinematics import centre_of_mass
from plantar.robot.model import Foot, RobotModel
from plantar.sensors.load_errors import APART, LEAST_GAIN
from plantar.sensors.model_errors import imu_turn_slopes, link_errors
from plantar.sensors.newton_euler import CUTOFF, NewtonEulerResidual
from plantar.sensors.newton_sides import SLOW
from plantar.signals.filters import gain, low_pass
from plantar.signals.slow_cosines import without_slow_cosines

LOOSE = 0.3  # share: deviation of a torque's gain before the moments are asked
LEAST_ARM = 0.003  # m, likewise as LEAST_GAIN
LEAST_BETWEEN = 0.001  # N.m/N, likewise
RATE = 20.0  # Hz of the samples that take part: above it nothing has passed the filter
BAND = 2.0  # Hz: the robot moves below it, and most of the sensors' noise is above
QUICKER = 4.0  # Hz: where noise grows from below to above it, it is that of encoders' accelerations
LATE = 0.02  # s, of feet's sensors, encoders and gyroscope behind the accelerometer
LATE_TORQUES = 0.01  # s, of torques behind the forces of the same sensors: mostly read together
MOUNT = 0.1  # rad, by which sensors and IMU may be turned: wide, so that no turned mount passes for a gain
KEPT_PER_BAND = 5.0  # samples for each period of BAND: far above what has passed the filter
ZERO = 0.02  # of the weight: deviation of a force channel's zero, as between two recordings of one sensor
ZERO_ARM = 0.1  # m, times that: of a torque channel's, of a force about as far aside as a foot reaches
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
    (2, n, k) is what of some of them, which are `noisy` (k,), is too quick to be the robot's, below and above QUICKER:
    of none of a walk."""

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
        for factor, noise in zip(_below_to_above(row.period) / stride, row.noise, strict=True):
            products[-1][:, row.noisy[:, None], row.noisy] -= factor * _products(noise)
    return MomentErrors(np.array(products), np.array(power), share, _zero_deviations(robot))


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
        noise = np.empty((2, len(missing), len(noisy)), dtype=np.float32)
        for first in range(0, len(signals), TOGETHER):
            some = slice(first, first + TOGETHER)
            # Without what postures and drifting zeros do to them.
            quick = without_slow_cosines(np.column_stack(signals[some]), period, SLOW)
            slow[:, some] = quick if steps else low_pass(quick, period, BAND)
            own = (first <= noisy) & (noisy < first + TOGETHER)
            if own.any():
                fast = (quick - slow[:, some])[:, noisy[own] - first]
                noise[0][:, own] = low_pass(fast, period, QUICKER)
                noise[1][:, own] = fast - noise[0][:, own]
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


def prior_deviations(robot: RobotModel) -> Array:
    """Deviations of the sensors' coefficients before the moments are asked, (k,): of all columns before the links'."""
    feet = len(robot.feet)
    of_feet = np.tile(_sensor_errors(robot)[1], feet)
    late = [*np.full(feet + 2, LATE), *np.full(2, LATE_TORQUES)]
    return np.concatenate([np.full(2 * feet, LOOSE), of_feet, np.full(3, MOUNT), late])


def turn_columns(robot: RobotModel) -> dict[str, slice]:
    """By foot, the three columns of its force sensor's turn."""
    feet, own = len(robot.feet), len(_sensor_errors(robot)[1])
    starts = {
        foot: 2 * feet + place * own + 4 for place, foot in enumerate(robot.feet)
    }  # behind gain and place
    return {foot: slice(start, start + 3) for foot, start in starts.items()}


@dataclass(frozen=True)
class _SensorReadings:
    """What one foot's sensor reads, `wrench` (n, 6), its `transfer` (n, 6, 6) to the root, and the `errors` (k, 6, 6)
    that may act on what it reads: gains of the torques about pitch and roll, then those of `_sensor_errors`.

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
        alone[:, 3:, 3:] = [np.outer(along, along) for along in _directions(robot, foot)]
        by_torques = (transfer @ (alone @ residual.changes[:, own].T).transpose(2, 1, 0)).transpose(2, 0, 1)
        errors = np.concatenate([alone, _sensor_errors(robot)[0]])
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


def _zero_deviations(robot: RobotModel) -> Array:
    """Deviations of the channels' zeros before the moments are asked, (6 feet,) [N, N.m]."""
    force = ZERO * robot.mass * GRAVITY
    return np.tile(np.repeat([force, ZERO_ARM * force], 3), len(robot.feet))


def _sensor_errors(robot: RobotModel) -> tuple[Array, Array]:
    """What else a force sensor may get wrong: matrices (k, 6, 6) that act on what it reads, and their deviations (k,).

    The gain of all channels, the place along x, y and z, the turn about them, each channel's own gain and what one
    channel does to another; no torque reaches a force.
    """
    uncertainty = robot.uncertainty
    share = max(uncertainty.wrench_gain, LEAST_GAIN)
    place = max(uncertainty.bush_position, LEAST_ARM)
    between = max(uncertainty.wrench_crosstalk, LEAST_BETWEEN)
    none, crosses = np.zeros((3, 3)), [pin.skew(axis) for axis in np.eye(3)]
    errors = [(np.eye(6), share)]
    errors += [(np.block([[none, none], [cross, none]]), place) for cross in crosses]
    errors += [(np.block([[cross, none], [none, cross]]), MOUNT) for cross in crosses]
    for read, real in (pair for pair in np.ndindex(6, 6) if pair[0] >= 3 or pair[1] < 3):
        single = np.zeros((6, 6))
        single[read, real] = 1.0
        errors.append((single, share if read == real else between))
    matrices, deviations = zip(*errors, strict=True)
    return np.array(matrices), np.array(deviations)


def _directions(robot: RobotModel, foot: Foot) -> Array:
    """The bush's pitch and roll axes in the force sensor's frame, (2, 3)."""
    sensor, bush = (robot.frame(each)[1].rotation for each in (foot.wrench.placement, foot.bush))
    return np.asarray((bush.T @ sensor)[[1, 0]])


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


def _below_to_above(period: float) -> Array:
    """Factors (2,) of the power of noise above BAND, below and above QUICKER, that make its power below BAND.

    The feet's own readings are in the columns and in what is missing: their noise, multiplied with itself, would pass
    for arms of centimetres. Above BAND is hardly anything else. The noise of forces and IMU is white, that of
    encoders' accelerations grows with the fourth power of the frequency; the factors are right for both.
    """
    hertz = np.linspace(0.0, 0.5 / period, 2000)
    passed, slow, middle = (gain(hertz, period, cutoff) for cutoff in (CUTOFF, BAND, QUICKER))
    bands = passed * [slow, (1 - slow) * middle, (1 - slow) * (1 - middle)]
    below, *above = (bands**2) @ np.column_stack([np.ones_like(hertz), hertz**4])
    return np.linalg.solve(np.array(above).T, below)
