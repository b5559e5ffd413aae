"""Gains of the torque channels: what the feet's torques must be for the robot to move as it does.

A torque that reads a tenth too large makes stiffness and damping a tenth too large, and nothing in a foot's own torque
and angle shows it. The whole body does: forces, torques and their places must give the moments of eq. 1's base rows.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy import special

from plantar.conventions import NORMAL95, ROTATIONAL_AXES, Array, Axis
from plantar.estimation.intervals import MOST_FREEDOM, cosine_covariance, pooled_freedom
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.moment_errors import (
    LEAST_GAIN,
    LOOSE,
    MomentErrors,
    moment_errors,
    prior_deviations,
)
from plantar.sensors.newton_euler import NewtonEulerResidual
from plantar.sensors.refined_delays import Each

APART = 2.0  # times the deviation of the feet's mean: a foot's gain known so well is judged by itself
STRAINED = 2.0  # deviations of its prior, beyond which a gain is looked for anew
ANOTHER_UNIT = 10.0  # share: kgf.m for N.m
CHANCE = 0.01  # that torques without a fault are called wrong about an axis, by deviations that are on the safe side
REVERSED = -1.5  # share: a torque of the wrong sign reads 200 % too little
WORTH_SAYING = 0.03  # share: what the force sensors' makers promise is seldom better


class TorqueGain(NamedTuple):
    """By which share the feet's torques about an axis read too much on average, with its deviation, and each foot's.

    apart: whether each foot's is known about as well as the mean. Where both feet turn alike it is known far worse.
    """

    mean: float
    std: float
    shares: Mapping[str, float]
    apart: bool = False

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
    robot: RobotModel, residuals: Sequence[NewtonEulerResidual], stepping: Collection[str], each: Each = map
) -> dict[Axis, TorqueGain]:
    """The torques' gains about each axis about which the moments do not balance with gains as they should be.

    A generalised least-squares fit of what Newton's law misses to each foot's torques, beside the forces' gains and
    places, which may be off by what the robot file says; the deviation holds coloured noise and a wrong URDF.

    stepping: names of the logs in which feet step. `each` maps a function over logs: a pool's map uses all cores.
    """
    steps, feet = [one.pair.label in stepping for one in residuals], len(robot.feet)
    logs = [one for one in each(partial(moment_errors, robot), residuals, steps) if one.columns.size]
    if not logs:
        return {}
    prior = prior_deviations(robot)
    values, parts = solved(logs, prior)
    if np.abs(values[: 2 * feet]).max() > STRAINED * LOOSE:
        # Only another unit is so far off: the prior that keeps a gain from passing for other errors would hide it.
        prior[: 2 * feet] = ANOTHER_UNIT
        values, parts = solved(logs, prior)
    usual = max(robot.uncertainty.wrench_gain, LEAST_GAIN)
    parts.append(_Part(usual**2 * np.eye(len(values)), MOST_FREEDOM))
    mean = _mean_gains(np.sum([part.covariance for part in parts], axis=0), feet)
    weights = np.vstack([mean, np.eye(2 * feet, len(values))])
    shares = weights @ values
    parts = [_Part(weights @ part.covariance @ weights.T, part.freedom) for part in parts]
    stds, axes = np.sqrt(np.sum([np.diag(part.covariance) for part in parts], axis=0)), len(ROTATIONAL_AXES)
    wrong = np.array([_is_wrong(shares, parts, [place]) for place in range(len(shares))])
    # Where the feet turn alike, what nothing explains passes for one foot's torques against the other's.
    apart = (stds[axes:].reshape(axes, feet) < APART * stds[:axes, None]).all(axis=1)
    about = wrong[:axes] | (apart & wrong[axes:].reshape(axes, feet).any(axis=1))
    # One foot's torques that are off about both axes show less about each than about both together.
    if not about.any():
        about[:] = _is_wrong(shares, parts, list(range(axes)))
    return {
        axis: TorqueGain(
            _share(shares[place]),
            float(stds[place]),
            {foot: _share(values[place * feet + number]) for number, foot in enumerate(robot.feet)},
            bool(apart[place]),
        )
        for place, axis in enumerate(ROTATIONAL_AXES)
        if about[place]
    }


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


def _is_wrong(values: Array, parts: Sequence[_Part], some: list[int]) -> bool:
    """Whether `some` values are worth saying, and larger than their covariance, the sum of `parts`, lets them be."""
    own = np.array([part.covariance[np.ix_(some, some)] for part in parts])
    weights = np.linalg.solve(own.sum(axis=0), values[some])
    count, variances = len(weights), np.einsum("i,kij,j->k", weights, own, weights)
    freedom = float(pooled_freedom(variances[:, None], np.array([[part.freedom] for part in parts]))[0])
    limit = count * float(special.fdtri(count, max(freedom - count, 2), 1 - CHANCE))
    return (
        bool(weights @ values[some] > limit) and max(abs(_share(values[one])) for one in some) > WORTH_SAYING
    )


def _share(missing: float) -> float:
    """By which share a torque reads too much that must be larger by the share `missing`."""
    return float(-missing / (1 + missing))


def torque_gain_notes(gains: Mapping[Axis, TorqueGain]) -> dict[Axis, Note]:
    """A warning for each axis about which the feet's torques cannot be right."""
    notes = {}
    for axis, found in gains.items():
        opposite = any(share < REVERSED for share in found.shares.values())
        if found.apart or opposite:
            feet = " and ".join(f"{foot} {100 * share:+.0f} %" for foot, share in found.shares.items())
            read = f"they read too much by {feet}"
        else:
            read = (
                f"they read {100 * found.mean:+.0f} ± {100 * NORMAL95 * found.std:.0f} % too much on average of the "
                f"feet (95 %; one foot's alone by up to {100 * found.reach:.0f} %)"
            )
        text = (
            f"{axis}: the feet's torques do not give the moments that the robot's motion needs: {read}, and stiffness "
            f"and damping follow them. Check {'sign, ' * opposite}unit and calibration of the torque channels"
        )
        notes[axis] = Note("torque_gain", "warning", text)
    return notes


def _positive(products: Array) -> Array:
    """The nearest products (k, k) that real columns can have: noise taken off may leave less than nothing."""
    sizes, vectors = np.linalg.eigh(products)
    return np.asarray((vectors * np.maximum(sizes, 0.0)) @ vectors.T)


def _weights(logs: Sequence[MomentErrors], left: Sequence[Array]) -> list[Array]:
    """Of each log's rows, (6,), by what logs of its kind have `left` (6, n): standing and walking miss differently."""
    power = {
        kind: np.mean(
            np.hstack([own for own, log in zip(left, logs, strict=True) if log.independent == kind]) ** 2,
            axis=1,
        )
        for kind in {log.independent for log in logs}
    }
    return [np.asarray(log.independent / power[log.independent]) for log in logs]


def solved(logs: Sequence[MomentErrors], prior: Array) -> tuple[Array, list[_Part]]:
    """Coefficients (k,) of the columns, and their covariance: of priors, noise and wrong URDFs.

    prior: (k,), their deviations before the moments are asked.
    """
    values: Array = np.zeros(len(prior))
    known = np.diag(prior**-2.0)
    for _ in range(2):  # weights from what is left, then the coefficients once more
        weights = _weights(logs, [log.missing - values @ log.columns for log in logs])
        both = np.sum(
            [np.tensordot(own, log.products, 1) for own, log in zip(weights, logs, strict=True)], axis=0
        )
        normal = _positive(both[1:, 1:]) + known
        values = np.asarray(np.linalg.solve(normal, both[1:, 0]))
    inverse, scatter, cosines = np.linalg.inv(normal), 0 * known, 0
    wrong = np.zeros((len(prior), logs[0].drawn.shape[2]))
    for weight, log in zip(weights, logs, strict=True):
        missed = log.missing - values @ log.columns
        scores = np.sum(log.columns * (weight[:, None] * missed)[:, None], axis=0).T
        own, freedom = cosine_covariance(scores, len(scores) * log.period)
        scatter, cosines = scatter + own, cosines + freedom
        wrong += np.tensordot(weight, log.drawn, 1)
    moved = inverse @ wrong
    draws = max(moved.shape[1], 1)
    return values, [
        _Part(inverse @ known @ inverse, MOST_FREEDOM),
        _Part(inverse @ scatter @ inverse, cosines),
        _Part(moved @ moved.T / draws, draws),
    ]
