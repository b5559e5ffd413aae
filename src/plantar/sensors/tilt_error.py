"""An IMU's attitude that follows its accelerometer, put right by a sole that stands.

A causal filter corrects the integrated gyroscope towards the measured proper acceleration, at k [1/s]. A robot that
sways accelerates, so that the believed vertical leans by k·v/g, v the velocity of the IMU: in phase with the rate of
the bush, it goes into the damping as K·h·k/g, h the IMU's height: two thirds of C at k = 0.2. A standing sole tells the
truth: the IMU's acceleration is the opposite of the sole's as seen from the IMU. An attitude wrong by a small angle δ
leaves, with f the proper acceleration, p the sole's place in the IMU's frame and R the believed attitude,

    horizontal (R f + d²(R p)/dt²) = g δ - h d²δ/dt², which is (g + h ω²) δ at the frequency ω.

What does not change with time stays: the fit has an offset.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from plantar.contact.deflection import BushState, FootMotion
from plantar.contact.phases import FootContact
from plantar.contact.stances import LONGEST_STANCE
from plantar.conventions import GRAVITY, Array, Mask, cross, rotation_from_quaternion
from plantar.faults.gyroscope import SURE
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import Imu
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.gyroscope_delay import gyroscope_delay
from plantar.signals.orientation import rates_from, unit_quaternions
from plantar.signals.resampling import shifted
from plantar.signals.segments import runs

ATTITUDE_TILTED = "attitude_tilted"
BAND = 2.0  # Hz: the accelerometer-induced tilt error shows below it
LEAST_RATE = 0.01  # 1/s: below it the damping is not affected
EXPLAINED = 0.3  # share of the disagreement of attitude and gyroscope that shows it
AXES = 2
"""Of the horizontal plane, in which the vertical leans."""
CORRECTED = 3.0  # Hz, up to which the attitude is put right: as far as robots sway
TOLD = 1.5  # Hz, up to which leans tell of sensors that are late or turned
DERIVED = 5.0  # Hz: filter of what is differentiated twice
# Samples of DERIVED's period: differences of such leave the band below TOLD as it is.
KEPT_PER_PERIOD = 8.0
PADDING = 2.0  # s that are mirrored at both ends of a stance: as long as a lean answers to
ACCELEROMETER_ZERO = 0.005  # of gravity, its deviation
SURELY = 4.0  # of such deviations: more is a scale, and nobody knows whether the accelerometer's or the gyroscope's


@dataclass(frozen=True)
class TiltError:
    """What attitude and gyroscope disagree about, beside the tilt error that a filter of 1 1/s would
    make: integrals that add up.

    `error` and `predicted`: of both squared [rad²/s]; `product`: of one times the other; over `duration` [s]. A filter
    belongs to the IMU, so that the sum over recordings tells what a quiet one alone cannot.
    """

    product: float = 0.0
    predicted: float = 0.0
    error: float = 0.0
    duration: float = 0.0

    def __add__(self, other: TiltError) -> TiltError:
        return TiltError(
            self.product + other.product,
            self.predicted + other.predicted,
            self.error + other.error,
            self.duration + other.duration,
        )

    @property
    def rate(self) -> float:
        """How fast the attitude follows the accelerometer, k [1/s]."""
        return self.product / self.predicted if self.predicted > 0 else 0.0

    @property
    def explained(self) -> float:
        """Share of the disagreement's square that it explains."""
        return self.rate * self.product / self.error if self.error > 0 else 0.0

    @property
    def std(self) -> float:
        """Of the rate [1/s], from what it leaves of the disagreement: as many independent values as the band holds."""
        if self.predicted <= 0 or self.duration <= 0:
            return float("inf")
        left = max(self.error - self.rate * self.product, 0.0)
        return float(np.sqrt(left / self.predicted / (2 * BAND * self.duration * AXES)))

    @property
    def believed(self) -> bool:
        """Whether it explains much of the disagreement or is well told from none, and matters.

        A gyroscope that is late by τ beside the attitude looks like a tilt error of about g τ/h [1/s]: it is
        corrected in the same way.
        """
        shown = self.explained > EXPLAINED or self.rate > SURE * self.std
        return self.rate > LEAST_RATE and shown


NO_TILT_ERROR = TiltError()


def disagreement(orientation: Array, rates: Array, period: float) -> tuple[Array, Array]:
    """The world's up in the IMU's frame, and how fast it leaves what the gyroscope says [1/s], both (N, 3).

    orientation and rates as of `tilt_error_of`.
    """
    up = rotation_from_quaternion(orientation)[:, 2, :]
    turned = low_pass(cross(rates, up), period, BAND)
    return up, differentiate(low_pass(up, period, BAND), period) + turned


def log_tilt_error(log: MotionLog, imu: Imu) -> TiltError:
    """The accelerometer-induced tilt error of one log; zeros where attitude, gyroscope or accelerometer is missing."""
    orientation = log.orientation(imu.name)
    if orientation is None or not log.has_imu(imu.name, "angular_velocity", "linear_acceleration"):
        return NO_TILT_ERROR
    rates, acceleration = log.angular_velocity(imu.name), log.linear_acceleration(imu.name)
    return tilt_error_of(unit_quaternions(orientation), rates, acceleration, log.period)


def right_attitude(
    log: MotionLog,
    imu: Imu,
    orientation: Array,
    tilt_errors: tuple[TiltError, TiltError],
    bushes: Mapping[str, BushState],
    contacts: Mapping[str, FootContact],
) -> tuple[Array, Note] | None:
    """The log's orientation (N, 4) without what its filter took from the accelerometer, and a note that says so.

    None where neither this log nor all together, whose `tilt_errors` these are, show that it took any, or this log has
    not the sensors.
    """
    own, together = tilt_errors
    found = own if own.believed else together
    if not found.believed or own.predicted == 0:
        return None
    text = (
        f"{log.name}: the IMU's attitude follows its accelerometer (as at {found.rate:.2g} 1/s), so motion tilts it; "
        "corrected from the soles that stand still"
    )
    unit = unit_quaternions(orientation)
    rates, acceleration = log.angular_velocity(imu.name), log.linear_acceleration(imu.name)
    right = put_right(unit, rates, acceleration, bushes, contacts, log.period)
    return right, Note(ATTITUDE_TILTED, "info", text)


def tilt_error_of(orientation: Array, rates: Array, acceleration: Array, period: float) -> TiltError:
    """How an attitude follows its accelerometer; of zeros where too little is known.

    orientation: unit quaternions w x y z, IMU to world, (N, 4); rates, proper acceleration: the IMU's, (N, 3).
    """
    up, error = disagreement(orientation, rates, period)
    # World's up in the body: d(up)/dt = -(ω + k (a × up)) × up, a the direction of the acceleration.
    size = np.linalg.norm(acceleration, axis=1, keepdims=True)
    direction = acceleration / np.where(size > 0, size, np.nan)
    predicted = low_pass(-cross(cross(direction, up), up), period, BAND)
    found = integrals(error, predicted, period)
    return NO_TILT_ERROR if found is None else TiltError(*found)


def integrals(error: Array, predicted: Array, period: float) -> tuple[float, float, float, float] | None:
    """Of a disagreement (N, 3) and what something predicts of it: of their product, of each one's square, and of how
    long both are known [s]; None where that is no longer than a stance."""
    known = np.isfinite(np.column_stack([error, predicted])).all(axis=1)
    if known.sum() * period < LONGEST_STANCE:
        return None
    error, predicted = (part[known] - part[known].mean(axis=0) for part in (error, predicted))
    product, whole, apart = (
        period * float(np.sum(a * b)) for a, b in ((error, predicted), (predicted, predicted), (error, error))
    )
    return product, whole, apart, period * len(error)


def put_right(
    orientation: Array,
    rates: Array,
    acceleration: Array,
    bushes: Mapping[str, BushState],
    contacts: Mapping[str, FootContact],
    period: float,
) -> Array:
    """The orientation (N, 4) as the soles that stand have it; unchanged where none stands for LONGEST_STANCE.

    rates, acceleration: the gyroscope's and the proper one, in the IMU's frame, (N, 3); bushes: computed with this
    orientation.
    """
    lean = np.full((len(orientation), 2), np.nan)
    for run, found, _ in stance_leans(orientation, acceleration, bushes, contacts, period, band=CORRECTED):
        lean[run] = found
    known = np.isfinite(lean).all(axis=1)
    if not known.any():
        return orientation
    # The accelerometer's zero is no lean; it is one for the whole recording.
    right = _without(orientation, np.where(known[:, None], lean - np.median(lean[known], axis=0), 0.0))
    # Its zero along the vertical is one that goes with each tilt: gyroscopes have none.
    tilt = _tilt(right, known)
    return _without(right, -_tilts_missing(right, rates, known, period) * np.where(known[:, None], tilt, 0.0))


def _without(orientation: Array, lean: Array) -> Array:
    """Orientations (N, 4) without what their vertical leans by along the world's x and y, (N, 2) [rad]."""
    from scipy.spatial.transform import Rotation  # costs start-up

    finite = np.isfinite(orientation).all(axis=1)
    back = Rotation.from_rotvec(np.column_stack([lean[:, 1], -lean[:, 0], np.zeros(len(lean))])[finite])
    right = orientation.copy()
    right[finite] = (back * Rotation.from_quat(orientation[finite], scalar_first=True)).as_quat(
        scalar_first=True
    )
    return right


def _tilt(orientation: Array, known: Mask) -> Array:
    """How far what points up at rest leans along the world's x and y, (N, 2) [rad], from a usual one."""
    to_world = rotation_from_quaternion(orientation)
    up = np.median(to_world[known][:, 2], axis=0)
    tilt = to_world[:, :2] @ (up / np.linalg.norm(up))
    return np.asarray(tilt - np.median(tilt[known], axis=0))


def _tilts_missing(orientation: Array, rates: Array, known: Mask, period: float) -> float:
    """The share by which an attitude tilts less than the gyroscope where it is `known`, as far as it is told from none.

    An accelerometer's zero of 0.05 m/s² along the vertical is half a percent of every tilt. A body tilts several times
    as far as its bushes, so that stiffness is off by as many times the share.
    """
    late = gyroscope_delay(rates, rates_from(orientation, period), period)
    if late is None:
        return 0.0
    up = rotation_from_quaternion(orientation)[:, 2, :]
    turned = low_pass(cross(up, shifted(rates, period, late.late)), period, BAND)
    turning = differentiate(low_pass(up, period, BAND), period)
    known = known & np.isfinite(np.column_stack([turned, turning])).all(axis=1)
    turned, turning = (each[known] - each[known].mean(axis=0) for each in (turned, turning))
    apart, power = turned - turning, float(np.sum(turning**2))
    if power == 0:
        return 0.0
    share = float(np.sum(apart * turning)) / power
    left = float(np.sum((apart - share * turning) ** 2))
    std = np.sqrt(left / power / (2 * BAND * period * known.sum() * AXES))
    return share / (1 + (std / ACCELEROMETER_ZERO) ** 2) if abs(share) < SURELY * ACCELEROMETER_ZERO else 0.0


def enough_of(period: float) -> int:
    """Every nth sample tells a lean as well as all do, since nothing above DERIVED is left: this n."""
    return max(1, int(1 / (KEPT_PER_PERIOD * DERIVED * period)))


def stance_leans(
    orientation: Array,
    acceleration: Array,
    bushes: Mapping[str, BushState | FootMotion],
    contacts: Mapping[str, FootContact],
    period: float,
    every: int = 1,
    band: float = TOLD,
) -> Iterator[tuple[slice, Array, float]]:
    """Long stances on the same feet, how far the believed vertical leans along the world's x and y, (n, 2) [rad], at
    `every` nth sample, and the IMU's height [m]; up to a `band` [Hz].

    Others as of `put_right`. Each stance has a zero of its own: the accelerometer's, the attitude's, the sole's.
    """
    push = np.einsum("nij,nj->ni", rotation_from_quaternion(orientation)[:, :2], acceleration)
    standing = np.array([contacts[foot].standing for foot in bushes])
    pattern = (1 << np.arange(len(standing))) @ standing
    finite = np.isfinite(push).all(axis=1)
    for bush in bushes.values():
        finite &= np.isfinite(bush.sole_position).all(axis=1)
    for which in np.unique(pattern[pattern > 0]):
        feet = [
            bush
            for bush, stands in zip(bushes.values(), standing, strict=True)
            if stands[pattern == which].all()
        ]
        for run in runs(np.asarray(finite & (pattern == which))):
            if (run.stop - run.start) * period >= LONGEST_STANCE:
                place = np.mean([bush.sole_position[run] for bush in feet], axis=0)
                height = -float(np.median(place[:, 2]))
                yield run, lean_of(push[run], place[:, :2], height, period, every, band), height


def lean_of(push: Array, place: Array, height: float, period: float, every: int, band: float = TOLD) -> Array:
    """How far the believed vertical leans along x and y, (n, 2) [rad], over one stance, at `every` nth sample, up to a
    `band` [Hz].

    push: horizontal acceleration of the IMU in the believed world; place: of the sole from the IMU, both (n, 2), or
    several such beside each other; height: of the IMU [m].
    """
    smooth, pushed = low_pass(np.column_stack([push, place]), period, DERIVED, every=every), push.shape[1]
    period = every * period
    left = smooth[:, :pushed] + differentiate(differentiate(smooth[:, pushed:], period), period)
    padding = min(round(PADDING / period), len(left) - 1)
    mirrored = np.vstack([left[padding:0:-1], left, left[-2 : -padding - 2 : -1]])
    frequency = np.fft.rfftfreq(len(mirrored), period)
    gain = 1 / (GRAVITY + height * (2 * np.pi * frequency) ** 2) / (1 + (frequency / band) ** 8)
    lean = np.fft.irfft(np.fft.rfft(mirrored, axis=0) * gain[:, None], len(mirrored), axis=0)
    return np.asarray(lean[padding : padding + len(left)])
