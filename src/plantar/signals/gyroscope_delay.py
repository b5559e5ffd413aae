"""By how much a gyroscope is behind the orientation of its own IMU: what both tell of the same turns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
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
AGREE = 2.5  # times the deviations that single logs claim, by which logs of one device may scatter


class GyroscopeDelay(NamedTuple):
    """`late` [s] behind the orientation, its deviation `std`, and the share of the rates' difference it explains."""

    late: float
    std: float
    explained: float

    @property
    def shown(self) -> bool:
        """Whether it is told from none, and no larger than a device's own filter."""
        return max(SURE * self.std, LEAST) < abs(self.late) < USUAL


class ImuFilter(NamedTuple):
    """By how much a device's own filter delays its gyroscope behind its orientation: `late` [s] and its `std`, from
    all logs of it. `steady`: whether the logs agree.

    They do not where the orientation follows the accelerometer: then gyroscope and orientation are apart by what the
    robot does, now one way and now the other, and neither is late.
    """

    late: float
    std: float
    steady: bool

    @property
    def shown(self) -> bool:
        """Whether it is told from none, and no larger than a device's own filter."""
        return self.steady and max(SURE * self.std, LEAST) < abs(self.late) < USUAL


def imu_filter(told: Iterable[GyroscopeDelay | None]) -> ImuFilter | None:
    """What logs tell of it together; None where none tells."""
    found = [one for one in told if one is not None]
    if not found:
        return None
    late, weights = np.array([one.late for one in found]), np.array([one.std**-2 for one in found])
    mean = float(weights @ late / weights.sum())
    apart = float(weights @ (late - mean) ** 2) / max(len(found) - 1, 1)
    return ImuFilter(mean, float(np.sqrt(max(apart, 1.0) / weights.sum())), apart < AGREE**2)


def with_gyroscopes_on_time(logs: Sequence[MotionLog], imu: str, found: ImuFilter | None) -> list[MotionLog]:
    """Logs with their gyroscope read at the moments that the orientation tells of, and a note of it.

    A device's own filter delays a gyroscope by milliseconds; damping, and the delay of the force sensors beside it,
    would follow. As they are where it is not `shown`. No filter makes a gyroscope early: ahead of an orientation that
    follows its accelerometer, it is the orientation that is wrong, and the accelerometer tells by how much
    (`sensors/tilt_error.py`).
    """
    if found is None or not found.shown:
        return [*logs]
    late, ahead = ("behind", "earlier") if found.late > 0 else ("ahead of", "later")
    how = f"gyroscope {1e3 * abs(found.late):.1f} ms {late} the orientation, read {ahead} by as much"
    columns, read = imu_columns(imu, "angular_velocity"), list[MotionLog]()
    for log in logs:
        right = found.late < 0 and log.has_imu(imu, "linear_acceleration")
        if log.orientation(imu) is not None and log.has(*columns) and not right:
            on_time = shifted(log.angular_velocity(imu), log.period, found.late)
            note = Note("gyroscope_delay", "info", f"{log.name}: {how}")
            log = log.with_columns(dict(zip(columns, on_time.T, strict=True)), note)
        read.append(log)
    return read


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
