"""What may be wrong where the moments of eq. 1's base rows do not balance: one column for each error of a sensor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain, islice

import numpy as np
import pinocchio as pin

from plantar.conventions import GRAVITY, Array
from plantar.dynamics import Contact, Equation
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion, turned_motions
from plantar.dynamics.motion import Motion
from plantar.robot.model import Foot, RobotModel
from plantar.sensors.load_errors import LEAST_GAIN
from plantar.sensors.model_errors import drawn_parameter_errors
from plantar.sensors.newton_euler import CUTOFF, NewtonEulerResidual
from plantar.sensors.newton_sides import SLOW
from plantar.signals.filters import gain, low_pass
from plantar.signals.slow_cosines import without_slow_cosines

LOOSE = 0.3  # share: deviation of a torque's gain before the moments are asked
LEAST_ARM = 0.003  # m, likewise as LEAST_GAIN
LEAST_BETWEEN = 0.001  # N.m/N, likewise
RATE = 20.0  # Hz of the samples that take part: above it nothing has passed the filter
BAND = 2.0  # Hz: the robot moves below it, and most of the sensors' noise is above
LATE = 0.02  # s, of feet's sensors, encoders and gyroscope behind the accelerometer
LATE_TORQUES = 0.005  # s, of torques behind the forces of the same sensors: mostly read together
MOUNT = 0.1  # rad, by which sensors and IMU may be turned: wide, so that no turned mount passes for a gain
KEPT_PER_BAND = 5.0  # samples for each period of BAND: far above what has passed the filter
TOGETHER = 8  # signals that are filtered at once
ZERO = 0.02  # of the weight: deviation of a force channel's zero, as between two recordings of one sensor
ZERO_ARM = 0.1  # m, times that: of a torque channel's, of a force about as far aside as a foot reaches
PARTS = 8  # of a log, as long as each other: what fits without one of them says how well it is known
TURN = 0.01  # rad, of the IMU, for the slope of what it predicts


@dataclass(frozen=True)
class MomentErrors:
    """One log's `columns` (6, k, n), and what they must add up to, `missing` (6, n).

    The first axis is the six rows of Newton's law.

    The columns are, in this order: torques about pitch of each foot, torques about roll of each foot, what else
    each foot's sensor may get wrong, the IMU's turn about its three axes, and the delays of each foot, of the
    encoders, of the gyroscope, and of all torques about pitch and about roll behind the forces. Behind them stand
    the log's own zeros of each channel of each foot, with deviations `zeros` (z,): at an arm that moves with the
    robot, a zero does not stay a constant. `products` (parts, 6, k + 1, k + 1) are those of missing and columns in
    each part of the log, without what the sensors' noise adds to them; `drawn` (6, k, draws) those of columns and
    what a wrong URDF adds; `independent` is the share of samples [each `period` s] that are.
    """

    columns: Array
    missing: Array
    products: Array
    drawn: Array
    period: float
    independent: float
    zeros: Array


def moment_errors(robot: RobotModel, residual: NewtonEulerResidual, steps: bool) -> MomentErrors:
    """The columns of one log in which Newton's law closes; `steps`: whether feet step in it.

    Of a standing robot what is slower than BAND, without what the sensors' noise does to it. A walk moves faster, and
    so strongly that noise is small beside it.
    """
    residual = residual.thinned(max(1, round(1 / (RATE * residual.pair.period))))
    equation = equation_of(robot.floating_model)
    motion = inertial_motion(
        robot, equation, residual.signals, residual.kept, encoders_late=residual.encoders_late
    )
    readings, zeros, measured, by_torques = _reading_columns(robot, equation, residual, motion.positions)
    by_gyroscope, by_mount = _imu_slopes(robot, equation, residual)
    slopes = [*-by_mount, *residual.rates, residual.by_encoders, -by_gyroscope, *by_torques, *zeros]
    period, count, drawn = residual.pair.period, len(readings) + len(slopes), drawn_parameter_errors(robot)
    # Both sides anew: those of the residual lost slow parts over all of the log, what an end of it then shows of them
    # would be no column's.
    (predicted,) = equation.base_wrenches(motion, residual.parameters[None])
    missing = predicted - measured
    del residual  # and the motion of all samples that it came from
    errors = chain.from_iterable(
        equation.base_wrenches(motion, drawn[first : first + TOGETHER])
        for first in range(0, len(drawn), TOGETHER)
    )
    every = _quick(chain([missing], readings, slopes, errors), period)
    samples, signals = len(missing), 1 + count + len(drawn)
    if steps:
        rows = np.empty((6, signals, samples))
        for first, some in every:
            _put(rows, first, some)
        return _errors(robot, rows, count, period, CUTOFF)
    # Slopes are smooth: their noise is not white, and small below BAND.
    stride, noisy = max(1, round(1 / (KEPT_PER_BAND * BAND * period))), 1 + len(readings)
    slow, noise = np.empty((6, signals, -(-samples // stride))), np.empty((6, noisy, samples))
    for first, some in every:
        read = low_pass(some, period, BAND)
        _put(slow, first, read[::stride])
        if first < noisy:
            _put(noise, first, (some - read)[:, : 6 * (noisy - first)])
    found = _errors(robot, slow, count, stride * period, BAND)
    share = _below_to_above(period) / stride
    found.products[..., :noisy, :noisy] -= share * _products(noise)
    return found


def _quick(signals: Iterable[Array], period: float) -> Iterator[tuple[int, Array]]:
    """Signals (n, 6) without what postures and drifting zeros do to them: some at a time, (n, 6 s), with the number of
    the first of these. All at once they would be the largest array of any log.
    """
    rest, first = iter(signals), 0
    while some := [*islice(rest, TOGETHER)]:
        yield first, without_slow_cosines(np.hstack(some), period, SLOW)
        first += len(some)


def _put(rows: Array, first: int, some: Array) -> None:
    """Write signals (n, 6 s) into (6, k, n), the rows of Newton's law apart, from the `first` of the k on."""
    rows[:, first : first + some.shape[1] // 6] = some.reshape(len(some), -1, 6).transpose(2, 1, 0)


def _errors(robot: RobotModel, rows: Array, count: int, period: float, band: float) -> MomentErrors:
    """Of what is missing, `count` columns and drawn URDFs, (6, k, n), that hold what is slower than `band` [Hz]."""
    columns, drawn = rows[:, : count + 1].copy(), rows[:, count + 1 :]
    products, wrong = _products(columns), columns[:, 1:] @ drawn.transpose(0, 2, 1)
    # A filtered signal has two independent samples in a period of its cutoff.
    independent = 2 * band * period
    zeros = _zero_deviations(robot)
    return MomentErrors(columns[:, 1:], columns[:, 0], products, wrong, period, independent, zeros)


def _products(columns: Array) -> Array:
    """Of columns (6, k, n) with each other, in each part of the log, (parts, 6, k, k)."""
    parts = np.array_split(columns, PARTS, axis=2)
    return np.array([part @ part.transpose(0, 2, 1) for part in parts])


def prior_deviations(robot: RobotModel) -> Array:
    """Deviations of the columns' coefficients before the moments are asked, (k,)."""
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


def _reading_columns(
    robot: RobotModel, equation: Equation, residual: NewtonEulerResidual, positions: Array
) -> tuple[list[Array], list[Array], Array, Array]:
    """What gains of torques and other errors of the feet's sensors add to the measured side; what one newton or
    newton-metre that each channel of each foot reads without any load adds to the prediction; (n, 6) each; the
    measured side, and how it changes with the moments at which all torques about pitch and about roll are read,
    (2, n, 6). positions: of the joints (n, joints).
    """
    matrices = _sensor_errors(robot)[0]
    gains: list[list[Array]] = [[], []]
    others, zeros, measured, by_torques = list[Array](), list[Array](), np.zeros(()), np.zeros(())
    for place, foot in enumerate(robot.feet.values()):
        wrench = residual.readings[:, 6 * place : 6 * place + 6]
        contact = Contact(*robot.frame(foot.wrench.placement))
        transfer = equation.base_transfer(positions, contact)
        alone = np.zeros((2, 6, 6))
        alone[:, 3:, 3:] = [np.outer(along, along) for along in _directions(robot, foot)]
        wrong = np.concatenate([alone, matrices]) @ wrench.T
        carried = np.asarray(transfer @ wrong.transpose(2, 1, 0)).transpose(2, 0, 1)
        for own, column in zip(gains, carried[:2], strict=True):
            own.append(column)
        others += [*carried[2:]]
        zeros += [*-transfer.transpose(2, 0, 1)]
        measured = measured + carried[2]  # the gain of all channels
        changes = alone @ residual.changes[:, 6 * place : 6 * place + 6].T
        by_torques = by_torques + np.asarray(transfer @ changes.transpose(2, 1, 0)).transpose(2, 0, 1)
    return [*gains[0], *gains[1], *others], zeros, measured, by_torques


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

    def slope(late: Motion, early: Motion, apart: float) -> Array:
        ends = [equation.base_wrenches(motion, residual.parameters[None])[0] for motion in (late, early)]
        return np.asarray((ends[0] - ends[1]) / apart)

    late, early = (inertial_motion(robot, equation, signals, kept, gyroscope_late=by) for by in (step, -step))
    turns = [pin.exp3(by * axis) for by in (TURN, -TURN) for axis in np.eye(3)]
    turned = turned_motions(robot, equation, signals, kept, turns)
    by_mount = [slope(*ends, 2 * TURN) for ends in zip(turned[:3], turned[3:], strict=True)]
    return slope(late, early, 2 * step), np.array(by_mount)


def _below_to_above(period: float) -> float:
    """Power of white noise below BAND over that above it, behind the filters that both have passed.

    The feet's own readings are in the columns and in what is missing: their noise, multiplied with itself, would pass
    for arms of centimetres. Above BAND is hardly anything else.
    """
    hertz = np.linspace(0.0, 0.5 / period, 2000)
    passed, slow = (gain(hertz, period, cutoff) for cutoff in (CUTOFF, BAND))
    return float(np.sum((passed * slow) ** 2) / np.sum((passed * (1 - slow)) ** 2))
