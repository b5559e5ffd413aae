"""How late one signal is against another that it should equal (measured against predicted wrench).

Each axis in each band of frequencies gives a delay of its own. Where the prediction is wrong by more than noise these
disagree, and their disagreement goes into the deviation: a fit over everything at once could not see that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from plantar.conventions import FORCE, NORMAL95, Array
from plantar.estimation.delays.bands import Band, bands_of
from plantar.estimation.quantiles import student_quantile
from plantar.estimation.residual_covariance import score_cosines

ROUNDS = 4  # the moment equation is linear near its solution: each round shifts and solves again
SETTLED = 0.01  # of the deviation: after a smaller step the next one would be a hundredth of it or less
LONGEST = 0.05  # s: later signals than this have another fault than a delay
LEAST_EXPLAINED = 0.8  # share of an axis' variance in a band that the prediction must explain to take part
# Share of the forces' variance that the prediction explains as it is: less, and somebody pushes.
LEAST_CLOSED = 0.93
GAIN_BAND = (0.8, 1.25)  # measured over predicted, of an axis that takes part
# Of the amplitude, in quadrature: what any URDF and any filter get wrong; a delay of this over ω.
MODEL_ERROR = 0.003


@dataclass(frozen=True)
class Pair:
    """Measured and predicted wrench of one recording, (n, 6) each, evenly sampled, without NaN, equally filtered.

    `rate` (n, 6) is how `measured` changes with the moment at which the sensors are read. It is not its derivative in
    time where sensors turn: what is late is their reading, not the frame that it is expressed in. `model_errors`
    (draws, n, 6): how `predicted` would change were the robot's model wrong by as much as it may be, at random; the
    same draws in every recording. `known`: its bands, where what it is part of has them already.
    """

    label: str
    measured: Array
    rate: Array
    predicted: Array
    period: float
    model_errors: Array = field(default_factory=lambda: np.zeros((0, 0, 6)))
    known: Sequence[Band] | None = None

    @cached_property
    def bands(self) -> Sequence[Band]:
        """The pair in each band of frequencies, once it was asked for."""
        if self.known is not None:
            return self.known
        return bands_of(self.predicted, self.measured[None], self.rate[None], self.period, self.model_errors)

    @property
    def slim(self) -> Pair:
        """A copy without bands and draws of wrong models, which together are far larger than the rest."""
        return replace(self, model_errors=np.zeros((0, 0, 6)), known=None)


@dataclass(frozen=True)
class Delay:
    """`value` [s] > 0: the measured signal is late; `freedom`: degrees of freedom of `std`; `cells` took part."""

    value: float
    std: float
    freedom: float
    cells: int

    @property
    def wide_std(self) -> float:
        """The deviation of a normal distribution whose 95 % interval is as wide as this delay's."""
        return self.std * student_quantile(0.975, self.freedom) / NORMAL95


def estimate_delay(pairs: Sequence[Pair]) -> Delay | None:
    """Delay common to all pairs, or None where in none the prediction closes, or what it says is no delay."""
    return delay_in([band for pair in pairs if closes(pair) for band in pair.bands])


def delay_in(bands: Sequence[Band]) -> Delay | None:
    """Delay common to bands of pairs that close; None where no axis explains any, or what they say is no delay."""
    value, found = 0.0, None
    sides = [_Sides.of(band) for band in bands]
    for _ in range(ROUNDS):
        cells = [cell for one in sides for cell in _cells(one, value)]
        if not cells:
            return None
        found = _pooled(cells)
        value += found.value
        if abs(value) > LONGEST:
            return None
        if abs(found.value) < SETTLED * found.std:
            break
    return found and Delay(value, found.std, found.freedom, found.cells)


@dataclass(frozen=True)
class _Sides:
    """Both sides of a balance in one band (6, m), with rates; `bend` is the second one of measured.

    `errors_along`, `errors_by_rate` (draws, 6): products of drawn wrong models with the predicted signal and its rate.
    """

    measured: Array
    rate: Array
    bend: Array
    predicted: Array
    predicted_rate: Array
    errors_along: Array
    errors_by_rate: Array
    band: Band

    @classmethod
    def of(cls, band: Band) -> _Sides:
        predicted, missing = band.signals[:, 0], band.signals[:, -1]
        rate = band.signals[:, band.late][:, : band.sensors].sum(axis=1)
        bend = band.rates[:, 1 : 1 + band.sensors].sum(axis=1)
        drawn = slice(band.signals.shape[1], None)
        along, by_rate = (
            some.sum(axis=0).T for some in (band.products[..., 0, drawn], band.by_rate[..., 0, :])
        )
        return cls(predicted - missing, rate, bend, predicted, band.rates[:, 0], along, by_rate, band)

    def at(self, delay: float) -> tuple[Array, Array]:
        """Measured signal and its rate as if read `delay` later: by their own rates, smooth as a band is."""
        return self.measured + delay * self.rate + 0.5 * delay**2 * self.bend, self.rate + delay * self.bend


@dataclass(frozen=True)
class _Cell:
    """The delay that one axis in one band shows; `moved` (draws,): by how much it would, were the model as drawn."""

    value: float
    std: float
    freedom: float
    moved: Array


def _pooled(cells: Sequence[_Cell]) -> Delay:
    """Mean by inverse variance; its deviation grows where the cells disagree by more than they claim.

    A wrong model moves all cells at once: its share is the spread of what they would make of each draw together.
    """
    wrong = np.array([cell.moved for cell in cells])
    own = np.array([cell.std**2 for cell in cells])
    variances = own + _mean_square(wrong)
    values, weights = np.array([cell.value for cell in cells]), 1 / variances
    weights /= weights.sum()
    value = float(weights @ values)
    disagreement = float(np.sum((values - value) ** 2 / variances)) / max(len(cells) - 1, 1)
    variance = float(weights**2 @ own + _mean_square(weights @ wrong))
    freedoms = np.array([cell.freedom for cell in cells])
    freedom = float(np.sum(weights**2 * variances) ** 2 / np.sum(weights**4 * variances**2 / freedoms))
    return Delay(value, float(np.sqrt(max(1.0, disagreement) * variance)), freedom, len(cells))


def _mean_square(values: Array) -> Array:
    """Over the last axis, 0 where it is empty."""
    return np.asarray(np.sum(values**2, axis=-1) / max(values.shape[-1], 1))


def closes(pair: Pair) -> bool:
    """Whether the forces follow from the prediction: they do not where an operator holds the robot."""
    measured, rate, predicted = (
        part[:, FORCE] - part[:, FORCE].mean(axis=0) for part in (pair.measured, pair.rate, pair.predicted)
    )
    missed = unexplained(measured, rate, predicted)
    return bool(missed <= (1 - LEAST_CLOSED) * np.sum(measured**2))


def unexplained(measured: Array, rate: Array, predicted: Array) -> Array:
    """Squares (...) that the prediction misses at the delay that suits it best, of each of the signals (..., n, k)."""
    missing, power = measured - predicted, np.sum(rate**2, axis=(-2, -1))
    delay = -np.sum(missing * rate, axis=(-2, -1)) / np.where(power > 0, power, np.inf)
    delay = np.clip(delay, -LONGEST, LONGEST)[..., None, None]
    return np.asarray(np.sum((missing + delay * rate) ** 2, axis=(-2, -1)))


def _cells(sides: _Sides, delay: float) -> list[_Cell]:
    """What is left of the delay, by axis: Σ (m - g·p) ṗ = -δ Σ ṁ ṗ for m(t) = g·p(t - δ) + noise.

    Noise is nowhere multiplied with itself, only with its own rate, so that it does not bias δ.
    """
    m, rate_m = sides.at(delay)
    p, rate_p, band = sides.predicted, sides.predicted_rate, sides.band
    power, slope, squares = _dots(p, p), _dots(rate_m, rate_p), _dots(m, m)
    gain = _dots(m, p) / np.where(power > 0, power, np.inf)
    rest = m - gain[:, None] * p
    explains = _dots(rest, rest) < (1 - LEAST_EXPLAINED) * squares
    usable = (gain > GAIN_BAND[0]) & (gain < GAIN_BAND[1]) & (slope > 0) & (squares > band.least * band.size)
    axes = np.flatnonzero(explains & usable)
    if not axes.size:
        return []
    p, rate_p, rate_m, rest = p[axes], rate_p[axes], rate_m[axes], rest[axes]
    power, slope, gain = power[axes], slope[axes], gain[axes]
    steps = -_dots(rest, rate_p) / slope
    scores = (rest + steps[:, None] * rate_m) * rate_p
    cosines = score_cosines(scores.T, band.duration)
    # Few cosines are small by chance now and then, and such a cell would outweigh all others: two independent
    # signals of this band's width have scores with at least so much variance.
    usual = band.size * _dots(scores, scores) / (2 * band.width * band.duration)
    noise = np.sqrt(np.maximum(_dots(cosines.T, cosines.T), usual)) / slope
    floor = MODEL_ERROR * np.sqrt(power / _dots(rate_p, rate_p))
    # The gain takes what is along the prediction.
    across = sides.errors_by_rate[:, axes] - sides.errors_along[:, axes] * _dots(p, rate_p) / power
    moved = gain * across / slope
    each = zip(steps, np.hypot(noise, floor), moved.T, strict=True)
    return [_Cell(float(step), float(std), len(cosines), own) for step, std, own in each]


def _dots(one: Array, other: Array) -> Array:
    """Products of rows (k, n) with those of the other, (k,)."""
    return np.asarray(np.einsum("kn,kn->k", one, other))
