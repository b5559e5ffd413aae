"""An attitude behind a slow low-pass of its own: the gyroscope beside it shows the lag.

A low-pass of first order with the time constant τ believes θ' + τ θ'' = ω of small turns θ, ω the gyroscope's: the
gyroscope and the attitude's own rate differ by τ times the derivative of the latter. An attitude that follows its
accelerometer (`sensors/tilt_error.py`) leaves something else wherever a robot does more than sway alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array, cross
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.robot.model import Imu
from plantar.sensors.tilt_error import BAND, TiltError, disagreement, integrals
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.gyroscope_delay import USUAL
from plantar.signals.orientation import rates_from, unit_quaternions

ATTITUDE_LATE = "attitude_late"
# Share of the disagreement that a lag must explain: of filters of higher order, and of dead time, it does a third.
EXPLAINED = 0.25
# Times a tilt error's odds of explaining it: beside a real one twice at most, of lags four or more.
BETTER = 3.0


@dataclass(frozen=True)
class AttitudeLag:
    """What attitude and gyroscope disagree about, beside what a lag of 1 s would make: integrals that add up, as those
    of `TiltError`."""

    product: float = 0.0
    predicted: float = 0.0
    error: float = 0.0

    def __add__(self, other: AttitudeLag) -> AttitudeLag:
        return AttitudeLag(
            self.product + other.product, self.predicted + other.predicted, self.error + other.error
        )

    @property
    def lag(self) -> float:
        """The time constant τ [s]."""
        return self.product / self.predicted if self.predicted > 0 else 0.0

    @property
    def explained(self) -> float:
        """Share of the disagreement's square that it explains."""
        return self.lag * self.product / self.error if self.error > 0 else 0.0

    def believed(self, tilt: TiltError) -> bool:
        """Whether a lag explains the disagreement, far better than the accelerometer's `tilt` of the same logs."""
        own, other = self.explained, tilt.explained
        better = own * (1 - other) > BETTER * other * (1 - own)
        return self.lag > USUAL and own > EXPLAINED and better


NO_LAG = AttitudeLag()


def log_attitude_lag(log: MotionLog, imu: Imu) -> AttitudeLag:
    """The attitude's lag in one evenly sampled log; zeros where attitude, gyroscope or accelerometer is missing."""
    orientation = log.orientation(imu.name)
    if orientation is None or not log.has_imu(imu.name, "angular_velocity", "linear_acceleration"):
        return NO_LAG
    return attitude_lag_of(unit_quaternions(orientation), log.angular_velocity(imu.name), log.period)


def attitude_lag_of(orientation: Array, rates: Array, period: float) -> AttitudeLag:
    """From unit quaternions w x y z, IMU to world, (N, 4), and the gyroscope's rates (N, 3) [rad/s]."""
    up, error = disagreement(orientation, rates, period)
    change = differentiate(low_pass(rates_from(orientation, period), period, BAND), period)
    found = integrals(error, cross(change, up), period)
    return NO_LAG if found is None else AttitudeLag(*found[:3])


def without_lag(logs: Sequence[MotionLog], imu: Imu, found: AttitudeLag) -> list[MotionLog]:
    """Logs with the direction of gravity from gyroscope and accelerometer instead of an attitude that lags, and a note
    that says so; as they are where one of the sensors, or a sample of it, is missing."""
    # It costs start-up, and hardly any attitude lags.
    from plantar.signals.attitude import attitude_from_inertial

    text = (
        f"the IMU's orientation is behind its gyroscope as behind a low-pass of {1e3 * found.lag:.0f} ms: not used; "
        "gravity's direction blended from gyroscope and accelerometer (valid: an attitude filter that keeps up)"
    )
    orientation, read = imu_columns(imu.name, "orientation"), list[MotionLog]()
    for log in logs:
        if log.has_imu(imu.name, "angular_velocity", "linear_acceleration"):
            rates, acceleration = log.angular_velocity(imu.name), log.linear_acceleration(imu.name)
            if log.orientation(imu.name) is not None and np.isfinite(np.hstack([rates, acceleration])).all():
                attitude = attitude_from_inertial(rates, acceleration, log.period)
                note = Note(ATTITUDE_LATE, "warning", f"{log.name}: {text}")
                log = log.with_columns(dict(zip(orientation, attitude.T, strict=True)), note)
        read.append(log)
    return read
