"""A gyroscope beside the orientation of its IMU: both must tell of the same turns, at the same time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import GRAVITY, Array, Mask, rotation_from_quaternion
from plantar.faults.quaternions import misread, readings, turns_between
from plantar.faults.stance_changes import BETTER
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.signals.gyroscope_delay import USUAL, gyroscope_delay
from plantar.signals.heading import heading_jumps, without_jumps
from plantar.signals.medians import median
from plantar.signals.orientation import rates_from
from plantar.signals.resampling import GAP_PERIODS
from plantar.signals.segments import complete, spread_out

WINDOW = 0.5  # s over which the orientation's turn is compared with the gyroscope's integral
OVERLAP = 5  # windows begin in each window's time
LEAST_TURN = np.radians(0.5)  # in one window: as large as what an attitude filter adds of its own
ABOVE_NOISE = 6.0  # times the noise of a window's turn: large enough where that is less
FEWEST_WINDOWS = 20  # in which something turns: of fewer one blow is a large share
WRONG_TURN, RIGHT_TURN = 0.8, 0.3  # difference of the two turns over the turn itself
SCALE_OFF, TURNED = 0.05, 0.1  # share, rad: of a gyroscope, damping is off by as much
SURE = 6.0  # deviations
FOLLOWED = 0.25  # share of the difference's square that turning one side may leave
PLANAR = 0.05  # second over first singular value: turns about one axis do not show how the other two lie
QUARTERS = {"90": (0, 1), "180": (-1, 0), "-90": (0, -1)}  # cosine and sine, by degrees
UPRIGHT = np.radians(25)  # up by the accelerometer and by the orientation are no further apart, but for noise
IMU_LATE, SCALE, FRAME = "imu_late", "gyroscope_scale", "gyroscope_frame"
BY_LEANS = frozenset({IMU_LATE, SCALE, FRAME})  # an orientation that leans looks like these as well
EXPLAINED = 0.1  # share of the difference of both rates, by a delay between gyroscope and orientation
# Samples of orientation and accelerometer: fewer tell nothing; more tell no more.
FEWEST_COMPARED, COMPARED = 10, 2000
MEDIAN = 0.6745  # of absolute values over the deviation, of a normal distribution
REVERSED = -0.9  # correlation, and slope within a factor of two, of an axis that reads the opposite


@dataclass(frozen=True)
class Turns:
    """Turns in windows of WINDOW, (n, 3) [rad]: the gyroscope's `integral`, and the orientation's `by_reading`.

    `world`: the orientation's about the world's axes. All without their means: a constant bias is no fault, the fit
    takes it off. `least` [rad]: turns smaller than that do not count. `steps` [rad]: see `_written_steps`.
    """

    integral: Array
    by_reading: Mapping[str, Array]
    world: Array
    least: float
    steps: float = 0.0

    @classmethod
    def of(cls, log: MotionLog, name: str, orientation: Array) -> Turns | None:
        """None where the log is too short, or moves too little to tell."""
        rates = log.angular_velocity(name)
        stride = max(1, round(WINDOW / log.period))
        if len(log) < 2 * stride:
            return None
        lasts = np.diff(log.time)[:, None]
        # Across a gap nobody knows how it has turned, least of all where the clock was set.
        steps = np.where(lasts > GAP_PERIODS * log.period, np.nan, (rates[1:] + rates[:-1]) / 2 * lasts)
        orientation = without_jumps(orientation, heading_jumps(orientation, np.linalg.norm(steps, axis=1)))
        total = np.vstack([np.zeros(3), np.cumsum(np.nan_to_num(steps), axis=0)])
        missing = np.concatenate([[0], np.cumsum(np.isnan(steps).any(axis=1))])
        starts = np.arange(0, len(log) - stride, max(1, stride // OVERLAP))
        ends = starts + stride
        whole = complete(orientation[starts], orientation[ends]) & (missing[ends] == missing[starts])
        starts, ends = starts[whole], ends[whole]
        if starts.size == 0:
            return None
        before, after = readings(orientation[starts]), readings(orientation[ends])
        by_reading = {reading: turns_between(before[reading], after[reading]) for reading in before}
        rotation = rotation_from_quaternion(orientation[starts])
        world = np.einsum("nij,nj->ni", rotation, by_reading["as it is"])
        integral = _centred(total[ends] - total[starts])
        turns = {reading: _centred(turn) for reading, turn in by_reading.items()}
        # As a share of what the gyroscope itself shows: it may read degrees.
        drowned = _white(rates) * np.sqrt(WINDOW * log.period) / max(float(np.std(integral)), 1e-12)
        noise = np.hypot(drowned * np.std(turns["as it is"]), np.sqrt(2) * _white(2 * orientation))
        found = cls(
            integral,
            turns,
            _centred(world),
            min(LEAST_TURN, ABOVE_NOISE * float(noise)),
            _written_steps(orientation),
        )
        return found if found.moving.sum() >= FEWEST_WINDOWS else None

    @property
    def turn(self) -> Array:
        return self.by_reading["as it is"]

    @cached_property
    def size(self) -> Array:
        return np.asarray(np.linalg.norm(self.turn, axis=1))

    @cached_property
    def moving(self) -> Mask:
        return np.asarray(self.size > self.least)

    @cached_property
    def apart(self) -> dict[str, float]:
        """Usual difference of both turns over the turn itself, in each reading of the quaternion."""
        moving = self.moving
        return {
            reading: float(
                np.median(np.linalg.norm((turn - self.integral)[moving], axis=1) / self.size[moving])
            )
            for reading, turn in self.by_reading.items()
        }

    @property
    def agree(self) -> bool:
        """Whether the gyroscope turns as the orientation does, read as the columns say."""
        return self.apart["as it is"] < RIGHT_TURN

    @property
    def quarter_turns(self) -> str:
        """By how many degrees about z the orientation's axes may be turned, to turn as the gyroscope does."""
        found, moving = [], self.moving
        for degrees, (x, y) in QUARTERS.items():
            other = self.turn @ np.array([[x, y, 0], [-y, x, 0], [0, 0, 1]])
            apart = np.linalg.norm((other - self.integral)[moving], axis=1) / self.size[moving]
            if np.median(apart) < RIGHT_TURN:
                found.append(degrees)
        return " or ".join(found)

    @property
    def about_world(self) -> bool:
        """Whether the gyroscope turns as the orientation does about the world's axes, and not about the IMU's own."""
        apart, from_world = (np.sum((self.integral - turn) ** 2) for turn in (self.turn, self.world))
        return float(from_world) < FOLLOWED * float(apart)


def _centred(turns: Array) -> Array:
    return np.asarray(turns - turns.mean(axis=0))


def _white(signals: Array) -> float:
    """Deviation of the white noise of `signals` (n, k), of all columns together, from their second differences."""
    changes = np.abs(np.diff(signals, 2, axis=0)).T
    known = [change if np.isfinite(change.sum()) else change[~np.isnan(change)] for change in changes]
    usual = np.array([median(change) for change in known if change.size])
    return float(np.linalg.norm(usual) / MEDIAN / np.sqrt(6))


def check_gyroscope(name: str, log: MotionLog, orientation: Array, turns: Turns) -> Iterator[Finding]:
    """Findings about the turns' size first, then their sense, their moments, and the axes that they are about."""
    moving = turns.moving
    ratio = float(np.median(np.linalg.norm(turns.integral[moving], axis=1) / turns.size[moving]))
    where = f"columns 'imu.{name}.angular_velocity.*'"
    if 30 < ratio < 110:
        text = f"{where}: {ratio:.0f} times the orientation's rate, which looks like degrees per second (valid: rad/s)"
        yield Finding("degrees", text, True)
        return
    if not 0.5 < ratio < 2:
        yield Finding(SCALE, f"{where}: {ratio:.2g} times the orientation's rate (valid: about 1)")
        return
    if not _upside_down(name, log, orientation):
        opposite = _reversed_axes(turns)
        if opposite:
            names = " and ".join(f"'imu.{name}.angular_velocity.{axis}'" for axis in opposite)
            text = f"column {names}: turns against the orientation, which the accelerometer's up does not contradict"
            text += ", or all of the gyroscope turns about the world's axes" if turns.about_world else ""
            inverted = turns.apart["inverted"] < RIGHT_TURN
            text += ", or the orientation's quaternion is inverted, world to body" if inverted else ""
            yield Finding("sign", f"{text} (valid: right-handed about the IMU's axes)", True)
            return
    yield from imu_late(name, log, orientation)
    best = min(turns.apart, key=turns.apart.__getitem__)
    beside = turns.quarter_turns
    if turns.apart[best] < min(RIGHT_TURN, BETTER * turns.apart["as it is"]):
        if beside and _leans(name, log, readings(orientation)[best]):
            text = f"{where}: turns about axes {beside} deg beside the orientation's, about z"
            yield Finding(FRAME, f"{text} (valid: both in the IMU's own frame)", True)
            return
        or_else = f", or with axes turned by {beside} deg about z" if beside else ""
        yield misread(name, "turns another way than the gyroscope", best, or_else)
    elif turns.apart["as it is"] < WRONG_TURN:
        yield from _axes_and_scale(where, turns)
    else:
        text = f"{where}: turns about other axes than the orientation"
        text += f", turned by {beside} deg about z" if beside else ""
        yield Finding(FRAME, f"{text} (valid: both in the IMU's own frame)")


def beside_leans(name: str, log: MotionLog, orientation: Array) -> list[Finding]:
    """What a log whose gyroscope was put right, or another orientation of the same IMU, as soles that stand have it,
    still shows of the findings that an orientation which leans makes as well."""
    turns = Turns.of(log, name, orientation)
    found = (
        check_gyroscope(name, log, orientation, turns)
        if turns is not None
        else imu_late(name, log, orientation)
    )
    return [finding for finding in found if finding.code in BY_LEANS]


def _axes_and_scale(where: str, turns: Turns) -> Iterator[Finding]:
    """A gyroscope that reads nearly what the orientation does, but about other axes, or too much or too little."""
    integral, turn = turns.integral, turns.turn
    apart, power = float(np.sum((integral - turn) ** 2)), float(np.sum(turn**2))
    if power == 0 or apart == 0:
        return
    if turns.about_world:
        yield Finding(FRAME, f"{where}: turns about the world's axes (valid: the IMU's own)")
        return
    mount, shown = _turned_onto(integral, turn), np.linalg.svd(turn, compute_uv=False)
    angle = float(np.arccos(np.clip((np.trace(mount) - 1) / 2, -1, 1)))
    left = float(np.sum((integral - turn @ mount.T) ** 2))
    if angle > TURNED and left < FOLLOWED * apart and shown[1] > PLANAR * shown[0]:
        text = f"{where}: turns about axes {np.degrees(angle):.0f} deg beside the orientation's"
        yield Finding(FRAME, f"{text} (valid: both in the IMU's own frame)")
        return
    scale = float(np.sum(integral * turn)) / max(power - turn.size * turns.steps**2, 1e-12)
    missed = float(np.sum((integral - scale * turn) ** 2))
    deviation = np.sqrt(missed / power * OVERLAP / turn.size)
    if abs(scale - 1) > max(SCALE_OFF, SURE * deviation):
        text = f"{where}: {scale:.2f} times the orientation's rate, and damping follows it (valid: 1)"
        yield Finding(SCALE, text)


def _written_steps(orientation: Array) -> float:
    """Deviation of a turn's components [rad] by the steps in which quaternions (n, 4) were written, with few digits.

    A turn is twice a difference of two of them, each off by a step's rounding.
    """
    steps = np.abs(np.diff(orientation, axis=0))
    smallest = np.min(steps, axis=0, where=steps > 0, initial=np.inf)
    known = smallest[np.isfinite(smallest)]
    return float(2 * np.sqrt(2) * np.median(known) / np.sqrt(12)) if known.size else 0.0


def _turned_onto(one: Array, other: Array) -> Array:
    """The rotation (3, 3) that turns vectors `other` (n, 3) best onto `one` (W. Kabsch, Acta Cryst. A32, 1976)."""
    left, _, right = np.linalg.svd(one.T @ other)
    left[:, -1] *= np.linalg.det(left @ right)
    return np.asarray(left @ right)


def imu_late(name: str, log: MotionLog, orientation: Array) -> Iterator[Finding]:
    """Whether orientation and gyroscope tell of the same turn at different times: rates and angles then disagree."""
    turning = rates_from(orientation, log.period)
    turning[np.append(False, np.diff(log.time) > 1.5 * log.period)] = np.nan
    found = gyroscope_delay(log.angular_velocity(name), turning, log.period)
    if found is None or found.explained < EXPLAINED:
        return
    late = found.late
    if abs(late) > max(USUAL, SURE * found.std):
        later, other = ("gyroscope", "orientation") if late > 0 else ("orientation", "gyroscope")
        text = f"columns 'imu.{name}.*': the {later} is {1e3 * abs(late):.0f} ms behind the {other} in this motion"
        cause = "late, or filtered towards the accelerometer; damping is less sure"
        yield Finding(IMU_LATE, f"{text}: {cause} (valid: both of one moment)")


def _reversed_axes(turns: Turns) -> str:
    """The gyroscope's axes that read the opposite; none where one axis agrees with nothing, as in another frame."""
    opposite = ""
    for axis, integrated, turned in zip("xyz", turns.integral.T, turns.turn.T, strict=True):
        if (np.abs(turned) > turns.least).sum() < FEWEST_WINDOWS:
            continue
        apart = float(np.std(integrated) * np.std(turned))
        alike = float(np.mean(integrated * turned)) / max(apart, 1e-12)
        slope = float(integrated @ turned / (turned @ turned))
        if alike < REVERSED and -2 < slope < -0.5:
            opposite += axis
        elif not alike > -REVERSED:
            return ""
    return opposite


def rows_to_compare(orientation: Array, acceleration: Array) -> NDArray[np.intp] | None:
    """Samples in which both are known, spread over the log; None where there are too few."""
    whole = np.flatnonzero(complete(orientation, acceleration))
    return None if whole.size < FEWEST_COMPARED else spread_out(whole, COMPARED)


def _up_and_felt(name: str, log: MotionLog, orientation: Array) -> tuple[Array, Array] | None:
    """Up in the IMU's axes by an orientation (n, 4), and what its accelerometer reads [g], (k, 3) each; None where too
    few samples hold both."""
    if not log.has_imu(name, "linear_acceleration"):
        return None
    acceleration = log.linear_acceleration(name)
    rows = rows_to_compare(orientation, acceleration)
    if rows is None:
        return None
    felt = acceleration[rows] / GRAVITY
    return rotation_from_quaternion(orientation[rows])[:, 2], felt


def _leans(name: str, log: MotionLog, orientation: Array) -> bool:
    """Whether up by the accelerometer contradicts an orientation (n, 4)."""
    both = _up_and_felt(name, log, orientation)
    if both is None:
        return False
    up, felt = both
    cosines = np.sum(up * felt, axis=1) / np.linalg.norm(felt, axis=1)
    return bool(np.median(cosines) < np.cos(UPRIGHT))


def _upside_down(name: str, log: MotionLog, orientation: Array) -> bool:
    """Whether the accelerometer leans against the orientation, or there is no telling: then it may be the wrong one."""
    both = _up_and_felt(name, log, orientation)
    if both is None:
        return True
    up, felt = (each - each.mean(axis=0) for each in both)
    return bool(np.sum(up * felt) < 0.5 * np.sum(up**2))
