"""A log read at every lag of a grid: what the coarse search for delays compares."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from plantar.conventions import FORCE, GRAVITY, Array
from plantar.dynamics import Contact, model_parameters
from plantar.dynamics.equation import equation_of
from plantar.dynamics.inertial_motion import inertial_motion, inertial_signals
from plantar.estimation.delays.lag_search import WINDOW, LagGrid
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.sensors.delays.refined_delays import read_in_time
from plantar.sensors.newton_euler import held_for_a_while, with_gyroscope
from plantar.sensors.newton_sides import SLOW, STOOD
from plantar.signals.filters import low_pass
from plantar.signals.resampling import shifted, with_continuous_quaternions
from plantar.signals.segments import longest_run
from plantar.signals.thinning import slow_columns

SEARCHED = 0.25  # s: later sensors are no sensors of the same motion
STEP = 0.05  # s: half of it is a small phase of what is fastest below, and within reach of a refinement
CUTOFF = 2.0  # Hz: robots move below it, and half a STEP is a small part of its period
# Of the robot's weight: a force that changes by less shows its sensor's noise, and no lag.
LEAST_MOVED = 0.003
LONGEST = 200.0  # s of a log that are searched: a grid of lags holds each sample a hundred times
KEPT_RATE = 1 / STEP  # Hz: a sample for each step


def lagged_log(robot: RobotModel, log: MotionLog) -> LagGrid | None:
    """The log at every lag up to SEARCHED to both sides; None where it lacks what that takes, is short or still."""
    complete = with_gyroscope(robot, log)
    if complete is None:
        return None
    thin = _thinned(complete)
    readings = np.stack([foot.wrench.sign * thin.wrench(foot.wrench.name) for foot in robot.feet.values()])
    count = round(SEARCHED / STEP)
    lags: Array = STEP * np.arange(-count, count + 1, dtype=np.float64)  # the same ones in logs of any rate
    reach = int(np.ceil(SEARCHED / thin.period)) + 1
    signals = inertial_signals(robot, thin, CUTOFF)
    known = np.isfinite(np.hstack([*readings, signals.rate, signals.proper])).all(axis=1)
    known &= ~held_for_a_while(robot, thin)
    joints = np.pad(np.isfinite(signals.positions).all(axis=1), reach)  # nothing is known beyond the ends
    longest = longest_run(known & sliding_window_view(joints, 2 * reach + 1).all(axis=1))
    inner = slice(longest.start + reach, longest.stop - reach)
    if (inner.stop - inner.start) * thin.period < 2 * WINDOW:
        return None
    inner = _liveliest(readings[..., FORCE].sum(axis=0), inner, round(LONGEST / thin.period))
    equation, parameters = equation_of(robot.floating_model), model_parameters(robot.floating_model)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]
    late = np.stack([[shifted(foot, thin.period, by, inner) for by in lags.tolist()] for foot in readings])
    predicted, measured = np.empty((len(lags), *late.shape[2:])), np.empty((len(lags), *late.shape))
    slow = SLOW if signals.by_encoders is None else STOOD[0]
    # One motion after the other: all of them at once would be the largest array of any log.
    for place, by in enumerate(lags.tolist()):
        # Loads say which soles stand: read with the encoders, as where it is the IMU that is late.
        later = read_in_time(robot, thin, np.full(len(robot.feet) + 1, by))
        motion = inertial_motion(robot, equation, inertial_signals(robot, later, CUTOFF), inner)
        transfer = [equation.base_transfer(motion.positions, one) for one in contacts]
        carried = np.stack([(one @ own[..., None])[..., 0] for one, own in zip(transfer, late, strict=True)])
        measured[place] = _moving(carried, thin.period, slow)
        predicted[place] = _moving(equation.base_wrenches(motion, parameters[None])[0], thin.period, slow)
    together = measured[len(lags) // 2][:, len(lags) // 2, :, FORCE].sum(axis=0)
    if np.sum(np.var(together, axis=0)) < (LEAST_MOVED * GRAVITY * robot.mass) ** 2:
        return None
    return LagGrid(predicted, measured, lags, lags, thin.period)


def _liveliest(force: Array, inner: slice, most: int) -> slice:
    """Of the samples `inner` the `most` consecutive ones in which the force (N, 3) changes most."""
    if inner.stop - inner.start <= most:
        return inner
    changes = np.sum(np.diff(force[inner], axis=0, prepend=force[inner][:1]) ** 2, axis=1)
    until = np.append(0.0, np.cumsum(changes))
    first = inner.start + int(np.argmax(until[most:] - until[:-most]))
    return slice(first, first + most)


def _thinned(log: MotionLog) -> MotionLog:
    """The columns of IMU, joints' positions and wrenches, slow parts only and few samples of them."""
    wanted = ("imu.", "wrench.", "joint.")
    read = {
        name: values for name, values in with_continuous_quaternions(log).items() if name.startswith(wanted)
    }
    stride = max(1, round(1 / (KEPT_RATE * log.period)))
    slow = slow_columns(read, log.period, CUTOFF, stride)
    return MotionLog(log.name, log.time[::stride], slow, log.path)


def _moving(sides: Array, period: float, slow: float) -> Array:
    """Sides (..., n, 6) without what is slower than `slow` [Hz], as of `moving`."""
    rows = np.moveaxis(sides, -2, 0)
    return np.moveaxis(rows - low_pass(rows.reshape(len(rows), -1), period, slow).reshape(rows.shape), 0, -2)
