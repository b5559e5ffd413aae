"""How late the force sensors are, and the encoders: Newton's law ties them to the IMU without K and C.

A spring-damper fit cannot see a delay: it takes C - K·delay for C. The whole body can: the wrench that eq. 1's base
rows predict from the URDF's inertias and the motion must equal the measured one, at the same moment. One delay common
to all force sensors is the rule, with encoders and IMU read together; where feet or encoders clearly have delays of
their own, each gets its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from plantar.conventions import Array
from plantar.estimation.delay import LONGEST, estimate_delay
from plantar.estimation.sensor_delays import Balance, estimate_delays
from plantar.feet.sensors.newton_euler import NewtonEulerResidual, newton_euler_residual
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.signals.resampling import shifted

PRIOR_STD = (
    0.0075  # s: what is known of a wrench's delay before any data; drivers and filters are rarely later
)
KNOWN_STD = 0.001  # s: better known than this, the delay is corrected without a warning
CLOCK = 0.06  # of a period: within it, nobody knows when a sample was taken
SIGNIFICANT = 2.5  # deviations from zero: a poorly known delay is corrected beyond, else only allowed for
DISTINCT = 4.0  # deviations by which sensors must differ to have delays of their own
LEAST_DISTINCT = 0.0015  # s, and by so much
LEAST_STD = 0.0003  # s: no robot's model shows a delay better, however fast its samples


@dataclass(frozen=True)
class SensorDelay:
    """Delay of the wrenches against the IMU [s], > 0: late; `std` [s]; `measured` whether any log showed it.

    `feet` has each foot's own delay where they differ, `encoders` that of the joints' positions; both are usually
    empty and zero.
    """

    delay: float
    std: float
    freedom: float
    measured: bool
    note: Note
    feet: Mapping[str, float] = field(default_factory=dict)
    encoders: float = 0.0


def in_time(robot: RobotModel, log: MotionLog, sensor_delay: SensorDelay) -> MotionLog:
    """The log with wrenches and joint positions as they were at the moments of the IMU's samples."""
    moved: dict[str, Array] = {}
    for name, foot in robot.feet.items():
        columns = [column for column in log.columns if column.startswith(f"wrench.{foot.wrench.name}.")]
        late = sensor_delay.feet.get(name, sensor_delay.delay)
        moved |= dict(zip(columns, shifted(log.stack(columns), log.period, late).T, strict=True))
    if sensor_delay.encoders:
        columns = [column for column in log.columns if column.startswith("joint.")]
        moved |= dict(
            zip(columns, shifted(log.stack(columns), log.period, sensor_delay.encoders).T, strict=True)
        )
    return log.with_columns(moved)


def known_delay(delay: float) -> SensorDelay:
    """A delay that the user knows."""
    text = f"wrenches taken as {1e3 * delay:+.1f} ms late, as given in the settings"
    return SensorDelay(delay, 0.0, np.inf, False, Note("delay_given", "info", text))


def estimate_wrench_delay(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    each: Callable[..., Iterable[NewtonEulerResidual | None]] = map,
) -> SensorDelay:
    """The delay common to all logs, evenly sampled, drawn towards zero by what is usual where the logs say little;
    where sensors clearly differ, the delay of each.

    `each` maps a function over logs: a pool's map uses all cores.
    """
    tried = list(each(lambda log: newton_euler_residual(robot, log), logs))
    residuals = [residual for residual in tried if residual is not None]
    apart = _apart(list(robot.feet), [residual.balance for residual in residuals])
    if apart is not None:
        return apart
    found = estimate_delay([residual.pair for residual in residuals]) if residuals else None
    if found is None:
        imu = robot.imu
        blind = imu is not None and not any(log.has_imu(imu.name, "linear_acceleration") for log in logs)
        text = (
            "delay of the wrenches unknown: no log in which the ground's wrench follows from IMU, encoders and URDF; "
            f"taken as 0 ± {1e3 * PRIOR_STD:.1f} ms, which widens the interval of the damping by stiffness times that. "
            f"{'Record the accelerometer' if blind else 'Record arm sweeps of 0.3 to 1 Hz without an operator'}"
        )
        return SensorDelay(0.0, PRIOR_STD, np.inf, False, Note("delay_unknown", "warning", text))
    gain = PRIOR_STD**2 / (PRIOR_STD**2 + found.std**2)
    slowest = max(log.period for log, residual in zip(logs, tried, strict=True) if residual is not None)
    clock = max(CLOCK * slowest, LEAST_STD)
    delay, std = gain * found.value, float(np.hypot(np.sqrt(gain) * found.std, clock))
    told = f"wrenches are {1e3 * delay:+.1f} ± {1e3 * 1.96 * std:.1f} ms late (95 %) against IMU and encoders"
    if std <= KNOWN_STD:
        return SensorDelay(delay, std, found.freedom, True, Note("delay", "info", f"{told}: corrected"))
    advice = "uncertain, which widens the interval of the damping: record arm sweeps of 0.3 to 1 Hz without an operator"
    if abs(delay) > SIGNIFICANT * std:
        note = Note("delay_poorly_known", "warning", f"{told}: corrected; {advice}")
        return SensorDelay(delay, std, found.freedom, True, note)
    note = Note("delay_poorly_known", "warning", f"{told}: not corrected; {advice}")
    return SensorDelay(0.0, float(np.hypot(delay, std)), found.freedom, True, note)


def _apart(names: Sequence[str], balances: Sequence[Balance]) -> SensorDelay | None:
    """Delays of each foot and of the encoders, those that clearly differ; None where one common delay will do."""
    found = estimate_delays(balances) if balances else None
    if found is None:
        return None
    feet = len(names)
    # How far each foot is from the mean of all, and the encoders from the IMU.
    contrasts = np.zeros((feet + 1, feet + 1))
    contrasts[:feet, :feet] = np.eye(feet) - 1 / feet
    contrasts[feet, feet] = 1.0
    apart = contrasts @ found.values
    spread = np.sqrt(np.diag(contrasts @ found.covariance @ contrasts.T) + LEAST_STD**2)
    differ = (np.abs(apart) > np.maximum(DISTINCT * spread, LEAST_DISTINCT)) & (spread < KNOWN_STD)
    if not differ.any():
        return None
    differ[:feet] = differ[:feet].any()
    settled = estimate_delays(balances, contrasts[~differ])
    if settled is None or np.abs(settled.values).max() > LONGEST:
        return None
    delays = dict(zip(names, settled.values[:feet].tolist(), strict=True)) if differ[:feet].any() else {}
    mean = float(np.mean(settled.values[:feet]))
    encoders = float(settled.values[feet])
    std = float(np.hypot(np.sqrt(np.diag(settled.covariance).max()), LEAST_STD))
    each = ", ".join(f"{name} {1e3 * delay:+.1f}" for name, delay in delays.items()) or f"{1e3 * mean:+.1f}"
    text = (
        f"sensors have different delays relative to the IMU: wrenches {each} ms, encoders {1e3 * encoders:+.1f} ms "
        f"(± {1e3 * 1.96 * std:.1f} ms, 95 %): corrected"
    )
    return SensorDelay(
        mean, std, float(settled.cells), True, Note("delays_apart", "warning", text), delays, encoders
    )
