"""Gains of the torque channels: what the feet's torques must be for the robot to move as it does.

A torque that reads a tenth too large makes stiffness and damping a tenth too large, and nothing in a foot's own torque
and angle shows it. The whole body does: forces, torques and their places must give the moments of eq. 1's base rows.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES, Array, Axis
from plantar.estimation.intervals import cosine_covariance, pooled_freedom
from plantar.estimation.quantiles import MOST_FREEDOM, fisher_quantile
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.moment_errors import (
    BAND,
    LEAST_GAIN,
    LOOSE,
    MomentErrors,
    moment_errors,
    prior_deviations,
)
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.sensors.refined_delays import Each

STRAINED = 2.0  # deviations of its prior, beyond which a gain is looked for anew
ANOTHER_UNIT = 10.0  # share: kgf.m for N.m
CHANCE = 0.01  # that torques without a fault are called wrong about an axis, by deviations that are on the safe side
BEYOND_STEPS = 0.4  # share: three times what steps were seen to make of a healthy robot's torques
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


def torque_gains(
    robot: RobotModel, residuals: Sequence[NewtonEulerResidual], each: Each = map
) -> dict[Axis, TorqueGain]:
    """The torques' gains about each axis about which the moments do not balance with gains as they should be.

    A generalised least-squares fit of what Newton's law misses to each foot's torques, beside the forces' gains and
    places, which may be off by what the robot file says; the deviation holds coloured noise and a wrong URDF.

    `each` maps a function over logs: a pool's map uses all cores.
    """
    if not residuals:
        return {}
    logs, feet = list(each(partial(moment_errors, robot), residuals)), len(robot.feet)
    prior = prior_deviations(robot)
    values, parts = solved(logs, prior)
    if np.abs(values[: 2 * feet]).max() > STRAINED * LOOSE:
        # Only another unit is so far off: the prior that keeps a gain from passing for other errors would hide it.
        prior[: 2 * feet] = ANOTHER_UNIT
        values, parts = solved(logs, prior)
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


def clear_gains(
    robot: RobotModel, residuals: Sequence[NewtonEulerResidual], stepping: Collection[str], each: Each = map
) -> dict[Axis, TorqueGain]:
    """`torque_gains` of the logs in which no foot steps; of others only gains as another unit makes them.

    Where feet land, what the model and the sampling of a blow get wrong comes again with every step, and passes for a
    gain: 13 % on a healthy walk of a simulated robot. stepping: names of the logs in which feet step.
    """
    standing = [one for one in residuals if one.pair.label not in stepping]
    if standing or not residuals:
        return torque_gains(robot, standing, each)
    gains = torque_gains(robot, residuals, each)
    return {axis: gain for axis, gain in gains.items() if abs(gain.mean) > BEYOND_STEPS}


def _mean_gains(covariance: Array, feet: int) -> Array:
    """Weights (axes, k) by which coefficients make the feet's mean gain about each axis, with the least variance.

    The mean, since the feet's difference is hardly known: both feet turn alike, so that a moment of a few newton-metres
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
    limit = fisher_quantile(1 - CHANCE, count, max(freedom - count, 2))
    return float(weights @ values[some]) / count / limit


def _share(missing: float) -> float:
    """By which share a torque reads too much that must be larger by the share `missing`."""
    return float(-missing / (1 + missing))


def torque_gain_notes(gains: Mapping[Axis, TorqueGain]) -> dict[Axis, Note]:
    """A warning for each axis about which the feet's torques cannot be right."""
    notes = {}
    for axis, found in gains.items():
        text = (
            f"{axis}: the feet's torques do not give the moments that the robot's motion needs: they read "
            f"{100 * found.mean:+.0f} ± {100 * NORMAL95 * found.std:.0f} % too much on average of the feet (95 %; one "
            f"foot's alone by up to {100 * found.reach:.0f} %), and stiffness and damping follow them. Check unit and "
            "calibration of the torque channels"
        )
        notes[axis] = Note("torque_gain", "warning", text)
    return notes


def _positive(products: Array) -> Array:
    """The nearest products (k, k) that real columns can have: noise taken off may leave less than nothing."""
    sizes, vectors = np.linalg.eigh(products)
    return np.asarray((vectors * np.maximum(sizes, 0.0)) @ vectors.T)


def solved(logs: Sequence[MomentErrors], prior: Array) -> tuple[Array, list[_Part]]:
    """Coefficients (k,) of the columns, and their covariance: of priors, noise and wrong URDFs.

    prior: (k,), their deviations before the moments are asked.
    """
    values: Array = np.zeros(len(prior))
    known = np.diag(prior**-2.0)
    for _ in range(2):  # weights from what is left, then the coefficients once more
        left = [log.missing - values @ log.columns for log in logs]
        # A filtered signal has two independent samples in a period of its cutoff.
        weights = 2 * BAND * logs[0].period / np.mean(np.hstack(left) ** 2, axis=1)
        both = np.tensordot(weights, np.sum([log.products for log in logs], axis=0), 1)
        normal = _positive(both[1:, 1:]) + known
        values = np.asarray(np.linalg.solve(normal, both[1:, 0]))
    inverse, scatter, cosines = np.linalg.inv(normal), 0 * known, 0
    for log in logs:
        missed = log.missing - values @ log.columns
        scores = np.sum(log.columns * (weights[:, None] * missed)[:, None], axis=0).T
        own, freedom = cosine_covariance(scores, len(scores) * log.period)
        scatter, cosines = scatter + own, cosines + freedom
    moved = inverse @ np.tensordot(weights, np.sum([log.drawn for log in logs], axis=0), 1)
    draws = max(moved.shape[1], 1)
    return values, [
        _Part(inverse @ known @ inverse, MOST_FREEDOM),
        _Part(inverse @ scatter @ inverse, cosines),
        _Part(moved @ moved.T / draws, draws),
    ]
