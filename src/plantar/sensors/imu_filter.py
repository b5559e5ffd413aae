"""The filter of an IMU's own: it delays the gyroscope behind the orientation, alike in all logs of one device."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from plantar.estimation.weighted_mean import weighted_mean
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.signals.gyroscope_delay import GyroscopeDelay, of_a_filter
from plantar.signals.resampling import shifted

AGREE = 2.5  # times the deviations that single logs claim, by which logs of one device may scatter


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
        """Whether the logs agree on it, and it is told from none and no larger than a filter's."""
        return self.steady and of_a_filter(self.late, self.std)


def imu_filter(told: Iterable[GyroscopeDelay | None]) -> ImuFilter | None:
    """What logs tell of it together; None where none tells."""
    found = [one for one in told if one is not None]
    if not found:
        return None
    mean = weighted_mean([one.late for one in found], [one.std for one in found])
    return ImuFilter(mean.value, mean.std, mean.apart < AGREE)


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
