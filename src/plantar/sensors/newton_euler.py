"""Newton's law along one log: the ground's wrench as measured, and as IMU, encoders and URDF predict it (eq. 1)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from plantar.contact.phases import hoisted, shaken
from plantar.conventions import FORCE, GRAVITY, Array, Mask
from plantar.dynamics import Contact, model_parameters
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import InertialSignals, inertial_motion, inertial_signals
from plantar.dynamics.motion import Motion
from plantar.estimation.delays.delay import Pair, closes
from plantar.estimation.delays.sensor_delays import Balance
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.robot.model import RobotModel
from plantar.sensors.below_sensor import below_sensors, counts_below
from plantar.sensors.load_errors import FootLoads
from plantar.sensors.model_errors import drawn_imu_turns, drawn_parameter_errors, imu_turn_slopes
from plantar.sensors.newton_sides import SLOW, STOOD, NewtonSides, carried, moving
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import attitude
from plantar.signals.segments import longest_run, runs

CUTOFF = 8.0  # Hz: above it differentiated encoders are noise
KEPT_RATE = 40.0  # Hz of the samples that are kept: the cutoff is far below
SHORTEST = 8.0  # s that a log must offer without a push or a blow
EDGE = 0.3  # s at both ends of a run, where the filter is unsure


@dataclass(frozen=True)
class NewtonEulerResidual:
    """Both sides of Newton's law in the root link's frame over the longest calm segment of a run of a log.

    `pair`: all feet together; `measured` and `rates` (feet, n, 6): each foot's wrench, and how it changes with the
    moment at which its sensor is read, both without what `load_errors` took off; `by_encoders` (n, 6): how what
    is predicted beyond the measured changes with the moment at which the encoders are: joints also say where the feet
    push. `readings` (n, 6 feet), the sensors' own without the
    zeros that swings show, and the samples `kept` of `signals` are what both sides come from; `parameters`
    (10 n_links,): of what moves above the force sensors. `changes` (n, 6 feet) [1/s]: of the readings; `stands`:
    nothing was taken off for what swings show; `encoders_late` [s]: by which the encoders are read later than the
    `signals` have them.
    """

    pair: Pair
    measured: Array
    rates: Array
    by_encoders: Array
    readings: Array
    signals: InertialSignals
    kept: slice
    parameters: Array
    changes: Array
    stands: bool
    encoders_late: float = 0.0

    @property
    def accelerated(self) -> bool:
        """Whether an accelerometer said how the robot accelerates, and not the soles that stand."""
        return self.signals.by_encoders is None

    def thinned(self, stride: int) -> NewtonEulerResidual:
        """Every nth sample; `pair` without its draws of wrong models."""
        pair, rows = self.pair, slice(None, None, stride)
        measured, rate, predicted = pair.measured[rows], pair.rate[rows], pair.predicted[rows]
        kept = slice(self.kept.start, self.kept.stop, (self.kept.step or 1) * stride)
        return replace(
            self,
            pair=Pair(pair.label, measured, rate, predicted, stride * pair.period),
            measured=self.measured[:, rows],
            rates=self.rates[:, rows],
            by_encoders=self.by_encoders[rows],
            readings=self.readings[rows],
            signals=replace(self.signals),
            kept=kept,
            changes=self.changes[rows],
        )

    def with_bands(self) -> NewtonEulerResidual:
        """The same with all bands filtered, and without the draws of wrong models, which stand in these."""
        return replace(self, pair=replace(self.pair.slim, known=self.balance.bands))

    def read_later(self, by: Array) -> NewtonEulerResidual:
        """Each foot's sensor and the encoders read `by` (feet + 1,) [s] later, with its bands: by their rates, which do
        for a millisecond where the robot `stands`. What swings show is another thing then."""
        pair, own = self.pair, by[:-1, None, None] * self.rates
        return replace(
            self,
            pair=replace(
                pair,
                measured=pair.measured + own.sum(axis=0),
                predicted=pair.predicted + by[-1] * self.by_encoders,
                known=[band.read_later(by) for band in pair.bands],
            ),
            measured=self.measured + own,
            readings=self.readings + np.repeat(by[:-1], 6) * self.changes,
            encoders_late=self.encoders_late + float(by[-1]),
        )

    @cached_property
    def balance(self) -> Balance:
        """Feet and encoders apart: delays of each foot, then of the encoders, all against the IMU."""
        by_delay = np.concatenate([self.rates, -self.by_encoders[None]])
        pair = self.pair
        return Balance(pair.predicted, self.measured, by_delay, pair.period, pair.model_errors, pair.known)


def with_gyroscope(robot: RobotModel, log: MotionLog) -> MotionLog | None:
    """The log with an angular velocity, from its orientation where it has none; None where Newton has no terms."""
    imu = robot.imu
    if imu is None or any(foot.contact == "always" for foot in robot.feet.values()):
        return None
    gyroscope = imu_columns(imu.name, "angular_velocity")
    turns, accelerates = log.has(*gyroscope), log.has_imu(imu.name, "linear_acceleration")
    if not (turns and accelerates) and log.orientation(imu.name) is None:
        return None
    if turns:
        return log
    return log.with_columns(dict(zip(gyroscope, attitude(log, imu, [])[1].T, strict=True)))


def newton_euler_residuals(robot: RobotModel, log: MotionLog) -> list[NewtonEulerResidual]:
    """Both sides along an evenly sampled log, in each run without a gap; none where it lacks what that takes, or in
    none the law closes."""
    complete = with_gyroscope(robot, log)
    if complete is None:
        return []
    signals = inertial_signals(robot, complete, CUTOFF)
    wrenches = np.hstack([foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()])
    runs_of_log = _known_runs(robot, log, signals, wrenches)
    # Of a long recording each run may have a delay of its own, hours after the last one.
    labels = [
        f"{log.name} from {log.time[run.start]:.0f} s" if log.left_out else log.name for run in runs_of_log
    ]
    found = [
        _along(robot, log, label, signals.during(run), wrenches[run])
        for label, run in zip(labels, runs_of_log, strict=True)
    ]
    return [one for one in found if one is not None]


def _along(
    robot: RobotModel, log: MotionLog, label: str, signals: InertialSignals, wrenches: Array
) -> NewtonEulerResidual | None:
    """Both sides in the longest segment in which nobody pushes, of the signals of a run; None where it is too short."""
    edge, count = round(EDGE / log.period), len(wrenches)
    if count < 4 * edge + 400:
        return None
    equation = equation_of(robot.floating_model)
    stride = max(1, round(1 / (KEPT_RATE * log.period)))
    period, kept = stride * log.period, slice(edge, count - edge, stride)
    motion = inertial_motion(robot, equation, signals, kept)
    readings = low_pass(wrenches, log.period, CUTOFF)
    below = below_sensors(robot, equation, motion, readings[kept], period)
    parameters, readings = model_parameters(robot.floating_model), readings - below.zeros
    # Copies: views of a long log's samples would keep all of them.
    loads = FootLoads.of(readings[kept].copy(), differentiate(readings, log.period)[kept].copy())

    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]

    def sides_of(motion: Motion) -> tuple[Array, list[Array]]:
        predicted = np.asarray(equation.base_wrenches(motion, parameters[None])[0])
        return predicted, [equation.base_transfer(motion.positions, contact) for contact in contacts]

    def missing_late(by: float) -> Array:
        predicted, transfers = sides_of(inertial_motion(robot, equation, signals, kept, encoders_late=by))
        return np.asarray(predicted - np.sum(carried(transfers, loads.readings), axis=0))

    predicted, transfers = sides_of(motion)
    band = (SLOW, np.inf) if signals.by_encoders is None else STOOD
    if below.parameters.any():
        hangs = np.asarray(equation.base_wrenches(motion, below.parameters[None])[0])
        missed = predicted - np.sum(carried(transfers, loads.readings), axis=0)
        if counts_below(*moving([missed, hangs], period, band)):
            parameters, predicted = parameters - below.parameters, predicted - hangs
    by_encoders = (missing_late(log.period) - missing_late(-log.period)) / (2 * log.period)
    # A copy holds no differences yet: of long logs, and of all together, these are large.
    signals = replace(signals)
    predicted, by_encoders = moving([predicted, by_encoders], period, band)
    sides = NewtonSides(loads, transfers, predicted, by_encoders, period, band)
    found = sides.closed(robot.uncertainty, label, round(SHORTEST / period))
    if found is None or not closes(found.pair):
        return None
    calm = found.calm
    start, stop, _ = calm.indices(len(range(*kept.indices(count))))
    rows = slice(kept.start + start * stride, kept.start + stop * stride, stride)
    errors = equation.base_wrenches(motion.select(calm), drawn_parameter_errors(robot))
    turns = drawn_imu_turns(robot)
    if signals.by_turn is not None and len(turns):
        # What an accelerometer reads as it turns stays nearly as it is; what soles say of it does not.
        turned = np.tensordot(turns, imu_turn_slopes(robot, equation, signals, rows, parameters), 1)
        errors = turned + errors if len(errors) else turned
    pair = replace(found.pair, model_errors=errors)
    return NewtonEulerResidual(
        pair,
        found.measured,
        found.rates,
        by_encoders[calm],
        loads.readings[calm],
        signals,
        rows,
        parameters,
        loads.changes[calm],
        not below.parameters.any() and not below.zeros.any(),
    )


def _known_runs(robot: RobotModel, log: MotionLog, signals: InertialSignals, wrenches: Array) -> list[slice]:
    """The runs in which all is known, no sole slaps the floor and nothing else carries the robot in part, or, were all
    short, the longest one in which all is known."""
    sides, period = (signals.positions, signals.rate, signals.proper, wrenches), signals.period
    # Unlike its values, one for each sample.
    whole = np.isfinite(np.sum([side.sum(axis=1) for side in sides], axis=0))
    calm = runs(whole & ~_struck(robot, wrenches, period) & ~held_for_a_while(robot, log))
    long = [run for run in calm if (run.stop - run.start) * period >= SHORTEST + 2 * EDGE]
    return long or [longest_run(whole)]


def _struck(robot: RobotModel, wrenches: Array, period: float) -> Mask:
    """Samples in which a sole slaps the floor: faster than the samples resolve, so that nothing follows from them."""
    weight, feet = robot.mass * GRAVITY, range(len(robot.feet))
    shocks = [shaken(wrenches[:, 6 * place : 6 * place + 3], weight, period) for place in feet]
    return np.asarray(np.any(shocks, axis=0))


def held_for_a_while(robot: RobotModel, log: MotionLog) -> Mask:
    """Samples in which the feet carry otherwise than as a rule: the ground's force is not all that acts on the robot.
    Of feet that stand always, whose loads have no zero, none."""
    if any(foot.contact == "always" for foot in robot.feet.values()):
        return np.zeros(len(log), dtype=bool)
    forces = [log.wrench(foot.wrench.name)[:, FORCE] for foot in robot.feet.values()]
    return hoisted(np.linalg.norm(forces, axis=2).sum(axis=0), robot.mass * GRAVITY, log.period)
