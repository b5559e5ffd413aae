"""What one log's rows of Newton's law miss and the columns that may explain it, multiplied with each other."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.robot.model import RobotModel
from plantar.sensors.load_errors import APART
from plantar.sensors.moments.elimination import Beside, beside, coefficients
from plantar.sensors.moments.law_rows import BAND, QUICKER, law_rows
from plantar.sensors.moments.sensor_errors import ANOTHER_UNIT, prior_deviations, zero_deviations
from plantar.sensors.newton_euler import CUTOFF, NewtonEulerResidual
from plantar.signals.filters import gain

KEPT_PER_BAND = 5.0  # samples for each period of BAND: far above what has passed the filter
PARTS = 8  # of a log, as long as each other: what fits without one of them says how well it is known


class MomentErrors(NamedTuple):
    """What all rows of one log say together.

    `products` (parts, k + 1, k + 1): of what is missing, then the columns of sensors and links, in each part of the
    log, beside its zeros. `power` (k + 1, k + 1): their means over all samples and rows, with the sensors' noise, in
    what a fit to this log alone leaves of a row. `zeros` (z, k + 1): how many deviations of each of its zeros are
    taken off each of them.
    """

    products: Array
    power: Array
    zeros: Array


class RowProducts(NamedTuple):
    """What each row of one log says.

    `products`, (parts, c + 1, c + 1) of each row: of what is missing and its columns in each part of the log, without
    what the sensors' noise adds to them. `power` (rows, c + 1, c + 1): their means over all samples, with it. `share`:
    of a sample, that counts as an independent one. `zeros` (z,): deviations of the log's own zeros, which are the last
    columns: at an arm that moves with the robot, a zero does not stay a constant.
    """

    products: list[Array]
    power: Array
    share: float
    zeros: Array


def moment_errors(robot: RobotModel, residual: NewtonEulerResidual, steps: bool) -> MomentErrors:
    """Of one log in which Newton's law closes; `steps`: whether feet step in it."""
    # Gains as free as they may be: a row that another unit alone explains is no bad row.
    return weighed(row_products(robot, residual, steps), prior_deviations(robot, ANOTHER_UNIT))


def row_products(robot: RobotModel, residual: NewtonEulerResidual, steps: bool) -> RowProducts:
    """Of one log in which Newton's law closes; `steps`: whether feet step in it."""
    products, power, share = [], [], 0.0
    for row in law_rows(robot, residual, steps):
        stride = 1 if steps else max(1, round(1 / (KEPT_PER_BAND * BAND * row.period)))
        own = row.signals[::stride]
        products.append(_products(own))
        power.append(products[-1].sum(axis=0) / len(own))
        if not steps:
            for factor, band in zip(_below_to_above(row.period) / stride, row.noise, strict=True):
                products[-1] -= factor * _products(band)
        share = stride * row.period / APART
    return RowProducts(products, np.array(power), share, zero_deviations(robot))


def weighed(rows: RowProducts, prior: Array) -> MomentErrors:
    """Rows by what a fit to this log alone leaves of each; prior (k,): deviations of the sensors' coefficients."""
    links = rows.power.shape[-1] - 1 - len(prior) - len(rows.zeros)
    own, shares = _beside_zeros(rows, rows.power[:, 0, 0])
    values = coefficients(own.sum(axis=0), np.append(prior, np.ones(links)))
    remains = np.append(1.0, -values)
    remains = np.append(remains, shares @ remains)
    left = np.einsum("rjk,j,k->r", rows.power, remains, remains)
    own, shares = _beside_zeros(rows, left)
    kept = np.vstack([np.eye(len(shares.T)), shares])
    power = kept.T @ np.mean(rows.power / left[:, None, None], axis=0) @ kept
    return MomentErrors(own, power, shares / rows.zeros[:, None])


def _beside_zeros(rows: RowProducts, left: Array) -> Beside:
    """Products of all rows, by what is `left` of each (rows,), mean squares, beside the log's own zeros."""
    weights = rows.share / left
    # Part by part: the products of all rows are the largest arrays of any log, and another of their size would be.
    parts = [
        np.sum([weight * own[part] for weight, own in zip(weights, rows.products, strict=True)], axis=0)
        for part in range(PARTS)
    ]
    return beside(parts, np.ones(PARTS), rows.zeros)


def _products(columns: NDArray[Any]) -> Array:
    """Of columns (n, k) with each other, in each part of the log, (parts, k, k)."""
    return np.array([part.T @ part for part in np.array_split(columns, PARTS)])


def _below_to_above(period: float) -> Array:
    """Factors (2,) of the power of noise above BAND, below and above QUICKER, that make its power below BAND.

    The feet's own readings are in the columns and in what is missing: their noise, multiplied with itself, would pass
    for arms of centimetres. Above BAND is hardly anything else. The noise of forces and IMU is white, that of
    encoders' accelerations grows with the fourth power of the frequency; the factors are right for both.
    """
    hertz = np.linspace(0.0, 0.5 / period, 2000)
    passed, slow, middle = (gain(hertz, period, cutoff) for cutoff in (CUTOFF, BAND, QUICKER))
    bands = passed * [slow, (1 - slow) * middle, (1 - slow) * (1 - middle)]
    below, *above = (bands**2) @ np.column_stack([np.ones_like(hertz), hertz**4])
    return np.linalg.solve(np.array(above).T, below)
