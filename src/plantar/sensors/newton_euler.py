"""Newton's law along one log: the ground's wrench as measured, and as IMU, encoders and URDF predict it (eq. 1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.contact.phases import shaken
from plantar.conventions import FORCE, GRAVITY, Array, Mask
from plantar.dynamics import Contact, Equation, model_parameters
from plantar.dynamics.inertial_motion import InertialSignals, inertial_motion, inertial_signals
from plantar.dynamics.motion import Motion
from plantar.estimation.delays.delay import LEAST_CLOSED, Pair, closes, unexplained
from plantar.estimation.delays.sensor_delays import Balance
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel
from plantar.sensors.below_sensor import below_sensors
from plantar.sensors.model_errors import drawn_parameter_errors
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import attitude
from plantar.signals.segments import longest_run

CUTOFF = 8.0  # Hz: above it differentiated encoders are noise
KEPT_RATE = 40.0  # Hz of the samples that are kept: the cutoff is far below
SLOW = 0.05  # Hz: below it both sides differ by postures and drifting zeros
BASE_ROWS = slice(0, 6)
WINDOW = 2.0  # s, in which the forces must follow from the prediction
SHORTEST = 8.0  # s that a log must offer without a push or a blow
DELAY_DRAWS = 16  # of a wrong URDF that take part in delays: these are filtered in every band
EDGE = 0.3  # s at both ends of a run, where the filter is unsure


@dataclass(frozen=True)
class NewtonEulerResidual:
    """Both sides of Newton's law in the root link's frame over the longest calm segment of a log.

    `pair`: all feet together; `measured` and `rates` (feet, n, 6): each foot's wrench, and how it changes with the
    moment at which its sensor is read; `by_encoders` (n, 6): how the prediction changes with the moment at which the
    encoders are. `readings` (n, 6 feet), the sensors' own without the zeros that swings show, and the samples `kept` of
    `signals` are what both sides come from; `parameters` (10 n_links,): of what moves above the force sensors.
    """

    pair: Pair
    measured: Array
    rates: Array
    by_encoders: Array
    readings: Array
    signals: InertialSignals
    kept: slice
    parameters: Array

    def thinned(self, stride: int) -> NewtonEulerResidual:
        """Every nth sample; `pair` without its draws of wrong models."""
        pair, rows = self.pair, slice(None, None, stride)
        measured, rate, predicted = pair.measured[rows], pair.rate[rows], pair.predicted[rows]
        kept = slice(self.kept.start, self.kept.stop, (self.kept.step or 1) * stride)
        return NewtonEulerResidual(
            Pair(pair.label, measured, rate, predicted, stride * pair.period),
            self.measured[:, rows],
            self.rates[:, rows],
            self.by_encoders[rows],
            self.readings[rows],
            replace(self.signals),
            kept,
            self.parameters,
        )

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
    signals = inertial_signals(robot, complete, CUTOFF)
    wrenches = np.hstack([foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()])
    whole = np.asarray(
        np.isfinite(np.hstack([signals.positions, signals.rate, signals.proper, wrenches])).all(axis=1)
    )
    edge = round(EDGE / log.period)
    longest = longest_run(whole & ~_struck(robot, wrenches, log.period))
    if (longest.stop - longest.start) * log.period < SHORTEST + 2 * EDGE:
        longest = longest_run(whole)
    if longest.stop - longest.start < 4 * edge + 400:
        return None
    equation = Equation(robot.floating_model)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]
    stride = max(1, round(1 / (KEPT_RATE * log.period)))
    period, inner = stride * log.period, slice(edge, longest.stop - longest.start - edge, stride)
    kept = slice(longest.start + edge, longest.stop - edge, stride)
    motion = inertial_motion(robot, signals, kept)

    def carried(readings: Array) -> list[Array]:
        split = [np.ascontiguousarray(readings[:, 6 * i : 6 * i + 6]) for i in range(len(contacts))]
        return [
            -equation.inverse_dynamics(motion, None, [contact], [own])[BASE_ROWS].T
            for contact, own in zip(contacts, split, strict=True)
        ]

    def predicted_by(motion: Motion) -> Array:
        return equation.inverse_dynamics(motion, parameters)[BASE_ROWS].T

    readings = low_pass(wrenches[longest], log.period, CUTOFF)
    below = below_sensors(robot, equation, motion, readings[inner], period)
    parameters, readings = model_parameters(robot.floating_model) - below.parameters, readings - below.zeros
    changes = differentiate(readings, log.period)[inner]
    sides = [*carried(readings[inner]), *carried(changes), predicted_by(motion)]
    step = log.period
    late, early = (inertial_motion(robot, signals, kept, encoders_late=by) for by in (step, -step))
    sides.append((predicted_by(late) - predicted_by(early)) / (2 * step))
    moving = _moving(sides, period)
    measured, rates = moving[: len(contacts)], moving[len(contacts) : -2]
    calm = _longest_closed(measured.sum(axis=0), rates.sum(axis=0), moving[-2], period)
    measured, rates, predicted, by_encoders = (part[..., calm, :] for part in (measured, rates, *moving[-2:]))
    pair = Pair(log.name, measured.sum(axis=0), rates.sum(axis=0), predicted, period)
    if len(predicted) < round(SHORTEST / period) or not closes(pair):
        return None
    motion = motion.select(calm)
    pair = replace(pair, model_errors=predicted_errors(robot, motion, DELAY_DRAWS))
    # A copy of the signals holds no differences yet: of all logs together these are large.
    start, stop, _ = calm.indices(len(range(*kept.indices(len(log)))))
    own = slice(kept.start + start * stride, kept.start + stop * stride, stride)
    return NewtonEulerResidual(
        pair, measured, rates, by_encoders, readings[inner][calm], replace(signals), own, parameters
    )


def predicted_errors(robot: RobotModel, motion: Motion, draws: int | None = None) -> Array:
    """What inertial parameters as wrong as the robot file allows would add to the prediction, (draws, n, 6)."""
    equation, drawn = Equation(robot.floating_model), drawn_parameter_errors(robot)[:draws]
    errors = [equation.inverse_dynamics(motion, one)[BASE_ROWS].T for one in drawn]
    return np.array(errors).reshape(len(errors), len(motion.positions), 6)


def _moving(sides: Sequence[Array], period: float) -> Array:
    """Sides (k, n, 6) without what postures and drifting zeros do to them."""
    rows = np.hstack(sides)
    return (rows - low_pass(rows, period, SLOW)).reshape(len(rows), -1, 6).transpose(1, 0, 2)


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
