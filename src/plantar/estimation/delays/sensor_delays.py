"""Delays of several sensors beside each other, where one delay common to all may not do.

Newton's law closes when every sensor is read at its own moment: what is missing of it at the moments recorded is, to
first order, each sensor's delay times how the balance changes with it. The common delay has its own estimate
(`estimation/delays/delay.py`); this one is for telling sensors apart, and for their delays where they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from plantar.conventions import ROUNDING, Array
from plantar.estimation.delays.bands import Band, bands_of
from plantar.estimation.delays.delay import GAIN_BAND, LEAST_EXPLAINED, MODEL_ERROR
from plantar.estimation.residual_covariance import score_cosines

ROUNDS = 3  # of weighing cells by what the solution leaves of them
FEWEST_CELLS = 6  # axes in bands that must close


@dataclass(frozen=True)
class Balance:
    """Newton's law of one recording over six axes: `predicted` (n, 6) less the sum of `measured` (sensors, n, 6).

    `by_delay` (delays, n, 6) is how that difference grows with each sensor's delay [per s]. Evenly sampled, without
    NaN, equally filtered. `model_errors` (draws, n, 6), `known`: as in `Pair`.
    """

    predicted: Array
    measured: Array
    by_delay: Array
    period: float
    model_errors: Array = field(default_factory=lambda: np.zeros((0, 0, 6)))
    known: Sequence[Band] | None = None

    @cached_property
    def bands(self) -> Sequence[Band]:
        """The balance in each band of frequencies, once it was asked for."""
        if self.known is not None:
            return self.known
        return bands_of(self.predicted, self.measured, self.by_delay, self.period, self.model_errors)

    @cached_property
    def cells(self) -> list[_Cell]:
        """Every axis in every band that closes, once they were asked for."""
        return [cell for band in self.bands for cell in _cells(band)]


@dataclass(frozen=True)
class _Cell:
    """One axis in one band: the `products` (delays + 1 + draws, the same) of how what is missing grows with each delay,
    of what is missing, and of what drawn models would make of it, gains of prediction and sensors taken off.

    `floor`: squares of the model's own error; `freedom`: how many independent values the axis has in the band.
    """

    products: Array
    floor: float
    freedom: float
    band: Band
    axis: int

    def scores(self, values: Array) -> Array:
        """How each moment's miss pulls at the delays (delays,) that are found, by its lowest cosines, (m, delays)."""
        gains, late = self.band.signals[self.axis, : self.band.sensors], self.band.late
        signals = self.band.signals[self.axis, late.start :]
        signals = signals - np.linalg.lstsq(gains.T, signals.T, rcond=ROUNDING)[0].T @ gains
        columns, missing = signals[:-1], signals[-1]
        return score_cosines((columns * (missing - values @ columns)).T, self.band.duration)


@dataclass(frozen=True)
class Delays:
    """`values` (delays,) [s], > 0: late; their `covariance`; `cells` took part, by their `weights`: the
    delays' scores, so weighted, times `inverse` are what moves them."""

    values: Array
    covariance: Array
    cells: int
    weights: Array
    inverse: Array

    def through_time(self, balances: Sequence[Balance]) -> Array:
        """What delays that change through the logs add to `covariance`, of the same balances: they move all cells of a
        log together, which do not disagree then."""
        middle, weights = np.zeros_like(self.inverse), iter(self.weights)
        for balance in balances:
            if own := [next(weights) * cell.scores(self.values) for cell in balance.cells]:
                few = min(len(scores) for scores in own)
                total = np.sum([np.sqrt(len(scores) / few) * scores[:few] for scores in own], axis=0)
                middle += total.T @ total
        return np.asarray(self.inverse @ middle @ self.inverse)


def estimate_delays(balances: Sequence[Balance], held: Array | None = None) -> Delays | None:
    """All delays together, or None where too few axes close or some delay shows nowhere.

    held: (c, delays), combinations of delays that are taken as zero.
    """
    cells = [cell for balance in balances for cell in balance.cells]
    if len(cells) < FEWEST_CELLS:
        return None
    count = len(balances[0].by_delay)
    free = np.eye(count) if held is None or not len(held) else _null_space(held)
    values, products = np.zeros(count), np.array([cell.products for cell in cells])
    floor, freedom = (np.array([getattr(cell, name) for cell in cells]) for name in ("floor", "freedom"))
    columns, missing = products[:, :count, :count], products[:, :count, count]
    squares, wrong = products[:, count, count], products[:, :count, count + 1 :]
    weights = freedom / (squares + floor)
    for _ in range(ROUNDS):
        information = np.tensordot(weights, columns, 1)
        reduced = free.T @ information @ free
        scale = np.sqrt(np.diag(reduced))
        if not (scale > 0).all() or np.linalg.cond(reduced / np.outer(scale, scale)) > 1e6:
            return None
        values = free @ np.linalg.solve(reduced, free.T @ (weights @ missing))
        left = missing - columns @ values
        weights = freedom / (squares - (missing + left) @ values + floor)
    inverse = free @ np.linalg.inv(reduced) @ free.T
    # Cells disagree by more than noise where the robot's model is wrong: each is one draw of that. What a wrong model
    # does to all of them at once does not show in it, and stands beside it.
    scores = weights[:, None] * left
    share = len(cells) / max(len(cells) - free.shape[1], 1)
    drawn = np.tensordot(weights, wrong, 1)
    middle = share * scores.T @ scores + drawn @ drawn.T / max(drawn.shape[1], 1)
    return Delays(values, inverse @ middle @ inverse, len(cells), weights, inverse)


def _null_space(held: Array) -> Array:
    """Columns (delays, f) that span all delays with held @ delays = 0."""
    _, sizes, rows = np.linalg.svd(held)
    return np.asarray(rows[int((sizes > 1e-9).sum()) :].T)


def _cells(band: Band) -> list[_Cell]:
    """Every axis of a band that closes. Gains come first: of the prediction, and of what sensors read unlike each
    other."""
    sensors, delays, products = band.sensors, len(band.rates[0]) - 1, band.products.sum(axis=0)
    # Of a few seconds, a slow band holds fewer independent values than there are gains and delays: these explain all
    # of it, whatever they are.
    freedom = 2 * band.width * band.duration - sensors
    if freedom <= delays:
        return []
    clear = _beside(products, sensors)
    rest = _beside(clear, delays)[:, 0, 0]
    at = sensors + delays  # the place of what is missing
    power, apart = products[:, 0, 0], products[:, 0, at]
    total, gain = power - 2 * apart + products[:, at, at], 1 - apart / np.maximum(power, 1e-300)
    explains = (rest < (1 - LEAST_EXPLAINED) * total) & (total > band.least * band.size)
    usable = (gain > GAIN_BAND[0]) & (gain < GAIN_BAND[1])
    wrong = clear[:, delays + 1 :, delays + 1 :]
    floor = MODEL_ERROR**2 * power + np.trace(wrong, axis1=1, axis2=2) / max(wrong.shape[-1], 1)
    found = np.flatnonzero(explains & usable).tolist()
    return [_Cell(clear[axis], floor[axis], freedom, band, axis) for axis in found]


def _beside(products: Array, count: int) -> Array:
    """Columns' products (..., k, k) without what the first `count` columns explain: those of the others alone."""
    own, across = products[..., :count, :count], products[..., :count, count:]
    size = np.sqrt(np.diagonal(own, axis1=-2, axis2=-1))[..., None]
    size = np.where(size > 0, size, 1.0)
    inverse = np.linalg.pinv(own / size / np.swapaxes(size, -1, -2), rcond=ROUNDING, hermitian=True)
    across = across / size
    return np.asarray(products[..., count:, count:] - np.swapaxes(across, -1, -2) @ inverse @ across)
