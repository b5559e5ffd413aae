"""Newton's law along one log: the ground's wrench as measured, and as IMU, encoders and URDF predict it (eq. 1)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin

from plantar.contact.phases import shaken
from plantar.conventions import FORCE, GRAVITY, Array, Mask
from plantar.dynamics import Contact, Equation, model_parameters
from plantar.dynamics.inertial_motion import inertial_motion
from plantar.dynamics.motion import Motion
from plantar.estimation.delay import LEAST_CLOSED, Pair, closes, unexplained
from plantar.estimation.sensor_delays import Balance
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel
from plantar.sensors.model_errors import drawn_parameter_errors
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import attitude
from plantar.signals.resampling import shifted
from plantar.signals.segments import longest_run

CUTOFF = 8.0  # Hz: above it differentiated encoders are noise
KEPT_RATE = 67.0  # Hz of the samples that are kept: the cutoff is far below
SLOW = 0.05  # Hz: below it both sides differ by postures and drifting zeros
BASE_ROWS = slice(0, 6)
WINDOW = 2.0  # s, in which the forces must follow from the prediction
SHORTEST = 8.0  # s that a log must offer without a push or a blow
TURN = 0.01  # rad, of the IMU, for the slope of what it predicts
EDGE = 0.3  # s at both ends of a run, where the filter is unsure


@dataclass(frozen=True)
class NewtonEulerResidual:
    """Both sides of Newton's law in the root link's frame over the longest calm segment of a log.

    `pair`: all feet together; `measured` and `rates` (feet, n, 6): each foot's wrench, and how it changes with the
    moment at which its sensor is read; `by_encoders` (n, 6): how the prediction changes with the moment at which the
    encoders are, `by_gyroscope` (n, 6): with that of the gyroscope; `by_mount` (3, n, 6): with the angle [rad] by
    which the IMU is turned about each of its axes. `motion` and `readings` (n, 6 feet), the sensors' own, are what both
    sides come from.
    """

    pair: Pair
    measured: Array
    rates: Array
    by_encoders: Array
    by_gyroscope: Array
    by_mount: Array
    motion: Motion
    readings: Array

    @property
    def balance(self) -> Balance:
        """Feet and encoders apart: delays of each foot, then of the encoders, all against the IMU."""
        by_delay = np.concatenate([self.rates, -self.by_encoders[None]])
        pair = self.pair
        return Balance(pair.predicted, self.measured, by_delay, pair.period, pair.model_errors)


def with_gyroscope(robot: RobotModel, log: MotionLog) -> MotionLog | None:
    """The log with an angular velocity, from its orientation where it has none; None where Newton has no terms."""
    imu = robot.imu
    if imu is None or any(foot.contact == "always" for foot in robot.feet.values()):
        return None
    gyroscope = imu_columns(imu.name, "angular_velocity")
    turns = log.has(*gyroscope) or log.orientation(imu.name) is not None
    if not turns or not log.has_imu(imu.name, "linear_acceleration"):
        return None
    if log.has(*gyroscope):
        return log
    return log.with_columns(dict(zip(gyroscope, attitude(log, imu, [])[1].T, strict=True)))


def newton_euler_residual(robot: RobotModel, log: MotionLog) -> NewtonEulerResidual | None:
    """Both sides along an evenly sampled log; None where it lacks what that takes, or does not close."""
    complete = with_gyroscope(robot, log)
    if complete is None:
        return None
    log = complete
    motion = inertial_motion(robot, log, CUTOFF)
    wrenches = np.hstack([foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()])
    whole = motion.finite & np.isfinite(wrenches).all(axis=1)
    edge = round(EDGE / log.period)
    longest = longest_run(whole & ~_struck(robot, wrenches, log.period))
    if (longest.stop - longest.start) * log.period < SHORTEST + 2 * EDGE:
        longest = longest_run(whole)
    if longest.stop - longest.start < 4 * edge + 400:
        return None
    equation, parameters = Equation(robot.floating_model), model_parameters(robot.floating_model)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]
    stride = max(1, round(1 / (KEPT_RATE * log.period)))
    period, inner = stride * log.period, slice(edge, longest.stop - longest.start - edge, stride)
    kept = slice(longest.start + edge, longest.stop - edge, stride)
    part = motion.select(kept)

    def carried(readings: Array) -> list[Array]:
        split = [np.ascontiguousarray(readings[:, 6 * i : 6 * i + 6]) for i in range(len(contacts))]
        return [
            -equation.inverse_dynamics(part, None, [contact], [own])[BASE_ROWS].T
            for contact, own in zip(contacts, split, strict=True)
        ]

    def predicted_by(motion: Motion) -> Array:
        return equation.inverse_dynamics(motion, parameters)[BASE_ROWS].T

    readings = low_pass(wrenches[longest], log.period, CUTOFF)
    changes = differentiate(readings, log.period)[inner]

    def moving(sides: Sequence[Array]) -> Array:
        rows = np.hstack(sides)
        return (rows - low_pass(rows, period, SLOW)).reshape(len(rows), -1, 6).transpose(1, 0, 2)

    sides = moving([*carried(readings[inner]), *carried(changes), predicted_by(part)])
    measured, rates, predicted = sides[: len(contacts)], sides[len(contacts) : -1], sides[-1]
    calm = _longest_closed(measured.sum(axis=0), rates.sum(axis=0), predicted, period)
    measured, rates, predicted = measured[:, calm], rates[:, calm], predicted[calm]
    pair = Pair(log.name, measured.sum(axis=0), rates.sum(axis=0), predicted, period)
    if len(predicted) * period < SHORTEST or not closes(pair):
        return None
    errors = [
        equation.inverse_dynamics(part, drawn)[BASE_ROWS].T[calm] for drawn in drawn_parameter_errors(robot)
    ]
    pair = replace(pair, model_errors=np.array(errors)) if errors else pair
    by_encoders, by_gyroscope, *by_mount = moving(_slopes(robot, log, kept, predicted_by))[:, calm]
    return NewtonEulerResidual(
        pair,
        measured,
        rates,
        by_encoders,
        by_gyroscope,
        np.array(by_mount),
        part.select(calm),
        readings[inner][calm],
    )


def _slopes(
    robot: RobotModel, log: MotionLog, kept: slice, predicted_by: Callable[[Motion], Array]
) -> list[Array]:
    """How the prediction (n, 6) changes with the moments at which encoders and gyroscope are read, and with turns of
    the IMU about its axes.
    """
    assert robot.imu is not None
    gyroscope = imu_columns(robot.imu.name, "angular_velocity")

    def predicted(encoders: float = 0.0, gyro: float = 0.0, turn: Array | None = None) -> Array:
        read = shifted(log.stack(gyroscope), log.period, gyro)
        moved = log.with_columns(dict(zip(gyroscope, read.T, strict=True)))
        turned = None if turn is None else pin.exp3(turn)
        return predicted_by(inertial_motion(robot, moved, CUTOFF, encoders, kept, turned))

    step, turns = log.period, TURN * np.eye(3)
    return [
        (predicted(encoders=step) - predicted(encoders=-step)) / (2 * step),
        (predicted(gyro=step) - predicted(gyro=-step)) / (2 * step),
        *((predicted(turn=turn) - predicted(turn=-turn)) / (2 * TURN) for turn in turns),
    ]


def _struck(robot: RobotModel, wrenches: Array, period: float) -> Mask:
    """Samples in which a sole slaps the floor: faster than the samples resolve, so that nothing follows from them."""
    weight, feet = robot.mass * GRAVITY, range(len(robot.feet))
    shocks = [shaken(wrenches[:, 6 * place : 6 * place + 3], weight, period) for place in feet]
    return np.asarray(np.any(shocks, axis=0))


def _longest_closed(measured: Array, rate: Array, predicted: Array, period: float) -> slice:
    """The longest segment in which nobody pushes and nothing strikes: there the forces follow from the prediction."""
    width = round(WINDOW / period)
    measured, rate, predicted = measured[:, FORCE], rate[:, FORCE], predicted[:, FORCE]
    usual = float(np.mean(np.sum(measured**2, axis=1)))
    closed = np.zeros(len(measured), dtype=bool)
    for window in (slice(i * width, (i + 1) * width) for i in range(len(measured) // width)):
        power = float(np.mean(np.sum(measured[window] ** 2, axis=1)))
        missing = unexplained(measured[window], rate[window], predicted[window]) / width
        closed[window] = missing < (1 - LEAST_CLOSED) * max(power, usual)
    return longest_run(closed)
