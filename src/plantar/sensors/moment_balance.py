"""Gains of the torque channels: what the feet's torques must be for the robot to move as it does.

A torque that reads a tenth too large makes stiffness and damping a tenth too large, and nothing in a foot's own torque
and angle shows it. The whole body does: forces, torques and their places must give the moments of eq. 1's base rows.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from scipy import special

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.dynamics import Contact, Equation
from plantar.estimation.intervals import MOST_FREEDOM, NORMAL95, cosine_covariance, pooled_freedom
from plantar.notes import Note
from plantar.robot.model import Foot, RobotModel
from plantar.sensors.newton_euler import BASE_ROWS, CUTOFF, SLOW, NewtonEulerResidual
from plantar.signals.filters import gain, low_pass

LOOSE = 0.3  # share: deviation of a torque's gain before the moments are asked
LEAST_GAIN = 0.01  # share, of the forces' gains and of what their places add: nuisances need a finite prior
LEAST_ARM = 0.003  # m, likewise
LEAST_BETWEEN = 0.001  # N.m/N, likewise
BAND = 2.0  # Hz: the robot moves below it, and most of the sensors' noise is above
LATE = 0.02  # s, of feet's sensors, encoders and gyroscope behind the accelerometer
MOUNT = 0.1  # rad, by which sensors and IMU may be turned: wide, so that no turned mount passes for a gain
CHANCE = 0.01  # that torques without a fault are called wrong about an axis, by deviations that are on the safe side
WORTH_SAYING = 0.03  # share: what the force sensors' makers promise is seldom better


class TorqueGain(NamedTuple):
    """By which share the feet's torques about an axis read too much on average, with its deviation, and each foot's.

    What belongs to which foot is known far worse than the mean: both feet turn alike.
    """

    mean: float
    std: float
    shares: Mapping[str, float]

    @property
    def reach(self) -> float:
        """By which share any foot's torque may be off: at most all that is missing is one foot's."""
        alone = len(self.shares) * (abs(self.mean) + NORMAL95 * self.std)
        return min(alone, max(map(abs, self.shares.values())))


class _Part(NamedTuple):
    """One part of a covariance, and the degrees of freedom that it is known with."""

    covariance: Array
    freedom: float


@dataclass(frozen=True)
class _Sides:
    """One log's columns (k, n, 6) and what they must add up to (n, 6); `drawn` (draws, n, 6): of a wrong URDF.

    Slower than BAND; `fast` (k + 1, n, 6) are what is missing and the columns above it.
    """

    columns: Array
    missing: Array
    drawn: Array
    fast: Array
    period: float


def torque_gains(robot: RobotModel, residuals: Sequence[NewtonEulerResidual]) -> dict[Axis, TorqueGain]:
    """The torques' gains about each axis about which the moments do not balance with gains as they should be.

    A generalised least-squares fit of what Newton's law misses to each foot's torques, beside the forces' gains and
    places, which may be off by what the robot file says; the deviation holds coloured noise and a wrong URDF.
    """
    if not residuals:
        return {}
    sides, feet = [_sides(robot, residual) for residual in residuals], len(robot.feet)
    values, parts = _solved(sides, _prior(robot))
    usual = max(robot.uncertainty.wrench_gain, LEAST_GAIN)
    parts.append(_Part(usual**2 * np.eye(len(values)), MOST_FREEDOM))
    mean = _mean_gains(np.sum([part.covariance for part in parts], axis=0), feet)
    means, parts = mean @ values, [_Part(mean @ part.covariance @ mean.T, part.freedom) for part in parts]
    stds = np.sqrt(np.sum([np.diag(part.covariance) for part in parts], axis=0))
    beyond = [_beyond_chance(means, parts, slice(place, place + 1)) for place in range(len(means))]
    # One foot's torques that are off about both axes show less about each than about both together.
    if max(beyond) <= 1:
        beyond = [_beyond_chance(means, parts, slice(None))] * len(means)
    return {
        axis: TorqueGain(
            _share(means[place]),
            float(stds[place]),
            {foot: _share(values[place * feet + number]) for number, foot in enumerate(robot.feet)},
        )
        for place, axis in enumerate(ROTATIONAL_AXES)
        if beyond[place] > 1 and abs(_share(means[place])) > WORTH_SAYING
    }


def _mean_gains(covariance: Array, feet: int) -> Array:
    """Weights (axes, k) by which coefficients make the feet's mean gain about each axis, with the least variance.

    How the gains of the feet differ is no part of it: both feet turn alike, so that a moment of a few newton-metres
    which nothing here explains passes for one foot's torques too large by half and the other's too small by half.
    """
    weights = np.zeros((len(ROTATIONAL_AXES), len(covariance)))
    for place, row in enumerate(weights):
        mine = slice(place * feet, (place + 1) * feet)
        best = np.linalg.solve(covariance[mine, mine], np.ones(feet))
        row[mine] = best / best.sum()
    return weights


def _beyond_chance(values: Array, parts: Sequence[_Part], some: slice) -> float:
    """How many times larger `some` values are than their covariance, the sum of `parts`, lets them be by chance."""
    own = np.array([part.covariance[some, some] for part in parts])
    weights = np.linalg.solve(own.sum(axis=0), values[some])
    count, variances = len(weights), np.einsum("i,kij,j->k", weights, own, weights)
    freedom = float(pooled_freedom(variances[:, None], np.array([[part.freedom] for part in parts]))[0])
    return (
        float(weights @ values[some])
        / count
        / float(special.fdtri(count, max(freedom - count, 2), 1 - CHANCE))
    )


def _share(missing: float) -> float:
    """By which share a torque reads too much that must be larger by the share `missing`."""
    return float(-missing / (1 + missing))


def torque_gain_notes(gains: Mapping[Axis, TorqueGain]) -> dict[Axis, Note]:
    """A warning for each axis about which the feet's torques cannot be right."""
    notes = {}
    for axis, found in gains.items():
        text = (
            f"{axis}: the feet's torques do not give the moments that the robot's motion needs: they read "
            f"{100 * found.mean:+.0f} ± {196 * found.std:.0f} % too much on average of the feet (95 %; one foot's "
            f"alone by up to {100 * found.reach:.0f} %), and stiffness and damping follow them. Check unit and "
            "calibration of the torque channels"
        )
        notes[axis] = Note("torque_gain", "warning", text)
    return notes


def _prior(robot: RobotModel) -> Array:
    """Deviations of the columns of `_sides`: gains of torques, each foot's other errors, turns of the IMU, delays."""
    feet = len(robot.feet)
    return np.concatenate(
        [
            np.full(2 * feet, LOOSE),
            np.tile(_sensor_errors(robot)[1], feet),
            np.full(3, MOUNT),
            np.full(feet + 2, LATE),
        ]
    )


def _sensor_errors(robot: RobotModel) -> tuple[Array, Array]:
    """What else a force sensor may get wrong: matrices (k, 6, 6) that act on what it reads, and their deviations (k,).

    The gain of all channels, the place along x, y and z, the turn about them, each channel's own gain and what one
    channel does to another; no torque reaches a force.
    """
    uncertainty = robot.uncertainty
    gain = max(uncertainty.wrench_gain, LEAST_GAIN)
    place = max(uncertainty.bush_position, LEAST_ARM)
    between = max(uncertainty.wrench_crosstalk, LEAST_BETWEEN)
    none, crosses = np.zeros((3, 3)), [pin.skew(axis) for axis in np.eye(3)]
    errors = [(np.eye(6), gain)]
    errors += [(np.block([[none, none], [cross, none]]), place) for cross in crosses]
    errors += [(np.block([[cross, none], [none, cross]]), MOUNT) for cross in crosses]
    for read, real in (pair for pair in np.ndindex(6, 6) if pair[0] >= 3 or pair[1] < 3):
        single = np.zeros((6, 6))
        single[read, real] = 1.0
        errors.append((single, gain if read == real else between))
    matrices, deviations = zip(*errors, strict=True)
    return np.array(matrices), np.array(deviations)


def _sides(robot: RobotModel, residual: NewtonEulerResidual) -> _Sides:
    pair, equation = residual.pair, Equation(robot.floating_model)
    gains: list[list[Array]] = [[], []]
    others: list[Array] = []
    for place, foot in enumerate(robot.feet.values()):
        wrench = residual.readings[:, 6 * place : 6 * place + 6]
        contact = Contact(*robot.frame(foot.wrench.placement))
        transfer = equation.contact_transfer(residual.motion.positions, contact)[:, BASE_ROWS]
        alone = np.zeros((2, 6, 6))
        alone[:, 3:, 3:] = [np.outer(along, along) for along in _directions(foot)]
        errors = np.concatenate([alone, _sensor_errors(robot)[0]])
        carried = np.einsum("nij,knj->kni", transfer, np.einsum("kij,nj->kni", errors, wrench))
        for own, column in zip(gains, carried[:2], strict=True):
            own.append(column)
        others += [*carried[2:]]
    read = [*gains[0], *gains[1], *others]
    late = [*residual.rates, residual.by_encoders, -residual.by_gyroscope]
    moving = _moving(np.stack([*read, *-residual.by_mount, *late, *pair.model_errors]), pair.period)
    every = np.concatenate([[pair.predicted - pair.measured], moving])
    slow, count = _low_passed(every, pair.period, BAND), len(every) - len(pair.model_errors)
    fast = (every - slow)[:count]
    fast[1 + len(read) :] = 0.0  # slopes are smooth: their noise is not white, and small below BAND
    return _Sides(slow[1:count], slow[0], slow[count:], fast, pair.period)


def _directions(foot: Foot) -> Array:
    """The bush's pitch and roll axes in the force sensor's frame, (2, 3)."""
    same = foot.bush.link == foot.wrench.placement.link
    turn = foot.wrench.placement.rotation.T @ foot.bush.rotation if same else np.eye(3)
    return np.asarray(turn.T[[1, 0]])


def _moving(columns: Array, period: float) -> Array:
    """Columns (k, n, 6) without what postures and drifting zeros do to them."""
    return columns - _low_passed(columns, period, SLOW)


def _low_passed(columns: Array, period: float, cutoff: float) -> Array:
    """Columns (k, n, 6) through a low-pass."""
    rows = columns.transpose(1, 0, 2).reshape(columns.shape[1], -1)
    return np.asarray(low_pass(rows, period, cutoff).reshape(len(rows), -1, 6).transpose(1, 0, 2))


def _products(side: _Sides, weights: Array) -> Array:
    """Products (k + 1, k + 1) of what is missing and the columns, without what the sensors' noise adds to them.

    The feet's own readings are in the columns and in what is missing: their noise, multiplied with itself, would pass
    for arms of centimetres. It is as large below BAND as it is above, where hardly anything else is.
    """
    slow = np.concatenate([[side.missing], side.columns])
    noise = _below_to_above(side.period) * np.einsum("inc,jnc,c->ij", side.fast, side.fast, weights)
    return np.asarray(np.einsum("inc,jnc,c->ij", slow, slow, weights) - noise)


def _below_to_above(period: float) -> float:
    """Power of white noise below BAND over that above it, behind the filters that both have passed."""
    hertz = np.linspace(0.0, 0.5 / period, 2000)
    passed, slow = (gain(hertz, period, cutoff) for cutoff in (CUTOFF, BAND))
    return float(np.sum((passed * slow) ** 2) / np.sum((passed * (1 - slow)) ** 2))


def _positive(products: Array) -> Array:
    """The nearest products (k, k) that real columns can have: noise taken off may leave less than nothing."""
    sizes, vectors = np.linalg.eigh(products)
    return np.asarray((vectors * np.maximum(sizes, 0.0)) @ vectors.T)


def _solved(sides: Sequence[_Sides], prior: Array) -> tuple[Array, list[_Part]]:
    """Coefficients of the columns, those of torques first, and their covariance: of priors, noise and wrong URDFs."""
    values, known = np.zeros(len(prior)), np.diag(prior**-2.0)
    for _ in range(2):  # weights from what is left, then the coefficients once more
        left = [side.missing - np.tensordot(values, side.columns, 1) for side in sides]
        # A filtered signal has two independent samples in a period of its cutoff.
        weights = 2 * BAND * sides[0].period / np.mean(np.vstack(left) ** 2, axis=0)
        both = np.sum([_products(side, weights) for side in sides], axis=0)
        normal = _positive(both[1:, 1:]) + known
        values[:] = np.linalg.solve(normal, both[1:, 0])
    inverse, scatter, cosines = np.linalg.inv(normal), 0 * known, 0
    moved: Array = np.zeros((len(prior), len(sides[0].drawn)))
    for side in sides:
        missed = side.missing - np.tensordot(values, side.columns, 1)
        scores = np.sum(side.columns * (missed * weights), axis=2).T
        own, freedom = cosine_covariance(scores, len(scores) * side.period)
        scatter, cosines = scatter + own, cosines + freedom
        if moved.size:
            weighted = (side.columns * weights).reshape(len(prior), -1)
            moved += inverse @ weighted @ side.drawn.reshape(len(side.drawn), -1).T
    draws = max(moved.shape[1], 1)
    return values, [
        _Part(inverse @ known @ inverse, MOST_FREEDOM),
        _Part(inverse @ scatter @ inverse, cosines),
        _Part(moved @ moved.T / draws, draws),
    ]
