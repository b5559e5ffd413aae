"""Delays step by step: read the sensors at their moments, ask Newton's law what is left, until nothing is.

One step follows the rates, which holds for some 50 ms. One delay common to all force sensors is the rule, with encoders
and IMU read together. What feet and encoders show of delays beside these is drawn to none by what is usual of a robot's
sensors; where they clearly have delays of their own, each gets its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from plantar.conventions import SHOWN, UNIFORM, Array, Mask
from plantar.cores import Each
from plantar.estimation.delays.delay import LONGEST, estimate_delay
from plantar.estimation.delays.sensor_delays import Balance, estimate_delays
from plantar.logs.freed_memory import return_freed
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.sensors.delays.clock_drift import SURE, ClockDrift, clock_drift
from plantar.sensors.delays.delays_by_log import DelaysByLog, delays_by_log
from plantar.sensors.newton_euler import NewtonEulerResidual, newton_euler_residuals
from plantar.signals.resampling import shifted

# Steps: each leaves a tenth of the one before; changing between common and own delays takes some more.
ROUNDS = 6
# The step from which on what one cannot tell stays untold: else they go back and forth between two answers.
WAVERING = 3
SETTLED = 0.001  # s: after a smaller step the next one would be below what any log shows
LEAST_DISTINCT = 0.0015  # s, and by so much
WELL_KNOWN = 0.003  # s: differences less well known than this are looked for elsewhere as well
LEAST_STD = 0.0003  # s: no robot's model shows a delay better, however fast its samples
APART = 0.001  # s: deviation by which sensors of one robot are read apart; a cycle of a bus of 1 kHz


@dataclass(frozen=True)
class RefinedDelays:
    """`values` (feet + 1,) [s]: the feet's and then the encoders' against the IMU, > 0: late; their common `std` [s].

    `feet_differ`, `encoders_differ`: whether they clearly have delays of their own.
    `closed` (logs,): in which logs Newton's law closes; `slowest`: the longest period among these [s].
    `suspect`: they seem to, and how much is not known well: steps from elsewhere may end elsewhere.
    `feet_unsure`, `encoders_unsure` [s]: deviations of what is known of each foot beside all, and of the encoders.
    `follows`: by how much the feet's common delay moves with the encoders', where these are found to be others.
    `told` (feet + 1,): of which of the feet's differences, and the encoders, these logs know more than what is usual.
    `unsteady`: that they are not the same throughout, where these logs show it.
    `residuals`: of these logs, read at these delays.
    """

    values: Array
    std: float
    freedom: float
    feet_differ: bool
    encoders_differ: bool
    closed: Mask
    slowest: float
    suspect: bool = False
    feet_unsure: float = 0.0
    encoders_unsure: float = 0.0
    follows: float = 0.0
    told: Mask = field(default_factory=lambda: np.zeros(0, dtype=bool))
    unsteady: ClockDrift | DelaysByLog | None = None
    residuals: tuple[NewtonEulerResidual, ...] = ()


def read_in_time(robot: RobotModel, log: MotionLog, delays: Array) -> MotionLog:
    """The log with each foot's wrench and the joints' columns as `delays` (feet + 1,) [s] later: undoes them."""
    moved: dict[str, Array] = {}
    prefixes = [f"wrench.{foot.wrench.name}." for foot in robot.feet.values()] + ["joint."]
    for prefix, delay in zip(prefixes, delays, strict=True):
        columns = [column for column in log.columns if column.startswith(prefix)]
        if delay and columns:
            own = shifted(log.stack(columns), log.period, float(delay))
            moved |= dict(zip(columns, own.T, strict=True))
    return log.with_columns(moved) if moved else log


def refined_delays(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    each: Each,
    start: Array,
    tried: Sequence[Sequence[NewtonEulerResidual]] | None = None,
) -> RefinedDelays | None:
    """Delays near `start` (feet + 1,) [s]; None where Newton's law closes in no log, or the steps do not settle.

    tried: `residuals_at` the start, where they are known.
    """
    at, told = start, np.ones(len(start), dtype=bool)
    for taken in range(ROUNDS):
        tried = tried or list(each(partial(residuals_at, robot, at), logs))
        return_freed(max((log.size for log in logs), default=0))
        step = _step(logs, tried, at, told)
        if step is None:
            return None
        told = told if taken < WAVERING - 1 else step.told
        moved, at, read_at = float(np.abs(step.values - at).max()), step.values, at
        if moved < SETTLED and step.std < np.inf:
            residuals = tuple(residual for own in tried for residual in own)
            pairs, common = [one.pair for one in residuals], float(np.mean(read_at[:-1]))
            unsteady = clock_drift(pairs) or delays_by_log(pairs, common)
            follows = _follows(residuals, step)
            residuals = tuple(replace(one, pair=one.pair.slim) for one in residuals)
            return replace(step, unsteady=unsteady, follows=follows, residuals=residuals)
        near = moved < SETTLED and all(one.stands for own in tried for one in own)
        tried = [[one.read_later(at - read_at) for one in own] for own in tried] if near else None
    return None


def residuals_at(robot: RobotModel, delays: Array, log: MotionLog) -> list[NewtonEulerResidual]:
    """Both sides of Newton's law along a log read at `delays`, filtered in all bands: here, one log apart from others,
    and not when delays are asked of all."""
    found = [one.with_bands() for one in newton_euler_residuals(robot, read_in_time(robot, log, delays))]
    for one in found:
        _ = one.balance.cells
    return found


def _step(
    logs: Sequence[MotionLog],
    tried: Sequence[Sequence[NewtonEulerResidual]],
    at: Array,
    told: Mask | None = None,
) -> RefinedDelays | None:
    """One step from the delays `at`, or, with an infinite deviation, to where no delays differ that need not.

    tried: the residuals of each log read at these delays; told: as of `RefinedDelays`, what may be; None: all.
    """
    residuals = [residual for own in tried for residual in own]
    if not residuals:
        return None
    closed = np.array([bool(own) for own in tried])
    slowest = max(log.period for log, own in zip(logs, tried, strict=True) if own)
    balances = [residual.balance for residual in residuals]
    told = np.ones(len(at), dtype=bool) if told is None else told
    contrasts, differ, suspect = _contrasts(len(at) - 1), np.zeros(len(at), dtype=bool), False
    usual, unsure = np.zeros(len(at)), np.full(len(at), APART)
    free = estimate_delays(balances)
    if free is not None:
        apart = contrasts @ (at + free.values)
        variance = np.diag(contrasts @ free.covariance @ contrasts.T)
        spread = np.sqrt(variance + LEAST_STD**2)
        size = np.abs(apart)
        seem = size > np.maximum(SURE * spread, LEAST_DISTINCT)
        suspect = bool((size > SHOWN * spread)[spread >= WELL_KNOWN].any())
        differ = np.append(np.full(len(at) - 1, seem[:-1].any()), seem[-1])
        # What is known no better than by what is usual moves nothing.
        told = np.asarray(told & (spread < APART))
        share = np.where(told, APART**2 / (APART**2 + spread**2), 0.0)
        # What no model shows better is in the deviation of all feet's delay already.
        own = np.sqrt(np.append(variance[:-1], spread[-1] ** 2))
        usual, unsure = share * apart, np.where(share > 0, np.sqrt(share) * own, APART)
    flags = (bool(differ[0]), bool(differ[-1]))
    held = contrasts[~differ]
    nearest = at - np.linalg.pinv(held) @ (held @ at - usual[~differ]) if len(held) else at
    left = _left(residuals, held if differ.any() else None, len(at))
    # What is left is told beside sensors that were read at moments of their own.
    if np.abs(nearest - at).max() > LEAST_STD:
        values = nearest if left is None else nearest + left[0]
        return RefinedDelays(values, np.inf, 1.0, *flags, closed, slowest, told=told)
    if left is None:
        return None
    by, std, freedom = left
    if free is not None and not differ.any():
        std = float(np.hypot(std, _by_choice(balances, contrasts, by[0], std)))
    unsure = np.where(differ, [*np.zeros(len(at) - 1), std], unsure)
    beside = float(unsure[:-1].max()), float(unsure[-1])
    return RefinedDelays(nearest + by, std, freedom, *flags, closed, slowest, suspect, *beside, told=told)


def _left(
    residuals: Sequence[NewtonEulerResidual], held: Array | None, count: int
) -> tuple[Array, float, float] | None:
    """What Newton's law leaves of `count` delays [s], its deviation [s] and that one's degrees of freedom; None where
    it tells none.

    held: combinations (c, count) of delays that stay as they are; None: one delay common to all feet is left.
    """
    if held is not None:
        balances = [residual.balance for residual in residuals]
        own = estimate_delays(balances, held)
        if own is None or np.abs(own.values).max() > LONGEST:
            return None
        variances = np.diag(own.covariance + own.through_time(balances))
        std = float(np.hypot(np.sqrt(variances.max()), LEAST_STD))
        return own.values, std, float(own.cells)
    common = estimate_delay([residual.pair for residual in residuals])
    if common is None:
        return None
    return np.append(np.full(count - 1, common.value), 0.0), common.std, common.freedom


def _by_choice(balances: Sequence[Balance], contrasts: Array, common: float, std: float) -> float:
    """Deviation of the feet's common delay [s] for what is chosen without being known: that encoders are read as tried,
    and that cells weigh as in the `common` delay, of deviation `std`, and not as where sensors are told apart.

    It is somewhere between what it is with the one and with the other, beyond what one more delay to be found, or other
    weights, move it by chance (J. A. Hausman, Econometrica 46, 1978).
    """
    together, apart = (estimate_delays(balances, held) for held in (contrasts, contrasts[:-1]))
    if together is None or apart is None:
        return 0.0
    moved = np.array([apart.values[0], common]) - together.values[0]
    chance = np.array([apart.covariance[0, 0], std**2]) - together.covariance[0, 0]
    return UNIFORM * float(np.sqrt(np.maximum(moved**2 - np.maximum(chance, 0.0), 0.0).sum()))


def _follows(residuals: Sequence[NewtonEulerResidual], found: RefinedDelays) -> float:
    """By how much the feet's delay moves with the encoders', as it is found here, near the delays `found`."""
    count, held = len(found.values), None
    contrasts = _contrasts(count - 1)
    if found.feet_differ or found.encoders_differ:
        held = contrasts[-1:] if found.feet_differ else contrasts
    later = [one.read_later(SETTLED * contrasts[-1]) for one in residuals]
    sides = [_left(own, held, count) for own in (residuals, later)]
    if sides[0] is None or sides[1] is None:
        return 0.0
    return float(np.mean((sides[1][0] - sides[0][0])[:-1])) / SETTLED


def _contrasts(feet: int) -> Array:
    """How far each foot is from the mean of all, and the encoders from the IMU, (feet + 1, feet + 1)."""
    contrasts = np.zeros((feet + 1, feet + 1))
    contrasts[:feet, :feet] = np.eye(feet) - 1 / feet
    contrasts[feet, feet] = 1.0
    return contrasts
