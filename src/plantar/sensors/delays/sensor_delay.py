"""How late the force sensors are, and the encoders: Newton's law ties them to the IMU without K and C.

A spring-damper fit cannot see a delay: it takes C - K·delay for C. The whole body can: the wrench that eq. 1's base
rows predict from the URDF's inertias and the motion must equal the measured one, at the same moment. One delay common
to all force sensors is the rule, with encoders and IMU read together; where feet or encoders clearly have delays of
their own, each gets its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from plantar.conventions import NORMAL95, Array, Mask
from plantar.cores import Each
from plantar.estimation.delays.delay import LEAST_CLOSED
from plantar.estimation.delays.lag_search import Lags, search_lags
from plantar.logs.freed_memory import return_freed
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.delays.lagged_log import SEARCHED, STEP, lagged_log
from plantar.sensors.delays.refined_delays import (
    APART,
    LEAST_STD,
    WELL_KNOWN,
    RefinedDelays,
    read_in_time,
    refined_delays,
)
from plantar.sensors.newton_euler import NewtonEulerResidual, held_for_a_while

KNOWN_STD = 0.001  # s: better known than this, the delay is corrected without a warning
CLOCK = 0.06  # of a period: within it, nobody knows when a sample was taken
ELSEWHERE = 0.1 * STEP  # s: from lags that are farther from where steps have led, others are tried
SIGNIFICANT = 2.5  # deviations from zero: a poorly known delay is corrected beyond, else only allowed for
# s: deviation of a delay that only standing soles tell: on a floor that gives they move a little, an IMU over them by
# 1 or 2 % more or less than they say, and its motion comes a millisecond earlier or later in one log or another.
SOLES_GIVE = 0.0005
# Predicted over measured squares of the torques, or the reverse; a delay of a second halves them.
PUSHED = 3.0
BEYOND_SEARCH = "delay_beyond_search"
UNKNOWN = "delay_unknown"


@dataclass(frozen=True)
class SensorDelay:
    """Delay of the wrenches against the IMU [s], > 0: late; `std` [s]; `measured` whether any log showed it.

    `feet` has each foot's own delay where they differ, `encoders` that of the joints' positions, `encoders_std` how
    unsure that is [s], `follows` by how much the wrenches' delay moves with it. `doubtful`: a search over SEARCHED
    found no delays at which Newton's law closes where it should, so that the sensors may be late by anything that `std`
    says. `residuals`: of the logs in which it does close.
    """

    delay: float
    std: float
    freedom: float
    measured: bool
    note: Note
    feet: Mapping[str, float] = field(default_factory=dict)
    encoders: float = 0.0
    encoders_std: float = 0.0
    follows: float = 0.0
    doubtful: bool = False
    residuals: tuple[NewtonEulerResidual, ...] = ()

    def by_foot(self, robot: RobotModel) -> Array:
        """The delay of each foot's wrench [s]."""
        return np.array([self.feet.get(name, self.delay) for name in robot.feet])


def in_time(robot: RobotModel, log: MotionLog, sensor_delay: SensorDelay) -> MotionLog:
    """The log with wrenches and joint positions as they were at the moments of the IMU's samples."""
    return read_in_time(robot, log, np.array([*sensor_delay.by_foot(robot), sensor_delay.encoders]))


def beside_encoders(robot: RobotModel, log: MotionLog, sensor_delay: SensorDelay) -> MotionLog:
    """The log with wrenches as they were at the moments of the joint positions' samples."""
    return read_in_time(robot, log, np.array([*sensor_delay.by_foot(robot) - sensor_delay.encoders, 0.0]))


def on_force_cells(robot: RobotModel, logs: Iterable[MotionLog]) -> bool:
    """Whether a foot of some log stands on vertical force cells: without horizontal forces no log shows a delay."""
    return any(log.vertical_only(foot.wrench.name) for log in logs for foot in robot.feet.values())


def known_delay(delay: float) -> SensorDelay:
    """A delay that the user knows."""
    text = f"wrenches taken as {1e3 * delay:+.1f} ms late, as given in the settings"
    return SensorDelay(delay, 0.0, np.inf, False, Note("delay_given", "info", text))


def estimate_wrench_delay(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    each: Each = map,
    as_recorded: Sequence[Sequence[NewtonEulerResidual] | None] = (),
) -> SensorDelay:
    """The delay common to all logs, evenly sampled, drawn towards zero by what is usual where the logs say little;
    where sensors clearly differ, the delay of each.

    `each` maps a function over logs: a pool's map uses all cores. as_recorded: `residuals_at` no delay, if known.
    """
    if on_force_cells(robot, logs):
        return _unseen(robot, logs)
    still = np.zeros(len(robot.feet) + 1)
    known = [own for own in as_recorded if own is not None]
    found = refined_delays(robot, logs, each, still, known if len(known) == len(logs) else None)
    if found is not None and found.std <= KNOWN_STD and not found.suspect:
        return _told(robot, found)
    return_freed()
    grids = list(each(partial(lagged_log, robot), logs))
    shown = [grid for grid in grids if grid is not None]
    if not shown:
        return _unseen(robot, logs) if found is None else _told(robot, found)
    lags = search_lags(shown)
    if np.abs(lags.values - (0.0 if found is None else found.values)).max() > ELSEWHERE:
        again = refined_delays(robot, logs, each, lags.values)
        if again is not None and (found is None or _surer(again, found)):
            found = again
    searched = np.array([grid is not None for grid in grids])
    alone = np.array([_accelerated(robot, log) and not held_for_a_while(robot, log).any() for log in logs])
    if _in_doubt(lags, found, searched, alone):
        return _doubtful(robot, lags)
    return _unseen(robot, logs) if found is None else _told(robot, found)


def _surer(one: RefinedDelays, other: RefinedDelays) -> bool:
    """Whether nothing is suspect about the one alone, or Newton's law closes in more logs, or it alone shows sensors to
    differ, or it is better known: a common delay of sensors that differ looks well known, and is neither's."""
    better, worse = (
        (
            not each.suspect,
            int(each.closed.sum()),
            each.feet_differ or each.encoders_differ,
            -each.std,
        )
        for each in (one, other)
    )
    return better > worse


def _accelerated(robot: RobotModel, log: MotionLog) -> bool:
    return robot.imu is not None and log.has_imu(robot.imu.name, "linear_acceleration")


def _in_doubt(lags: Lags, found: RefinedDelays | None, searched: Mask, alone: Mask) -> bool:
    """Whether Newton's law, in logs that move, closes at no lag, or at lags that are not those found.

    Where somebody pushes it cannot close, and torques are far larger or smaller than predicted: that says nothing of
    the sensors' moments. Nor do logs that do not close beside others that show the delay well: a hand that steadies a
    robot takes less than a push. Nor does a log without an accelerometer, what its soles say may be wrong as well, or
    one in which the robot was held for a while: only others tell of it `alone`.
    """
    missed = lags.missed > 1 - LEAST_CLOSED
    pushed = np.maximum(lags.power, 1 / np.maximum(lags.power, 1e-9)) > PUSHED
    unclosed = missed & ~pushed & alone[searched]
    if unclosed.any():
        closed = found is not None and found.closed[searched][unclosed].all()
        return not closed and (found is None or found.std > WELL_KNOWN)
    if missed.all():
        return False
    reached = np.zeros_like(lags.values) if found is None else found.values
    return bool(np.abs(lags.values - reached).max() > np.maximum(2 * STEP, 2 * lags.std).max())


def _doubtful(robot: RobotModel, lags: Lags) -> SensorDelay:
    """Nothing corrected, and everything allowed for that the search leaves."""
    whole = 2 * SEARCHED / np.sqrt(12)
    left = whole if lags.at_edge else min(whole, float(np.hypot(lags.std, lags.values).max()))
    std = float(np.hypot(robot.uncertainty.wrench_delay, left))
    text = (
        f"sensors may be late by {1e3 * NORMAL95 * std:.0f} ms: no delays up to {1e3 * SEARCHED:.0f} ms were found "
        "with which the ground's wrench follows from IMU, encoders and URDF, though the robot moves; not corrected. "
        "Check first that the IMU sits on the link that the robot file says, and how it is turned there; then the "
        "clocks of IMU, encoders and force sensors, and the URDF, or record arm sweeps of 0.3 to 1 Hz that nobody "
        "disturbs; "
        "--wrench-delay gives a delay that is known"
    )
    note = Note(BEYOND_SEARCH, "warning", text)
    return SensorDelay(0.0, std, np.inf, False, note, encoders_std=APART, doubtful=True)


def _unseen(robot: RobotModel, logs: Sequence[MotionLog]) -> SensorDelay:
    """What the robot file says of a delay that no log shows."""
    imu, prior = robot.imu, robot.uncertainty.wrench_delay
    blind = imu is not None and not any(_accelerated(robot, log) for log in logs)
    why = "no log in which the ground's wrench follows from IMU, encoders and URDF"
    todo = "Record the accelerometer" if blind else "Record arm sweeps of 0.3 to 1 Hz without an operator"
    if on_force_cells(robot, logs):
        why = "vertical force cells read no horizontal force, by which it would show"
        todo = "Measure how late they are and give it with --wrench-delay"
    text = (
        f"delay of the wrenches unknown: {why}; taken as 0 ± {1e3 * prior:.1f} ms, which widens the interval of the "
        f"damping by stiffness times that. {todo}"
    )
    note = Note(UNKNOWN, "warning", text) if prior > KNOWN_STD else Note("delay_assumed", "info", text)
    return SensorDelay(0.0, prior, np.inf, False, note, encoders_std=APART)


def _told(robot: RobotModel, found: RefinedDelays) -> SensorDelay:
    """Delays that the logs show, with what is said of them and what these logs leave."""
    told_by = found.residuals
    if told_by and not any(one.accelerated for one in told_by):
        found = replace(found, std=float(np.hypot(found.std, SOLES_GIVE)))
    return replace(_delays(robot, found), residuals=told_by)


def _delays(robot: RobotModel, found: RefinedDelays) -> SensorDelay:
    """The same without these logs."""
    feet, encoders = found.values[:-1], float(found.values[-1])
    value, beside = float(np.mean(feet)), found.encoders_unsure
    if found.unsteady is not None:
        std, note = float(np.hypot(found.std, found.unsteady.std)), found.unsteady.note
        return SensorDelay(value, std, found.freedom, True, note, encoders_std=beside, doubtful=True)
    if found.feet_differ or found.encoders_differ:
        return _apart(list(robot.feet), found)
    prior = robot.uncertainty.wrench_delay
    # A delay far beyond what is usual shows that this robot is not usual: nothing draws it to zero.
    usual = abs(value) < SIGNIFICANT * float(np.hypot(prior, found.std))
    gain = prior**2 / (prior**2 + found.std**2) if usual else 1.0
    clock = max(CLOCK * found.slowest, LEAST_STD)
    delay, common = gain * value, float(np.hypot(np.sqrt(gain) * found.std, clock))
    std = float(np.hypot(common, found.feet_unsure))
    told = f"wrenches are {1e3 * delay:+.1f} ± {1e3 * NORMAL95 * std:.1f} ms late (95 %) against IMU and encoders"
    advice = "uncertain, which widens the interval of the damping: record arm sweeps of 0.3 to 1 Hz without an operator"
    if common > KNOWN_STD and abs(delay) <= SIGNIFICANT * common:
        note = Note("delay_poorly_known", "warning", f"{told}: not corrected; {advice}")
        std, beside = float(np.hypot(delay, std)), float(np.hypot(encoders, beside))
        return SensorDelay(0.0, std, found.freedom, True, note, encoders_std=beside)
    note = Note("delay", "info", f"{told}: corrected")
    if common > KNOWN_STD:
        note = Note("delay_poorly_known", "warning", f"{told}: corrected; {advice}")
    each = _each_foot(robot.feet, feet - value + delay)
    return SensorDelay(delay, std, found.freedom, True, note, each, encoders, beside, found.follows)


def _each_foot(names: Iterable[str], delays: Array) -> dict[str, float]:
    """The delay of each foot where they are not all the same."""
    return dict(zip(names, delays.tolist(), strict=True)) if np.ptp(delays) > 0 else {}


def _apart(names: Sequence[str], found: RefinedDelays) -> SensorDelay:
    """Each foot's delay and the encoders', where some clearly differ."""
    mean, encoders = float(np.mean(found.values[:-1])), float(found.values[-1])
    delays, std = _each_foot(names, found.values[:-1]), float(np.hypot(found.std, found.feet_unsure))
    each = ", ".join(f"{name} {1e3 * delay:+.1f}" for name, delay in delays.items()) or f"{1e3 * mean:+.1f}"
    text = (
        f"sensors have different delays relative to the IMU: wrenches {each} ms, encoders {1e3 * encoders:+.1f} ms "
        f"(± {1e3 * NORMAL95 * found.std:.1f} ms, 95 %): corrected"
    )
    note = Note("delays_apart", "warning", text)
    beside = found.encoders_unsure, found.follows
    return SensorDelay(mean, std, found.freedom, True, note, delays, encoders, *beside)
