"""By how much a gyroscope is behind the orientation of its own IMU: what both tell of the same turns."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import rates_from
from plantar.signals.resampling import shifted
from plantar.signals.segments import longest_run

BAND = 8.0  # Hz, in which rates are compared
EDGE, LEAST_EDGES = 0.5, 10  # s that a filter's ends take; how many of them a run must hold
USUAL = 0.005  # s: a device's own filter; a later one is a fault, or an orientation that follows the accelerometer
LEAST = 0.0005  # s: less moves damping by less than its interval ever shows
SURE = 3.0  # deviations


def with_gyroscope_on_time(log: MotionLog, imu: str) -> MotionLog:
    """An evenly sampled log with its gyroscope read at the moments that the orientation tells of, and a note of it.

    A device's own filter delays a gyroscope by milliseconds; damping, and the delay of the force sensors beside it,
    would follow. As it is where the delay is small, not told from none, or larger than such a filter's. No filter makes
    a gyroscope early: ahead of an orientation that follows its accelerometer, it is the orientation that is wrong, and
    the accelerometer tells by how much (`sensors/tilt_error.py`).
    """
    orientation, columns = log.orientation(imu), imu_columns(imu, "angular_velocity")
    if orientation is None or not log.has(*columns):
        return log
    rates = log.angular_velocity(imu)
    found = gyroscope_delay(rates, rates_from(orientation, log.period), log.period)
    if found is None or not max(SURE * found.std, LEAST) < abs(found.late) < USUAL:
        return log
    if found.late < 0 and log.has_imu(imu, "linear_acceleration"):
        return log
    late, ahead = ("behind", "earlier") if found.late > 0 else ("ahead of", "later")
    text = f"{log.name}: gyroscope {1e3 * abs(found.late):.1f} ms {late} the orientation, read {ahead} by as much"
    on_time = shifted(rates, log.period, found.late)
    return log.with_columns(dict(zip(columns, on_time.T, strict=True)), Note("gyroscope_delay", "info", text))


class GyroscopeDelay(NamedTuple):
    """`late` [s] behind the orientation, its deviation `std`, and the share of the rates' difference it explains."""

    late: float
    std: float
    explained: float


def gyroscope_delay(rates: Array, turning: Array, period: float) -> GyroscopeDelay | None:
    """From angular velocities (N, 3) [rad/s], evenly sampled: the gyroscope's, and the orientation's differentiated.

    Of the longest run without NaN; None where that is short, or still.
    """
    edge = round(EDGE / period)
    run = longest_run(np.asarray(np.isfinite(np.column_stack([rates, turning])).all(axis=1)))
    if run.stop - run.start < LEAST_EDGES * edge:
        return None
    apart = low_pass(rates[run] - turning[run], period, BAND)[edge:-edge]
    change = differentiate(low_pass(rates[run], period, BAND), period)[edge:-edge]
    apart = apart - apart.mean(axis=0)
    power, total = float(np.sum(change**2)), float(np.sum(apart**2))
    if power == 0 or total == 0:
        return None
    late = -float(np.sum(apart * change)) / power
    left = float(np.sum((apart + late * change) ** 2))
    return GyroscopeDelay(
        late, float(np.sqrt(left / power / (6 * BAND * period * len(apart)))), 1 - left / total
    )
