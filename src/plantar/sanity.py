"""Sensors that read something impossible: units, signs, orders and channels checked before anything is fitted."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from plantar.conventions import GRAVITY, rotation_from_quaternion
from plantar.log import MotionLog
from plantar.notes import Severity
from plantar.robot import RobotModel
from plantar.sanity_feet import swapped_feet

DEGREES = 180 / np.pi
WRONG_ANGLE = np.radians(25)  # between the accelerometer's up and the quaternion's: more is not noise
RIGHT_ANGLE = np.radians(8)


@dataclass(frozen=True)
class Finding:
    """Something odd in a log; `fatal` where no fit could be trusted."""

    code: str
    text: str
    fatal: bool = False
    severity: Severity = "warning"


def check_log(robot: RobotModel, log: MotionLog) -> list[Finding]:
    """Every finding about one log, in the order time, joints, IMU, wrenches."""
    return [*_time(log), *_joints(robot, log), *_imu(robot, log), *_wrenches(robot, log)]


def _time(log: MotionLog) -> Iterator[Finding]:
    if log.period >= 1.0:
        valid = "valid: seconds; divide milliseconds by 1000 and nanoseconds by 1e9"
        yield Finding("time_unit", f"column 'time': samples are {log.period:g} s apart; is it in another unit? ({valid})", True)


def _joints(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    model = robot.model
    for joint, name in enumerate(robot.joint_names, start=1):
        values = log.joint(name, "position")
        if values is None or not np.isfinite(values).any():
            continue
        lower, upper = (float(limit[model.idx_qs[joint]]) for limit in (model.lowerPositionLimit, model.upperPositionLimit))
        least, most = float(np.nanmin(values)), float(np.nanmax(values))
        bounded = model.nqs[joint] == 1 and np.isfinite([lower, upper]).all() and upper > lower
        revolute = "P" not in model.joints[joint].shortname().removeprefix("JointModel")[:1]
        if not bounded or not revolute:
            continue
        slack = 0.2 + 0.1 * (upper - lower)
        outside = least < lower - slack or most > upper + slack
        fits = least / DEGREES > lower - slack and most / DEGREES < upper + slack
        worst = most if most - upper > lower - least else least
        at = float(log.time[int(np.nanargmax(values if worst == most else -values))])
        where = f"column 'joint.{name}.position', t = {at:g} s, value {worst:.6g}"
        valid = f"valid: {lower:.4g} to {upper:.4g} rad"
        if outside and fits and max(abs(least), abs(most)) > 2 * np.pi:
            yield Finding("degrees", f"{where}: looks like degrees ({valid})", True)
        elif outside:
            yield Finding("joint_limit", f"{where}: beyond the URDF's limits ({valid})")


def _imu(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    if robot.imu is None:
        return
    name = robot.imu.name
    yield from _gyroscope(name, log)
    orientation = log.orientation(name)
    if orientation is None:
        return
    prefix = f"imu.{name}.orientation"
    norm = np.linalg.norm(orientation, axis=1)
    norm = norm[np.isfinite(norm)]
    if norm.size and (np.median(norm) < 0.9 or np.median(norm) > 1.1):
        text = f"columns '{prefix}.*': the quaternion's norm is {np.median(norm):.3g} (valid: 1)"
        yield Finding("quaternion_norm", text, True)
        return
    if not log.has(*(f"imu.{name}.linear_acceleration.{axis}" for axis in "xyz")):
        return
    acceleration = log.linear_acceleration(name)
    size = float(np.nanmedian(np.linalg.norm(acceleration, axis=1)))
    where = f"columns 'imu.{name}.linear_acceleration.*'"
    valid = f"valid: m/s², about {GRAVITY:.2f} at rest"
    if 0.8 < size < 1.2:
        yield Finding("accelerometer_unit", f"{where}: its norm is {size:.3g}, which looks like g ({valid})", True)
    elif not 0.6 * GRAVITY < size < 1.6 * GRAVITY:
        yield Finding("accelerometer_unit", f"{where}: its usual norm is {size:.3g} ({valid})")
    else:
        yield from _gravity_agrees(prefix, orientation, acceleration)


def _gyroscope(name: str, log: MotionLog) -> Iterator[Finding]:
    columns = [f"imu.{name}.angular_velocity.{axis}" for axis in "xyz"]
    if not log.has(*columns):
        return
    rates = log.stack(columns)
    orientation = log.orientation(name)
    for column, values in zip(columns, rates.T, strict=True):
        finite = values[np.isfinite(values)]
        if finite.size == 0 or (np.ptp(finite) == 0 and _moves(orientation)):
            yield Finding("dead_channel", f"column '{column}': never changes; is the channel dead?", True)
            return
    if orientation is None:
        return
    # The angle between samples half a second apart against the gyroscope's integral: a ratio near 57.3 is degrees.
    stride = max(1, round(0.5 / log.period))
    unit = orientation / np.linalg.norm(orientation, axis=1, keepdims=True)
    turned = 2 * np.arccos(np.clip(np.abs(np.sum(unit[stride:] * unit[:-stride], axis=1)), 0, 1))
    integral = np.linalg.norm(np.cumsum(np.nan_to_num(rates), axis=0)[stride:] - np.cumsum(np.nan_to_num(rates), axis=0)[:-stride], axis=1) * log.period  # noqa: E501
    moving = turned > np.radians(0.3)
    if moving.sum() < 20:
        return
    ratio = float(np.median(integral[moving] / turned[moving]))
    where = f"columns 'imu.{name}.angular_velocity.*'"
    if 30 < ratio < 110:
        text = f"{where}: {ratio:.0f} times the orientation's rate, which looks like degrees per second (valid: rad/s)"
        yield Finding("degrees", text, True)
    elif not 0.5 < ratio < 2:
        yield Finding("gyroscope_scale", f"{where}: {ratio:.2g} times the orientation's rate (valid: about 1)")


def _moves(orientation: np.ndarray | None) -> bool:  # type: ignore[type-arg]
    return orientation is not None and bool(np.nanmax(np.nanstd(orientation, axis=0)) > 1e-3)


def _gravity_agrees(prefix: str, orientation: np.ndarray, acceleration: np.ndarray) -> Iterator[Finding]:  # type: ignore[type-arg]
    """The quaternion's up against the accelerometer's; where they differ, which other order would agree."""
    whole = np.isfinite(np.column_stack([orientation, acceleration])).all(axis=1)
    if whole.sum() < 10:
        return
    rows = np.flatnonzero(whole)[:: max(1, int(whole.sum() // 2000))]
    up = acceleration[rows] / np.linalg.norm(acceleration[rows], axis=1, keepdims=True)

    def angle(quaternion: np.ndarray, inverse: bool = False) -> float:  # type: ignore[type-arg]
        rotation = rotation_from_quaternion(quaternion)
        world_up = rotation[:, :, 2] if inverse else rotation[:, 2, :]
        return float(np.median(np.arccos(np.clip(np.sum(world_up * up, axis=1), -1, 1))))

    as_is = angle(orientation[rows])
    if as_is < WRONG_ANGLE:
        return
    text = f"columns '{prefix}.*': up differs from the accelerometer's by {np.degrees(as_is):.0f} deg"
    rolled = np.roll(orientation[rows], 1, axis=1)
    if angle(rolled) < RIGHT_ANGLE:
        yield Finding("quaternion_order", f"{text}; read as x y z w it agrees (valid: w x y z)", True)
    elif angle(orientation[rows], inverse=True) < RIGHT_ANGLE:
        yield Finding("quaternion_order", f"{text}; inverted it agrees (valid: body to world)", True)
    else:
        yield Finding("attitude_mismatch", f"{text} (valid: w x y z, body to world, z up)", True)


def _wrenches(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    loads = {}
    for foot in robot.feet.values():
        sensor, vertical = foot.wrench, f"wrench.{foot.wrench.name}.force.z"
        wrench = log.wrench(sensor.name)
        if not np.isfinite(wrench).any():
            yield Finding("dead_channel", f"columns 'wrench.{sensor.name}.*': hold no value; the sensor is dead")
            continue
        # Along the bush's z axis, whatever way the sensor is mounted.
        axis = (foot.bush.rotation.T @ foot.wrench.placement.rotation)[2] if foot.bush.link == sensor.placement.link else None
        load = wrench[:, :3] @ axis * sensor.sign if axis is not None else wrench[:, 2] * sensor.sign
        loads[foot.name] = load
        usual = float(np.nanmedian(load))
        if foot.contact == "auto" and usual < -0.2 * robot.mass * GRAVITY:
            text = f"column '{vertical}', value {usual:.4g}: pulls the standing foot down"
            yield Finding("sign", f"{text} (valid: > 0; set 'sign: {-int(sensor.sign)}' in feet.{foot.name}.wrench)", True)
        loaded = np.nanmax(np.abs(wrench)) > 0.1 * robot.mass * GRAVITY or foot.contact == "always"
        for place, part in enumerate(f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"):
            values = wrench[np.isfinite(wrench[:, place]), place]
            if loaded and (values.size == 0 or np.ptp(values) == 0):
                yield Finding("dead_channel", f"column 'wrench.{sensor.name}.{part}': never changes; is the channel dead?")
    weight = robot.mass * GRAVITY
    automatic = bool(loads) and all(foot.contact == "auto" for foot in robot.feet.values())
    if automatic and len(loads) == len(robot.feet):
        carried = float(np.nanmedian(np.sum(list(loads.values()), axis=0)))
        if 0.07 < carried / weight < 0.14:
            text = f"columns 'wrench.*.force.z': the feet carry {carried:.4g}, which looks like kgf (valid: N, about {weight:.0f})"
            yield Finding("force_unit", text, True)
        elif swapped_feet(robot, log):
            text = "the feet's wrenches look swapped: exchanged, they balance gravity far better (check the sensors' names)"
            yield Finding("swapped_feet", text, True)
