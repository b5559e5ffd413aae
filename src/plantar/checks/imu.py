"""An IMU that reads something impossible: units, the quaternion's order and sense, dead channels."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from plantar.conventions import GRAVITY, Array, Mask
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.segments import longest_run

WRONG_ANGLE = np.radians(25)  # between the accelerometer's up and the quaternion's: more is not noise
RIGHT_ANGLE = np.radians(8)
WINDOW = 0.5  # s over which the orientation's turn is compared with the gyroscope's integral
LEAST_TURN = np.radians(0.5)  # in one window: smaller ones hold noise
FEWEST_WINDOWS = 20
WRONG_TURN, RIGHT_TURN = 0.8, 0.3  # difference of the two turns over the turn itself
LATE, SURE, EXPLAINED = 0.005, 6.0, 0.1  # s, deviations, share: of a delay between gyroscope and orientation
BAND = 8.0  # Hz, in which it is looked for
REVERSED = -0.9  # correlation, and slope within a factor of two, of an axis that reads the opposite


def check_imu(name: str, log: MotionLog) -> Iterator[Finding]:
    """Findings about one IMU's columns."""
    gyroscope = [f"imu.{name}.angular_velocity.{axis}" for axis in "xyz"]
    orientation = log.orientation(name)
    if log.has(*gyroscope):
        yield from _dead_channels(log, gyroscope, orientation)
    accelerometer = [f"imu.{name}.linear_acceleration.{axis}" for axis in "xyz"]
    problem = _accelerometer_size(name, log) if log.has(*accelerometer) else None
    if problem is not None:
        yield problem
    if orientation is None:
        return
    norm = np.linalg.norm(orientation, axis=1)
    columns = f"columns 'imu.{name}.orientation.*'"
    if not np.isfinite(norm).any():
        yield Finding("dead_channel", f"{columns}: hold no value (valid: leave the columns out)", True)
        return
    usual = float(np.nanmedian(norm))
    if not 0.9 < usual < 1.1:
        yield Finding("quaternion_norm", f"{columns}: the quaternion's norm is {usual:.3g} (valid: 1)", True)
        return
    orientation = np.where(norm[:, None] > 0.5, orientation, np.nan)
    if log.has(*gyroscope):
        yield from _gyroscope_agrees(name, log, orientation)
    if log.has(*accelerometer) and problem is None:
        yield from _accelerometer_agrees(name, log, orientation)


def _dead_channels(log: MotionLog, columns: list[str], orientation: Array | None) -> Iterator[Finding]:
    whole = orientation[np.isfinite(orientation).all(axis=1)] if orientation is not None else np.zeros((0, 4))
    moves = len(whole) > 0 and bool(np.max(np.std(whole, axis=0)) > 1e-3)
    for column in columns:
        values = log.column(column)
        finite = values[np.isfinite(values)]
        if finite.size == 0 or (moves and np.ptp(finite) == 0):
            yield Finding("dead_channel", f"column '{column}': never changes; is the channel dead?", True)


def _readings(orientation: Array) -> dict[str, Rotation]:
    """The orientation body to world as the columns say, and as other conventions would fill them."""
    as_is = Rotation.from_quat(orientation, scalar_first=True)
    return {
        "as it is": as_is,
        "read as x y z w": Rotation.from_quat(orientation),
        "inverted": as_is.inv(),
    }


def _misread(name: str, text: str, reading: str) -> Finding:
    valid = "w x y z" if reading == "read as x y z w" else "body to world"
    return Finding(
        "quaternion_order",
        f"columns 'imu.{name}.orientation.*': {text}; {reading} it agrees (valid: {valid})",
        True,
    )


def _gyroscope_agrees(name: str, log: MotionLog, orientation: Array) -> Iterator[Finding]:
    """How far the orientation turns in a window against the gyroscope's integral: size first, then direction."""
    rates = log.angular_velocity(name)
    stride = max(1, round(WINDOW / log.period))
    if len(log) < 2 * stride:
        return
    total = np.vstack(
        [np.zeros(3), np.cumsum((rates[1:] + rates[:-1]) / 2 * np.diff(log.time)[:, None], axis=0)]
    )
    starts = np.arange(0, len(log) - stride, max(1, stride // 5))
    whole = np.isfinite(
        np.column_stack(
            [total[starts + stride] - total[starts], orientation[starts], orientation[starts + stride]]
        )
    )
    starts = starts[whole.all(axis=1)]
    if starts.size == 0:
        return
    integral = total[starts + stride] - total[starts]
    before, after = _readings(orientation[starts]), _readings(orientation[starts + stride])
    turns = {reading: (before[reading].inv() * after[reading]).as_rotvec() for reading in before}
    size = np.linalg.norm(turns["as it is"], axis=1)
    moving = size > LEAST_TURN
    if moving.sum() < FEWEST_WINDOWS:
        return
    ratio = float(np.median(np.linalg.norm(integral[moving], axis=1) / size[moving]))
    where = f"columns 'imu.{name}.angular_velocity.*'"
    if 30 < ratio < 110:
        text = f"{where}: {ratio:.0f} times the orientation's rate, which looks like degrees per second (valid: rad/s)"
        yield Finding("degrees", text, True)
        return
    if not 0.5 < ratio < 2:
        yield Finding(
            "gyroscope_scale", f"{where}: {ratio:.2g} times the orientation's rate (valid: about 1)"
        )
        return
    if not _upside_down(name, log, orientation):
        opposite = _reversed_axes(integral, turns["as it is"])
        if opposite:
            names = " and ".join(f"'imu.{name}.angular_velocity.{axis}'" for axis in opposite)
            text = f"column {names}: turns against the orientation, which the accelerometer's up does not contradict"
            yield Finding("sign", f"{text} (valid: right-handed about the IMU's axes)", True)
            return
    yield from _late(name, log, orientation)
    apart = {
        reading: float(np.median(np.linalg.norm(turn[moving] - integral[moving], axis=1) / size[moving]))
        for reading, turn in turns.items()
    }
    best = min(apart, key=apart.__getitem__)
    if apart["as it is"] < WRONG_TURN:
        return
    if apart[best] < RIGHT_TURN:
        yield _misread(name, "turns another way than the gyroscope", best)
    else:
        text = f"{where}: turns about other axes than the orientation (valid: both in the IMU's own frame)"
        yield Finding("gyroscope_frame", text)


def _late(name: str, log: MotionLog, orientation: Array) -> Iterator[Finding]:
    """Whether orientation and gyroscope tell of the same turn at different times: rates and angles then disagree."""
    period, edge = log.period, round(0.5 / log.period)
    rates = log.angular_velocity(name)
    whole: Mask = np.asarray(np.isfinite(np.column_stack([orientation, rates])).all(axis=1))
    whole[1:] &= np.diff(log.time) < 1.5 * period
    run = longest_run(whole)
    if run.stop - run.start < 10 * edge:
        return
    attitude = Rotation.from_quat(orientation[run], scalar_first=True)
    turned = (attitude[:-1].inv() * attitude[1:]).as_rotvec() / period
    measured = (rates[run][1:] + rates[run][:-1]) / 2
    apart = low_pass(measured - turned, period, BAND)[edge:-edge]
    change = differentiate(low_pass(measured, period, BAND), period)[edge:-edge]
    apart = apart - apart.mean(axis=0)
    power, total = float(np.sum(change**2)), float(np.sum(apart**2))
    if power == 0 or total == 0:
        return
    late = -float(np.sum(apart * change)) / power
    left = float(np.sum((apart + late * change) ** 2))
    deviation = np.sqrt(left / power / (6 * BAND * period * len(apart)))
    if abs(late) > max(LATE, SURE * deviation) and left < (1 - EXPLAINED) * total:
        later, other = ("gyroscope", "orientation") if late > 0 else ("orientation", "gyroscope")
        text = f"columns 'imu.{name}.*': the {later} is {1e3 * abs(late):.0f} ms behind the {other} in this motion"
        cause = "late, or filtered towards the accelerometer; damping is less sure"
        yield Finding("imu_late", f"{text}: {cause} (valid: both of one moment)")


def _reversed_axes(integral: Array, turn: Array) -> str:
    """The gyroscope's axes that read the opposite; none where one axis agrees with nothing, as in another frame."""
    opposite = ""
    for axis, integrated, turned in zip("xyz", integral.T, turn.T, strict=True):
        if (np.abs(turned) > LEAST_TURN).sum() < FEWEST_WINDOWS:
            continue
        apart = float(np.std(integrated) * np.std(turned))
        alike = float(np.mean((integrated - integrated.mean()) * (turned - turned.mean()))) / max(
            apart, 1e-12
        )
        slope = float(integrated @ turned / (turned @ turned))
        if alike < REVERSED and -2 < slope < -0.5:
            opposite += axis
        elif not alike > -REVERSED:
            return ""
    return opposite


def _upside_down(name: str, log: MotionLog, orientation: Array) -> bool:
    """Whether the accelerometer leans against the orientation, or there is no telling: then it may be the wrong one."""
    columns = [f"imu.{name}.linear_acceleration.{axis}" for axis in "xyz"]
    if not log.has(*columns):
        return True
    acceleration = log.linear_acceleration(name)
    whole = np.flatnonzero(np.isfinite(np.column_stack([orientation, acceleration])).all(axis=1))
    if whole.size < 10:
        return True
    rows = whole[:: max(1, whole.size // 2000)]
    up = Rotation.from_quat(orientation[rows], scalar_first=True).inv().apply(np.array([0.0, 0.0, 1.0]))
    felt = acceleration[rows] / GRAVITY
    up, felt = up - up.mean(axis=0), felt - felt.mean(axis=0)
    return bool(np.sum(up * felt) < 0.5 * np.sum(up**2))


def _accelerometer_size(name: str, log: MotionLog) -> Finding | None:
    """Whether the accelerometer's usual norm is gravity's."""
    norm = np.linalg.norm(log.linear_acceleration(name), axis=1)
    where = f"columns 'imu.{name}.linear_acceleration.*'"
    valid = f"valid: m/s², about {GRAVITY:.2f} at rest"
    if not np.isfinite(norm).any() or np.nanmax(norm) == 0:
        return Finding("dead_channel", f"{where}: hold no value ({valid})", log.orientation(name) is None)
    size = float(np.nanmedian(norm))
    if 0.8 < size < 1.2:
        return Finding(
            "accelerometer_unit", f"{where}: its norm is {size:.3g}, which looks like g ({valid})", True
        )
    if not 0.6 * GRAVITY < size < 1.6 * GRAVITY:
        return Finding("accelerometer_unit", f"{where}: its usual norm is {size:.3g} ({valid})")
    return None


def _accelerometer_agrees(name: str, log: MotionLog, orientation: Array) -> Iterator[Finding]:
    """The accelerometer's up against the quaternion's."""
    acceleration = log.linear_acceleration(name)
    whole = np.flatnonzero(np.isfinite(np.column_stack([orientation, acceleration])).all(axis=1))
    if whole.size < 10:
        return
    rows = whole[:: max(1, whole.size // 2000)]
    up = acceleration[rows] / np.linalg.norm(acceleration[rows], axis=1, keepdims=True)
    apart = {
        reading: float(np.median(np.arccos(np.clip(rotation.apply(up)[:, 2], -1, 1))))
        for reading, rotation in _readings(orientation[rows]).items()
    }
    best = min(apart, key=apart.__getitem__)
    if apart["as it is"] < WRONG_ANGLE:
        return
    text = f"up differs from the accelerometer's by {np.degrees(apart['as it is']):.0f} deg"
    if apart[best] < RIGHT_ANGLE:
        yield _misread(name, text, best)
    else:
        full = f"columns 'imu.{name}.orientation.*': {text} (valid: w x y z, body to world, z up)"
        yield Finding("attitude_mismatch", full, True)
