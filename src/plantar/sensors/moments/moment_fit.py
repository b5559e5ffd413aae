"""Newton's law of all logs together, solved for what each sensor may get wrong.

A generalised least-squares fit of what the law misses to the columns of `sensor_errors`, which may be as large as the
robot file says, and to what a URDF may get wrong. Its covariance holds coloured noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import GRAVITY, ROTATIONAL_AXES, Array
from plantar.estimation.quantiles import MOST_FREEDOM, fisher_quantile
from plantar.estimation.residual_covariance import pooled_freedom
from plantar.robot.model import RobotModel
from plantar.sensors.moments.elimination import beside, coefficients, information
from plantar.sensors.moments.moment_errors import MomentErrors
from plantar.sensors.moments.sensor_errors import (
    ANOTHER_UNIT,
    LOOSE,
    STIFF,
    compliance_columns,
    prior_deviations,
)

STRAINED = 2.0  # deviations of its prior and its own, beyond which a gain is of another unit
# Share of a torque, which landings behind filters of unlike sensors make of it in every step of a simulated walk: all
# parts of a walk agree in it.
LANDINGS = 0.01
LANDINGS_BEND = 0.006  # rad, likewise: how far they seem to bend each joint with the robot's weight at 1 m
CHANCE = 0.01  # that sensors without a fault are called wrong, by deviations that are on the safe side


class Part(NamedTuple):
    """One part of a covariance, and the degrees of freedom that it is known with."""

    covariance: Array
    freedom: float


class MomentFit(NamedTuple):
    """Coefficients `values` (k,) of the sensors' columns; `parts` of their covariance: of priors and of noise."""

    values: Array
    parts: list[Part]


def moments_of(
    robot: RobotModel, logs: Sequence[MomentErrors], steps: bool, bending: float = STIFF
) -> MomentFit | None:
    """The fit over what each log tells, None without one; `steps`: whether feet step in some; `bending`: as of
    `prior_deviations`."""
    if not logs:
        return None
    fit = solved(logs, prior_deviations(robot, bending=bending))
    # Only another unit is so far off: the prior that keeps a gain from passing for other errors would hide it.
    free = solved(logs, prior_deviations(robot, ANOTHER_UNIT, STIFF))
    if _far_off(free, len(robot.feet)):
        fit = free
    if steps:
        alike = np.zeros(len(fit.values))
        alike[: 2 * len(robot.feet)] = LANDINGS**2
        alike[compliance_columns(robot)] = (LANDINGS_BEND / (robot.mass * GRAVITY)) ** 2
        fit = MomentFit(fit.values, [*fit.parts, Part(np.diag(alike), MOST_FREEDOM)])
    return fit


def _far_off(fit: MomentFit, feet: int) -> bool:
    """Whether the feet's mean gain about an axis is certainly larger than a fault of an amplifier."""
    mean = np.kron(np.eye(len(ROTATIONAL_AXES)), np.full(feet, 1 / feet))
    gains = slice(len(ROTATIONAL_AXES) * feet)
    variance = np.sum([np.diag(mean @ part.covariance[gains, gains] @ mean.T) for part in fit.parts], axis=0)
    return bool((np.abs(mean @ fit.values[gains]) > STRAINED * (LOOSE + np.sqrt(variance))).any())


def is_wrong(values: Array, parts: Sequence[Part], some: list[int]) -> bool:
    """Whether `some` values are larger than their covariance, the sum of `parts`, lets them be by chance."""
    own = np.array([part.covariance[np.ix_(some, some)] for part in parts])
    weights = np.linalg.solve(own.sum(axis=0), values[some])
    count, variances = len(weights), np.einsum("i,kij,j->k", weights, own, weights)
    freedom = float(pooled_freedom(variances[:, None], np.array([[part.freedom] for part in parts]))[0])
    limit = count * fisher_quantile(1 - CHANCE, count, max(freedom - count, 2))
    return bool(weights @ values[some] > limit)


def solved(logs: Sequence[MomentErrors], prior: Array) -> MomentFit:
    """The fit with deviations (k,) of the sensors' coefficients before the moments are asked, `prior`."""
    links = logs[0].products.shape[-1] - 1 - len(prior)  # of the one robot of all logs
    each = [part for log in logs for part in log.products]
    left = np.array([log.power[0, 0] for log in logs])
    for _ in range(2):  # a robot that a hand steadies misses more than one that stands alone
        weights = np.repeat(1 / left, [len(log.products) for log in logs])
        parts, shares = beside(each, weights, np.ones(links))
        both = parts.sum(axis=0)
        values = coefficients(both, prior)
        remains = np.append(1.0, -values)
        remains = np.append(remains, shares @ remains)
        left = np.array([remains @ log.power @ remains for log in logs])
    without = np.array([coefficients(both - part, prior) for part in parts])
    apart = without - without.mean(axis=0)
    # What may be wrong by a deviation each: sensors, links, each log's zeros, as shares of the sensors' coefficients.
    wrong = [np.diag(1 / prior), shares[:, 1:]]
    wrong += [(log.zeros @ np.vstack([np.eye(len(both)), shares]))[:, 1:] for log in logs]
    moved = np.linalg.solve(information(both, prior), np.concatenate(wrong).T)
    covariances = [
        Part(moved @ moved.T, MOST_FREEDOM),
        # The jackknife: so many columns follow the noise of the few frequencies at which a robot sways that what they
        # leave of it tells too little.
        Part((len(parts) - 1) / len(parts) * (apart.T @ apart), len(parts) - 1),
    ]
    return MomentFit(values, covariances)
