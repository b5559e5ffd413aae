"""By how much an accelerometer is behind the orientation of its own IMU: what soles that stand tell of both.

Newton's law takes its moments from the accelerometer, a bush its angle from the orientation. Where a device filters
the one and not the other, delays of force sensors come out against the one and go into damping with the other: 4 ms of
a 60 Hz filter are 6 to 20 % of it. Over a sole that stands the IMU's acceleration is known (`tilt_error`), and one that
is read τ late leaves a lean of the believed vertical which goes with the tilt's rate. What else leans with the robot's
own motion is fitted beside it: a scale of the attitude, an IMU that is higher than the robot file says, or turned.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from plantar.contact.deflection import FootMotion, foot_motion, path_to
from plantar.contact.phases import carried_weight, detect_contact
from plantar.conventions import FORCE, GRAVITY, NORMAL95, Array, rotation_from_quaternion
from plantar.estimation.weighted_mean import weighted_mean
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.imu_filter import ImuFilter
from plantar.sensors.tilt_error import CORRECTED, DERIVED, enough_of, lean_of, stance_leans, unit_quaternions
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import shifted
from plantar.signals.segments import runs

SLOW = 0.15  # Hz: below it an attitude's wander leans more than any delay
EDGE = 1.0  # s at both ends of a stance: the filters'
RATE = CORRECTED  # 1/s and axis, of values that tell something new: half of what the band holds, since wander is red
SURE = 3.0  # deviations
ALIKE = 0.001  # s: standard deviation by which the filters of a device's two sensors differ
STRAY = 0.0005  # s: what encoders that are a millisecond off, or legs that are, make of it
LARGEST = 0.01  # s: a device's own filter; later is a fault, and `sensor_delay` searches for it
COLUMNS = 10  # the lean, and what goes with it
SINGULAR = (
    1e-10  # of the columns' products, scaled to 1: one pace of sway does not tell scale and height apart
)


@dataclass(frozen=True)
class AccelerometerDelay:
    """Sums over the stances of a log: `products` (10, 10) of the lean and of what goes with it, delay first; `seconds`
    of all axes."""

    products: Array = field(default_factory=lambda: np.zeros((COLUMNS, COLUMNS)))
    seconds: float = 0.0

    def __add__(self, other: AccelerometerDelay) -> AccelerometerDelay:
        return AccelerometerDelay(self.products + other.products, self.seconds + other.seconds)

    @property
    def late(self) -> tuple[float, float]:
        """How far the accelerometer is behind the orientation, and its deviation [s]; 0 and inf where none tells."""
        size = np.sqrt(np.diag(self.products))
        if size[0] == 0 or size[1] == 0 or self.seconds == 0:
            return 0.0, np.inf
        scale = np.where(size > 0, size, 1.0)
        scaled = self.products / np.outer(scale, scale)
        inverse = np.linalg.pinv(scaled[1:, 1:], rcond=SINGULAR, hermitian=True)
        found = inverse @ scaled[1:, 0]
        left = max(1.0 - float(found @ scaled[1:, 0]), 0.0)
        unit = float(scale[0] / scale[1])
        return float(found[0]) * unit, unit * float(np.sqrt(left * inverse[0, 0] / (RATE * self.seconds)))


def device_delay(found: Sequence[AccelerometerDelay]) -> tuple[float, float]:
    """How far one device's accelerometer is behind its orientation and its deviation [s]: a filter's delay is the same
    in all logs. Inf where none tells.

    What else leans goes its own way in each log: a turned IMU shows otherwise in a squat than in a sway. So each log
    tells by itself, and where logs disagree the deviation grows.
    """
    told = [one for one in (each.late for each in found) if 0 < one[1] < np.inf]
    if not told:
        return 0.0, np.inf
    mean = weighted_mean(*zip(*told, strict=True))
    return mean.value, mean.std


def filter_delay(told: tuple[float, float], gyroscope: ImuFilter | None) -> tuple[float, float]:
    """The delay to read an accelerometer earlier by and its deviation [s]; 0 where it is not told from none, or larger
    than a filter's.

    A device filters both of its sensors much alike: a gyroscope whose delay is `shown` tells of the accelerometer,
    unless the two contradict each other. One whose logs disagree shows an orientation that follows the accelerometer,
    and so does an accelerometer that is early: no filter makes it so (`tilt_error`).
    """
    late, std = told[0], float(np.hypot(told[1], STRAY))
    if gyroscope is not None and not gyroscope.steady:
        return 0.0, std
    if gyroscope is not None and gyroscope.shown and std < np.inf:
        usual = float(np.hypot(gyroscope.std, ALIKE))
        if abs(late - gyroscope.late) < SURE * float(np.hypot(std, usual)):
            share = usual**2 / (usual**2 + std**2)
            late, std = share * late + (1 - share) * gyroscope.late, std * float(np.sqrt(share))
    return (late, std) if SURE * std < late < LARGEST else (0.0, std)


def with_accelerometers_on_time(
    robot: RobotModel,
    logs: Sequence[MotionLog],
    told: Sequence[AccelerometerDelay],
    gyroscope: ImuFilter | None = None,
) -> list[MotionLog]:
    """Checked logs of one IMU with its accelerometer read at the moments of its orientation, and a note of it.

    All logs tell together, each of them as `told`: a filter belongs to the device. As they are where that is not sure.
    `gyroscope`: what they tell of the filter of the same device.
    """
    late, std = filter_delay(device_delay(told), gyroscope)
    if robot.imu is None or not late:
        return [*logs]
    how = f"{1e3 * late:.1f} ± {1e3 * NORMAL95 * std:.1f} ms behind the IMU's orientation (95 %)"
    note = Note(
        "accelerometer_delay", "info", f"accelerometer {how} over soles that stand, read earlier by as much"
    )
    columns, read = imu_columns(robot.imu.name, "linear_acceleration"), list[MotionLog]()
    for log in logs:
        if log.has(*columns):
            on_time = shifted(log.linear_acceleration(robot.imu.name), log.period, late)
            log = log.with_columns(dict(zip(columns, on_time.T, strict=True)), note)
        read.append(log)
    return read


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
    """Of each stance the lean about both axes and what goes with it, (n, 2, 10) [rad, and per unit], at `every` nth
    sample."""
    period, (feet, forces) = log.period, _feet(robot, log, orientation)
    contacts = detect_contact(
        {name: low_pass(force, period, DERIVED) for name, force in forces.items()},
        {name: foot.contact == "always" for name, foot in robot.feet.items()},
        max(carried_weight(forces), 0.3 * robot.mass * GRAVITY),
        period,
    )
    rotation, smooth = rotation_from_quaternion(orientation), low_pass(acceleration, period, DERIVED)
    earlier = -differentiate(smooth, period)
    pushed, tilt = np.einsum("nij,nj->ni", rotation[:, :2], earlier), rotation[:, :2, 2]
    rising = np.einsum("nj,nj->n", rotation[:, 2], smooth)
    for run, lean, height in stance_leans(orientation, acceleration, feet, contacts, period, every):
        place = np.mean([foot.sole_position[run, :2] for foot in feet.values()], axis=0)
        none = np.zeros_like(place)
        tilted = low_pass(tilt[run], period, CORRECTED, every=every)
        turning = np.column_stack([-place[:, 1], place[:, 0]])
        # An IMU that leans in its mount takes a part of what rises for what goes to the side.
        aside = [np.outer(rising[run], side) for side in np.eye(2)]
        pushes = np.hstack([none, none, pushed[run], *aside])
        places = np.hstack([tilt[run], turning, none, none, none])
        higher, turned, late, *leant = np.split(lean_of(pushes, places, height, period, every), 5, axis=1)
        about, across = ([each * side for each in (tilted, higher)] for side in np.eye(2))
        swapped = np.column_stack([-tilted[:, 1], tilted[:, 0]])
        yield np.stack([lean, late, *about, *across, turned, swapped, *leant], axis=2)


def _feet(
    robot: RobotModel, log: MotionLog, orientation: Array
) -> tuple[dict[str, FootMotion], dict[str, Array]]:
    """Where the soles are, without rates, and what each foot carries (N,) [N]."""
    positions, still = log.positions(robot), np.zeros((len(log), 3))
    velocities, motions, forces = np.zeros_like(positions), dict[str, FootMotion](), dict[str, Array]()
    for name, foot in robot.feet.items():
        path, _, to_bush = path_to(robot, name)
        motions[name] = motion = foot_motion(path, positions, velocities, orientation, still)
        turn = (to_bush * robot.frame(foot.wrench.placement)[1]).rotation
        read = foot.wrench.sign * log.wrench(foot.wrench.name)[:, FORCE] @ turn.T
        forces[name] = np.einsum("ni,ni->n", motion.up, read)
    return motions, forces
