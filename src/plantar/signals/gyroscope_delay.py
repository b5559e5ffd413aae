"""By how much a gyroscope is behind the orientation of its own IMU: what both tell of the same turns."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plantar.conventions import SHOWN, Array
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import rates_from
from plantar.signals.resampling import shifted
from plantar.signals.segments import complete, longest_run

BAND = 8.0  # Hz, in which rates are compared
EDGE, LEAST_EDGES = 0.5, 10  # s that a filter's ends take; how many of them a run must hold
USUAL = 0.005  # s: an orientation's own filter; a later one is a fault, or follows the accelerometer
LEAST_SHARED = 0.02  # of the gyroscope's own squares: less shared by both sensors makes a step a leap
ROUNDS = 8  # of short steps, as long as one is larger than usual
LEAST = 0.0005  # s: less moves damping by less than its interval ever shows


class GyroscopeDelay(NamedTuple):
    """`late` [s] behind the orientation, its deviation `std`, and the share of the rates' difference it explains."""

    late: float
    std: float
    explained: float

    @property
    def shown(self) -> bool:
        """Whether it is a filter's."""
        return of_a_filter(self.late, self.std)


def of_a_filter(late: float, std: float) -> bool:
    """Whether a delay [s] is told from none, and a filter's: what follows the accelerometer makes a gyroscope early."""
    return abs(late) > max(SHOWN * std, LEAST) and late > -USUAL


def log_gyroscope_delay(log: MotionLog, imu: str) -> GyroscopeDelay | None:
    """What one evenly sampled log tells; None of one without orientation or gyroscope."""
    orientation = log.orientation(imu)
    if orientation is None or not log.has(*imu_columns(imu, "angular_velocity")):
        return None
    return gyroscope_delay(log.angular_velocity(imu), rates_from(orientation, log.period), log.period)


def gyroscope_delay(rates: Array, turning: Array, period: float) -> GyroscopeDelay | None:
    """From angular velocities (N, 3) [rad/s], evenly sampled: the gyroscope's, and the orientation's differentiated.

    Of the longest run without NaN; None where that is short, or still.
    """
    found = _one_step(rates, turning, period)
    if found is None:
        return None
    late, total = 0.0, found.total
    for _ in range(ROUNDS):
        if abs(found.short) < USUAL:
            break
        late += found.short
        found = _one_step(shifted(rates, period, late), turning, period)
        if found is None:
            return None
    return GyroscopeDelay(late + found.late, found.std, 1 - found.left / total)


class _Step(NamedTuple):
    """A delay to first order with its deviation [s], and squares of the rates' difference in `total` and `left`.

    `short`: a delay that is too short where turns are quick beside it, or noisy. The other is too long where they are
    quick, and right where they are slow.
    """

    late: float
    short: float
    std: float
    left: float
    total: float


def _one_step(rates: Array, turning: Array, period: float) -> _Step | None:
    edge = round(EDGE / period)
    run = longest_run(complete(rates, turning))
    if run.stop - run.start < LEAST_EDGES * edge:
        return None
    smooth, turned = (low_pass(each[run], period, BAND) for each in (rates, turning))
    change, turn = (differentiate(each, period)[edge:-edge] for each in (smooth, turned))
    apart = (smooth - turned)[edge:-edge]
    apart = apart - apart.mean(axis=0)
    # Of both, whose noises are apart: the gyroscope's alone would make slow turns look less late.
    both, noisy, total = float(np.sum(change * turn)), float(np.sum(change**2)), float(np.sum(apart**2))
    if noisy == 0 or total == 0:
        return None
    power = max(both, LEAST_SHARED * noisy)
    behind = -float(np.sum(apart * change))
    late = behind / power
    left = float(np.sum((apart + late * change) ** 2))
    return _Step(
        late,
        behind / noisy,
        float(np.sqrt(left * noisy / (6 * BAND * period * len(apart)))) / power,
        left,
        total,
    )
