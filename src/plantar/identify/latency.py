"""How late the force sensors are: Newton's law ties the ground's wrench to IMU and encoders without K and C.

A spring-damper fit cannot see a delay: it takes C - K·delay for C. The whole body can: the wrench that eq. 1's base
rows predict from the URDF's inertias and the motion must equal the measured one, at the same moment.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import FORCE, Array
from plantar.dynamics import Contact, Equation, model_parameters
from plantar.dynamics.inertial_motion import inertial_motion
from plantar.estimation.delay import LEAST_CLOSED, Pair, estimate_delay, unexplained
from plantar.log import MotionLog
from plantar.notes import Note
from plantar.robot import RobotModel
from plantar.signals import differentiate, low_pass, runs

CUTOFF = 8.0  # Hz: above it differentiated encoders are noise
PRIOR_STD = (
    0.0075  # s: what is known of a wrench's delay before any data; drivers and filters are rarely later
)
KNOWN_STD = 0.001  # s: better known than this, the delay is corrected without a warning
CLOCK = 0.06  # of a period: within it, nobody knows when a sample was taken
SIGNIFICANT = 2.5  # deviations from zero: a poorly known delay is corrected beyond, else only allowed for
KEPT_RATE = 67.0  # Hz of the samples that are kept: the cutoff is far below
SLOW = 0.05  # Hz: below it the pair differs by postures and drifting zeros
BASE_ROWS = slice(0, 6)
WINDOW = 2.0  # s, in which the forces must follow from the prediction
SHORTEST = 8.0  # s that a log must offer without a push or a blow
EDGE = 0.3  # s at both ends of a run, where the filter is unsure


@dataclass(frozen=True)
class Latency:
    """Delay of the wrenches [s], > 0: late; `std` [s]; `measured` whether any log showed it."""

    delay: float
    std: float
    freedom: float
    measured: bool
    note: Note

    def to_dict(self) -> dict[str, object]:
        return {"wrench_delay": self.delay, "std": self.std, "measured": self.measured, "unit": "s"}


def known_latency(delay: float) -> Latency:
    """A delay that the user knows."""
    text = f"wrenches taken as {1e3 * delay:+.1f} ms late, as the user says"
    return Latency(delay, 0.0, np.inf, False, Note("delay_given", "info", text))


def wrench_latency(
    robot: RobotModel, logs: Sequence[MotionLog], each: Callable[..., Iterable[Pair | None]] = map
) -> Latency:
    """The delay common to all logs, evenly sampled, drawn towards zero by what is usual where the logs say little.

    `each` maps a function over logs: a pool's map uses all cores.
    """
    tried = list(each(lambda log: _pair(robot, log), logs))
    pairs = [pair for pair in tried if pair is not None]
    found = estimate_delay(pairs) if pairs else None
    if found is None:
        text = (
            "delay of the wrenches unknown: no log in which the ground's wrench follows from IMU, encoders and URDF; "
            f"taken as 0 ± {1e3 * PRIOR_STD:.1f} ms, which widens damping by stiffness times that. Record arm sweeps "
            "of 0.3 to 1 Hz without an operator"
        )
        return Latency(0.0, PRIOR_STD, np.inf, False, Note("delay_unknown", "warning", text))
    gain = PRIOR_STD**2 / (PRIOR_STD**2 + found.std**2)
    slowest = max(log.period for log, pair in zip(logs, tried, strict=True) if pair is not None)
    delay, std = gain * found.value, float(np.hypot(np.sqrt(gain) * found.std, CLOCK * slowest))
    told = f"wrenches are {1e3 * delay:+.1f} ± {1e3 * 1.96 * std:.1f} ms late (95 %) against IMU and encoders"
    if std <= KNOWN_STD:
        return Latency(delay, std, found.freedom, True, Note("delay", "info", f"{told}: corrected"))
    advice = "known poorly, which widens damping: record arm sweeps of 0.3 to 1 Hz without an operator"
    if abs(delay) > SIGNIFICANT * std:
        note = Note("delay_poorly_known", "warning", f"{told}: corrected; {advice}")
        return Latency(delay, std, found.freedom, True, note)
    note = Note("delay_poorly_known", "warning", f"{told}: not corrected; {advice}")
    return Latency(0.0, float(np.hypot(delay, std)), found.freedom, True, note)


def _pair(robot: RobotModel, log: MotionLog) -> Pair | None:
    """Measured and predicted ground wrench in the root link's frame; None where the log lacks what it takes."""
    imu = robot.imu
    kinds = ("linear_acceleration", "angular_velocity")
    needed = [f"imu.{imu.name}.{kind}.{axis}" for kind in kinds for axis in "xyz"] if imu else []
    if imu is None or not log.has(*needed) or any(foot.contact == "always" for foot in robot.feet.values()):
        return None
    motion = inertial_motion(robot, log, CUTOFF)
    wrenches = np.hstack([foot.wrench.sign * log.wrench(foot.wrench.name) for foot in robot.feet.values()])
    whole = motion.finite & np.isfinite(wrenches).all(axis=1)
    longest = max(runs(whole), key=lambda run: run.stop - run.start, default=slice(0, 0))
    edge = round(EDGE / log.period)
    if longest.stop - longest.start < 4 * edge + 400:
        return None
    equation = Equation(robot.floating_model)
    contacts = [Contact(*robot.frame(foot.wrench.placement)) for foot in robot.feet.values()]
    part = motion.select(longest)
    predicted = equation.inverse_dynamics(part, model_parameters(robot.floating_model))[BASE_ROWS].T

    def carried(readings: Array) -> Array:
        split = [np.ascontiguousarray(readings[:, 6 * i : 6 * i + 6]) for i in range(len(contacts))]
        return -equation.inverse_dynamics(part, None, contacts, split)[BASE_ROWS].T

    readings = low_pass(wrenches[longest], log.period, CUTOFF)
    stride = max(1, round(1 / (KEPT_RATE * log.period)))
    inner, period = slice(edge, len(part) - edge, stride), stride * log.period
    rows = np.hstack([carried(readings), carried(differentiate(readings, log.period)), predicted])[inner]
    measured, rate, predicted = np.hsplit(rows - low_pass(rows, period, SLOW), 3)
    calm = _longest_closed(measured[:, FORCE], rate[:, FORCE], predicted[:, FORCE], period)
    if (calm.stop - calm.start) * period < SHORTEST:
        return None
    return Pair(log.name, measured[calm], rate[calm], predicted[calm], period)


def _longest_closed(measured: Array, rate: Array, predicted: Array, period: float) -> slice:
    """The longest stretch in which nobody pushes and nothing strikes: there the forces follow from the prediction."""
    width = round(WINDOW / period)
    count = len(measured) // width
    usual = float(np.mean(np.sum(measured**2, axis=1)))
    closed = np.zeros(len(measured), dtype=bool)
    for window in (slice(i * width, (i + 1) * width) for i in range(count)):
        power = float(np.mean(np.sum(measured[window] ** 2, axis=1)))
        missing = unexplained(measured[window], rate[window], predicted[window]) / width
        closed[window] = missing < (1 - LEAST_CLOSED) * max(power, usual)
    return max(runs(closed), key=lambda run: run.stop - run.start, default=slice(0, 0))
