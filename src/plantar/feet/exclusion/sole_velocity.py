"""How fast soles move over the floor, from the IMU: its acceleration, moved to the sole, integrated, less its drift.

All feet see one accelerometer, so one drift is told from all that stands, through the whole log.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from plantar.contact.deflection import BushState, onto_sole
from plantar.contact.phases import quick_part
from plantar.contact.slip_indicator import SLIP_CUTOFF, USUAL, usual_deviation
from plantar.conventions import Array, Mask, cross, rotated
from plantar.estimation.errors_in_variables import NORMAL
from plantar.estimation.velocity_drift import fit_drift
from plantar.feet.recording import Recording
from plantar.robot.model import RobotModel
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.medians import median
from plantar.signals.orientation import attitude, unit_quaternions
from plantar.signals.segments import complete, steps_in

DRIFT_RATE = 50.0  # Hz, enough for the drift
GYROSCOPE = 2.5  # Hz, above which an attitude's change is the gyroscope's: it is the quieter one there
LAG = 0.05  # s, in which neither drift nor slide changes much
SLOPE_TIME = 1.0  # s, in which the drift's slope changes by more than noise
LEAST_NOISE = 0.0002  # m/s: no IMU tells a sole's speed better
LEAST_WANDER = 0.0005  # m/s² in a second's root: no zero of an accelerometer wanders less
NEAR = 0.1  # s around a sample whose acceleration counts
MEDIAN = np.sqrt(2 * np.log(2))  # median length of a plane vector, in deviations of its components


@dataclass(frozen=True)
class SoleMotion:
    """`velocity`: (N, 2) by foot, of the sole in world axes [m/s], NaN where it is not known to stand flat;
    `deviation`: (N,) by foot, of either component [m/s]."""

    velocity: Mapping[str, Array]
    deviation: Mapping[str, Array]


def sole_motion(
    robot: RobotModel, recording: Recording, flat: Mapping[str, Mask], unrest: Array
) -> SoleMotion | None:
    """Velocities of the soles; None where the log has no accelerometer or no sole ever stands `flat`, (N,) each.

    unrest: (N,), what else says that soles move, as a square in usual deviations.

    Beside the drift, causes of constant size are taken off: a bush centre that the robot file has too high or too low
    (what follows the bush's rates), an IMU that is late (the acceleration), and an attitude filter that takes slow
    accelerations for tilt (the way).
    """
    orientation, acceleration, rates = _inertial(robot, recording)
    if acceleration is None:
        return None
    period = recording.period
    push = np.nan_to_num(low_pass(acceleration, period, SLIP_CUTOFF))
    shaking = quick_part(acceleration, period)
    noise_of_attitude = _attitude_noise(orientation, rates, period)
    moved, stands = {}, {}
    for foot, bush in recording.bushes.items():
        arm = np.column_stack([recording.places[foot], bush.sole_position[:, 2]])
        place = (arm - cross(noise_of_attitude, arm))[:, :2]
        moved[foot] = differentiate(low_pass(place, period, SLIP_CUTOFF), period)
        stands[foot] = flat[foot] & complete(moved[foot]) & complete(acceleration)
    count = np.sum(list(stands.values()), axis=0)
    if not count.any():
        return None
    share = {foot: np.asarray(stands[foot] / np.maximum(count, 1))[:, None] for foot in stands}
    mean = np.sum([share[foot] * np.nan_to_num(moved[foot]) for foot in stands], axis=0)
    gained = (np.cumsum(push, axis=0) - push / 2) * period
    causes = [push, np.cumsum(mean, axis=0) * period]
    for foot, bush in recording.bushes.items():
        causes += [share[foot] * cause for cause in _moment_arm_errors(bush)]
    seen = np.where((count > 0)[:, None], mean + gained, np.nan)
    drift, drift_deviation, noise = _drift(seen, np.array(causes), unrest, shaking, period)
    velocity = {
        foot: np.where(stands[foot][:, None], moved[foot] + gained - drift, np.nan) for foot in stands
    }
    strain = _mean_square(acceleration, period)
    deviation = {foot: _deviation(one, noise, drift_deviation, strain) for foot, one in velocity.items()}
    return SoleMotion(velocity, deviation)


def friction(recording: Recording, flat: Mapping[str, Mask]) -> Array:
    """The floor's horizontal force on the soles that stand over their load, (N, 2), in world axes."""
    total, load = np.zeros((len(recording.time), 2)), np.zeros(len(recording.time))
    for foot, bush in recording.bushes.items():
        along, across = onto_sole(bush.wrench[:, :3], *bush.deflection.T)[:, :2].T
        c, s = np.cos(bush.heading), np.sin(bush.heading)
        force = np.column_stack([c * along - s * across, s * along + c * across, bush.force_z])
        known = flat[foot] & complete(force)
        total += np.where(known[:, None], force[:, :2], 0.0)
        load += np.where(known, force[:, 2], 0.0)
    return np.asarray(total / np.where(load > 0, load, np.nan)[:, None])


def _inertial(robot: RobotModel, recording: Recording) -> tuple[Array, Array | None, Array]:
    """Unit quaternions (N, 4) of the IMU to the world, its horizontal acceleration (N, 2), and its rates (N, 3), in the
    world; no acceleration where the log has no accelerometer."""
    log, imu = recording.log, robot.imu
    assert imu is not None, "checked"
    orientation, rates = attitude(log, imu, [])
    unit = unit_quaternions(orientation)
    turned = rotated(unit, rates)
    if not log.has(*(f"imu.{imu.name}.linear_acceleration.{axis}" for axis in "xyz")):
        return unit, None, turned
    return unit, rotated(unit, log.linear_acceleration(imu.name))[:, :2], turned


def _attitude_noise(orientation: Array, rates: Array, period: float) -> Array:
    """Small rotations (N, 3) [rad], in the world, by which the attitude is off at more than GYROSCOPE: its steps are
    compared with the gyroscope's."""
    (w, axis), (before, axis_before) = (
        (one[:, :1], one[:, 1:]) for one in (orientation[1:], orientation[:-1])
    )
    turn = before * axis - w * axis_before - cross(axis, axis_before)
    step = 2 * np.sum(orientation[1:] * orientation[:-1], axis=1, keepdims=True) * turn
    excess = np.nan_to_num(step - period * (rates[1:] + rates[:-1]) / 2)
    off = np.vstack([np.zeros(3), np.cumsum(excess, axis=0)])
    return np.asarray(off - low_pass(off, period, GYROSCOPE))


def _moment_arm_errors(bush: BushState) -> tuple[Array, Array]:
    """How a sole seems to move, (N, 2) each, by pitch and by roll, where its bush centre's height is wrong."""
    c, s = np.cos(bush.heading), np.sin(bush.heading)
    pitch, roll = np.nan_to_num(bush.rate).T
    return np.column_stack([pitch * c, pitch * s]), np.column_stack([-roll * s, roll * c])


def _drift(
    seen: Array, causes: Array, unrest: Array, shaking: Array, period: float
) -> tuple[Array, Array, float]:
    """The drift (N, 2) in what is seen, its deviation (N,) and the noise of either component [m/s].

    How noisy it is and how fast its slope wanders is read off its differences, whose medians no slide moves. What the
    velocity may have lost between two samples is known from how it shakes.
    """
    lag = steps_in(LAG, period)
    noise = max(LEAST_NOISE, _usual(seen[lag:] - seen[:-lag]) / np.sqrt(2))
    far = steps_in(SLOPE_TIME, period)  # less than two of these show no slope that changes
    lost = np.einsum("ni,ni->n", shaking, shaking) / 2 * period**2
    bent = _usual(seen[2 * far :] - 2 * seen[far:-far] + seen[: -2 * far]) ** 2
    bent -= 6 * noise**2 + 2 * far * float(median(lost))
    wander = max(LEAST_WANDER**2, 1.5 * bent / (far * period) ** 3)
    step = steps_in(1 / DRIFT_RATE, period)
    places = np.arange(0, len(seen), step)
    jump = np.add.reduceat(lost, places)
    thinned = step * period
    independent = min(1.0, 2 * SLIP_CUTOFF * thinned)
    fit = fit_drift(
        seen[places], causes[:, places], unrest[places], jump, wander, noise, independent, thinned
    )
    every = np.arange(len(seen))
    value = np.column_stack([np.interp(every, places, fit.value[:, axis]) for axis in range(2)])
    return value, np.interp(every, places, fit.deviation), noise


def _usual(change: Array) -> float:
    """Deviation of either component of changes (n, 2) around their median, as most of them are."""
    known = change[complete(change)].T
    return NORMAL * float(median(np.abs(known - median(known)[:, None]).ravel())) if known.size else 0.0


def _mean_square(acceleration: Array, period: float) -> Array:
    """Mean square (N,) of the acceleration (N, 2) within NEAR [m²/s⁴]."""
    change = np.nan_to_num(acceleration - median(acceleration[complete(acceleration)].T))
    square = np.einsum("ni,ni->n", change, change)
    total, reach = np.concatenate([[0.0], np.cumsum(square)]), round(NEAR / period)
    place = np.arange(len(square))
    last, first = np.minimum(place + reach + 1, len(square)), np.maximum(place - reach, 0)
    return np.asarray((total[last] - total[first]) / (last - first))


def _deviation(velocity: Array, noise: float, of_drift: Array, strain: Array) -> Array:
    """Deviation (N,) of a velocity (N, 2): its noise, no less than what is usual, and the drift's; more where the robot
    is accelerated strongly, as far as its velocity is usually off there."""
    speed = np.hypot(*velocity.T)
    known = np.isfinite(speed)
    least = np.hypot(max(noise, usual_deviation(speed)), of_drift)
    if not known.any():
        return np.asarray(least)
    strong = known & (strain > np.percentile(strain[known], USUAL))
    if not strong.any():
        return np.asarray(least)
    grows = float(median(((speed / MEDIAN) ** 2 - least**2)[strong] / strain[strong]))
    return np.sqrt(least**2 + max(grows, 0.0) * strain)
