"""By how much an accelerometer is behind the orientation of its own IMU: what soles that stand tell of both.

Newton's law takes its moments from the accelerometer, a bush its angle from the orientation. Where a device filters
the one and not the other, delays of force sensors come out against the one and go into damping with the other: 4 ms of
a 60 Hz filter are 6 to 20 % of it. Over a sole that stands the IMU's acceleration is known (`tilt_error`), and one that
is read τ late leaves a lean of the believed vertical which goes with the tilt's rate. What else leans with the robot's
own motion is fitted beside it: a scale of the attitude, an IMU that is higher than the robot file says, or turned.

No filter makes a sensor early. An accelerometer ahead of the orientation is either right, beside an orientation and a
gyroscope that one filter delays together, or it has drawn the orientation after itself (`tilt_error`): then the
gyroscope is ahead as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from plantar.contact.phases import carried_weight, detect_contact
from plantar.contact.standing_imu import sole_motions, standing_loads
from plantar.conventions import GRAVITY, NORMAL95, SHOWN, Array, rotation_from_quaternion
from plantar.estimation.triangular import RANK_TOLERANCE
from plantar.estimation.weighted_mean import weighted_mean
from plantar.faults.gyroscope import SURE
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.imu_filter import ImuFilter
from plantar.sensors.tilt_error import DERIVED, TOLD, enough_of, lean_of, stance_leans
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import unit_quaternions
from plantar.signals.resampling import shifted, with_continuous_quaternions
from plantar.signals.segments import runs

SLOW = 0.15  # Hz: below it an attitude's wander leans more than any delay
EDGE = 1.0  # s at both ends of a stance: the filters'
RATE = TOLD  # 1/s and axis, of values that tell something new: half of what the band holds: wander is red
LARGEST = 0.01  # s: the filter of an accelerometer of its own; later is a fault
ALIKE = 0.001  # s: standard deviation by which the filters of a device's two sensors differ
EARLY_ENCODERS = 0.0025  # s: as late an orientation seems beside encoders that are read 5 ms early
STRAY = 0.0005  # s: what encoders that are a millisecond off, or legs that are, make of it
ORIENTATION_LATE = "orientation_late"
COLUMNS = 11
"""The lean, and what goes with it."""
ACCELEROMETER, ORIENTATION = 1, 2
"""Columns: what a late one of them makes of the lean."""


@dataclass(frozen=True)
class AccelerometerDelay:
    """Sums over the stances of a log: `products` (11, 11) of the lean and of what goes with it, delays first; `seconds`
    of all axes."""

    products: Array = field(default_factory=lambda: np.zeros((COLUMNS, COLUMNS)))
    seconds: float = 0.0

    def __add__(self, other: AccelerometerDelay) -> AccelerometerDelay:
        return AccelerometerDelay(self.products + other.products, self.seconds + other.seconds)

    def late(self, sensor: int = ACCELEROMETER) -> tuple[float, float]:
        """How far the accelerometer is behind the orientation, or the ORIENTATION behind the accelerometer, and its
        deviation [s]; 0 and inf where none tells.

        Either, not both: a robot that sways as a stick shows only how far they are apart. One whose trunk turns shows
        the one otherwise than the other.
        """
        asked = [0, sensor, *range(ORIENTATION + 1, COLUMNS)]
        products = self.products[np.ix_(asked, asked)]
        size = np.sqrt(np.diag(products))
        if size[0] == 0 or size[1] == 0 or self.seconds == 0:
            return 0.0, np.inf
        scale = np.where(size > 0, size, 1.0)
        scaled = products / np.outer(scale, scale)
        inverse = np.linalg.pinv(scaled[1:, 1:], rcond=RANK_TOLERANCE, hermitian=True)
        found = inverse @ scaled[1:, 0]
        left = max(1.0 - float(found @ scaled[1:, 0]), 0.0)
        unit = float(scale[0] / scale[1])
        return float(found[0]) * unit, unit * float(np.sqrt(left * inverse[0, 0] / (RATE * self.seconds)))


def device_delay(found: Sequence[AccelerometerDelay], sensor: int = ACCELEROMETER) -> tuple[float, float]:
    """How far a sensor of one device is behind the other, as in `AccelerometerDelay.late`: a filter's delay is the same
    in all logs. Inf where none tells.

    What else leans goes its own way in each log: a turned IMU shows otherwise in a squat than in a sway. So each log
    tells by itself, and where logs disagree the deviation grows.
    """
    told = [one for one in (each.late(sensor) for each in found) if 0 < one[1] < np.inf]
    if not told:
        return 0.0, np.inf
    mean = weighted_mean(*zip(*told, strict=True))
    return mean.value, mean.std


def filter_delay(
    told: tuple[float, float],
    gyroscope: ImuFilter | None,
    behind: tuple[float, float] = (0.0, np.inf),
) -> tuple[float, float]:
    """The delay to read an accelerometer earlier by, or, where it is < 0, orientation and gyroscope, and its deviation
    [s]; 0 where it is not told from none, or larger than a filter's. `told`, `behind`: the `device_delay` of either.

    A device filters both of its sensors much alike: a gyroscope whose delay is `shown` tells of the accelerometer,
    unless the two contradict each other, or it is late for another reason. One whose logs disagree shows an orientation
    that follows the accelerometer. So does an accelerometer that is early, unless the gyroscope keeps to the
    orientation.
    """
    late, std, largest = told[0], float(np.hypot(told[1], STRAY)), LARGEST
    if gyroscope is not None and not gyroscope.steady:
        return 0.0, std
    if gyroscope is not None and gyroscope.shown and gyroscope.late < LARGEST and std < np.inf:
        usual = float(np.hypot(gyroscope.std, ALIKE))
        if abs(late - gyroscope.late) < SHOWN * float(np.hypot(std, usual)):
            share = usual**2 / (usual**2 + std**2)
            late, std = share * late + (1 - share) * gyroscope.late, std * float(np.sqrt(share))
            largest = np.inf  # beside a gyroscope that is read on time it must not stay behind
    if SHOWN * std < late < largest:
        return late, std
    early, unsure = behind[0], float(np.hypot(behind[1], STRAY))
    kept = gyroscope is not None and abs(gyroscope.late) + SHOWN * gyroscope.std < early / 2
    least = max(SHOWN * unsure, EARLY_ENCODERS)
    return (-early, unsure) if kept and late < 0 and least < early < LARGEST else (0.0, std)


def imu_delay(told: Sequence[AccelerometerDelay], gyroscope: ImuFilter | None) -> tuple[float, float]:
    """The `filter_delay` [s] and its deviation that logs of one device tell together, each of them as `told`.
    `gyroscope`: what they tell of the filter of the same device."""
    return filter_delay(device_delay(told), gyroscope, device_delay(told, ORIENTATION))


def orientation_notes(log: MotionLog, imu: str, found: AccelerometerDelay) -> list[Note]:
    """A warning where a log without gyroscope, which would tell better, shows an orientation that is behind its
    accelerometer by more than encoders that are read early make of it."""
    late, std = found.late(ORIENTATION)
    if log.has(*imu_columns(imu, "angular_velocity")) or late < max(LARGEST, SURE * std):
        return []
    text = (
        f"{log.name}: columns 'imu.{imu}.orientation.*': {1e3 * late:.0f} ms behind the accelerometer over soles that "
        "stand: late, behind a slow filter, or filtered towards the accelerometer; stiffness and damping follow it "
        "(valid: an attitude filter that keeps up, or the gyroscope in the log, beside which it is put right)"
    )
    return [Note(ORIENTATION_LATE, "warning", text)]


def with_imus_on_time(
    robot: RobotModel, logs: Sequence[MotionLog], delay: tuple[float, float]
) -> list[MotionLog]:
    """Checked logs of one IMU with its accelerometer and its orientation read at the same moments, and a note of it.

    The later of the two is read earlier by the `imu_delay`; the gyroscope goes with the orientation. As they are where
    it is 0.
    """
    late, std = delay
    if robot.imu is None or not late:
        return [*logs]
    by = f"{1e3 * abs(late):.1f} ± {1e3 * NORMAL95 * std:.1f} ms behind"
    end = "(95 %) over soles that stand, read earlier by as much"
    code, text = (
        ("accelerometer_delay", f"accelerometer {by} the IMU's orientation {end}")
        if late > 0
        else ("orientation_delay", f"the IMU's orientation and gyroscope {by} its accelerometer {end}")
    )
    note = Note(code, "info", text)
    return [_read_earlier(log, robot.imu.name, late, note) for log in logs]


def _read_earlier(log: MotionLog, imu: str, late: float, note: Note) -> MotionLog:
    """The log with its accelerometer read `late` [s] earlier, or orientation and gyroscope where that is < 0; itself
    where it has none."""
    kinds = ("linear_acceleration",) if late > 0 else ("orientation", "angular_velocity")
    columns = [name for name in imu_columns(imu, *kinds) if log.has(name)]
    if not columns:
        return log
    own = with_continuous_quaternions(log)
    on_time = shifted(np.column_stack([own[name] for name in columns]), log.period, abs(late))
    return log.with_columns(dict(zip(columns, on_time.T, strict=True)), note)


def accelerometer_delay(robot: RobotModel, log: MotionLog) -> AccelerometerDelay:
    """What the stances of one evenly sampled log tell; nothing of one without orientation and accelerometer."""
    imu, found = robot.imu, AccelerometerDelay()
    orientation = None if imu is None else log.orientation(imu.name)
    if imu is None or orientation is None or not log.has_imu(imu.name, "linear_acceleration"):
        return found
    every = enough_of(log.period)
    period = every * log.period
    edge = round(EDGE / period)
    for signals in _leans(
        robot, log, unit_quaternions(orientation), log.linear_acceleration(imu.name), every
    ):
        for run in runs(np.asarray(np.isfinite(signals).all(axis=(1, 2)))):
            if run.stop - run.start > 4 * edge:
                own = signals[run]
                moved = own - low_pass(own.reshape(len(own), -1), period, SLOW).reshape(own.shape)
                rows = np.concatenate([moved[edge:-edge, 0], moved[edge:-edge, 1]])
                found = found + AccelerometerDelay(period * rows.T @ rows, len(rows) * period)
    return found


def _leans(
    robot: RobotModel, log: MotionLog, orientation: Array, acceleration: Array, every: int
) -> Iterator[Array]:
    """Of each stance the lean about both axes and what goes with it, (n, 2, 11) [rad, and per unit], at `every` nth
    sample."""
    period, feet = log.period, sole_motions(robot, log.positions(robot), orientation)
    forces = standing_loads(robot, log, feet)
    contacts = detect_contact(
        {name: low_pass(force, period, DERIVED) for name, force in forces.items()},
        {name: foot.contact == "always" for name, foot in robot.feet.items()},
        max(carried_weight(forces), 0.3 * robot.mass * GRAVITY),
        period,
    )
    rotation, smooth = rotation_from_quaternion(orientation), low_pass(acceleration, period, DERIVED)
    earlier = -differentiate(smooth, period)
    pushed, tilt = np.einsum("nij,nj->ni", rotation[:, :2], earlier), rotation[:, :2, 2]
    # What an orientation believes a moment ago was up.
    up = differentiate(low_pass(rotation[:, 2], period, DERIVED), period)
    before = np.einsum("nij,nj->ni", rotation[:, :2], up)
    rising = np.einsum("nj,nj->n", rotation[:, 2], smooth)
    for run, lean, height in stance_leans(orientation, acceleration, feet, contacts, period, every):
        place = np.mean([foot.sole_position[run, :2] for foot in feet.values()], axis=0)
        none = np.zeros_like(place)
        tilted, behind = (low_pass(each[run], period, TOLD, every=every) for each in (tilt, before))
        turning = np.column_stack([-place[:, 1], place[:, 0]])
        # An IMU that leans in its mount takes a part of what rises for what goes to the side.
        aside = [np.outer(rising[run], side) for side in np.eye(2)]
        pushes = np.hstack([none, none, pushed[run], *aside])
        places = np.hstack([tilt[run], turning, none, none, none])
        higher, turned, late, *leant = np.split(lean_of(pushes, places, height, period, every), 5, axis=1)
        about, across = ([each * side for each in (tilted, higher)] for side in np.eye(2))
        swapped = np.column_stack([-tilted[:, 1], tilted[:, 0]])
        yield np.stack([lean, late, behind, *about, *across, turned, swapped, *leant], axis=2)
