"""How late one signal is against another that it should equal (measured against predicted wrench).

Each axis in each band of frequencies gives a delay of its own. Where the prediction is wrong by more than noise these
disagree, and their disagreement goes into the deviation: a fit over everything at once could not see that.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from plantar.conventions import FORCE, NORMAL95, Array
from plantar.estimation.quantiles import student_quantile
from plantar.estimation.residual_covariance import score_cosines
from plantar.signals.filters import differentiate, low_pass

ROUNDS = 4  # the moment equation is linear near its solution: each round shifts and solves again
SETTLED = 0.01  # of the deviation: after a smaller step the next one would be a hundredth of it or less
LONGEST = 0.05  # s: later signals than this have another fault than a delay
BAND_EDGES = (0.15, 0.4, 0.8, 1.6, 3.2, 6.4)  # Hz
LEAST_EXPLAINED = 0.8  # share of an axis' variance in a band that the prediction must explain to take part
# Share of the forces' variance that the prediction explains as it is: less, and somebody pushes.
LEAST_CLOSED = 0.93
GAIN_BAND = (0.8, 1.25)  # measured over predicted, of an axis that takes part
SAMPLES_PER_CYCLE = 8  # of a band's upper edge, that thinning keeps
# Of a band's lower edge, at both ends: a filter there sees the end itself, which no delay moves.
END_CYCLES = 2.0
MOST_ENDS = 0.5  # of a recording that ends may take
# Of an axis' variance that a band must hold: less is what filters leak, an amplitude of 1 %.
LEAST_SHARE = 1e-4
# Of the amplitude, in quadrature: what any URDF and any filter get wrong; a delay of this over ω.
MODEL_ERROR = 0.003


@dataclass(frozen=True)
class Pair:
    """Measured and predicted wrench of one recording, (n, 6) each, evenly sampled, without NaN, equally filtered.

    `rate` (n, 6) is how `measured` changes with the moment at which the sensors are read. It is not its derivative in
    time where sensors turn: what is late is their reading, not the frame that it is expressed in. `model_errors`
    (draws, n, 6): how `predicted` would change were the robot's model wrong by as much as it may be, at random; the
    same draws in every recording.
    """

    label: str
    measured: Array
    rate: Array
    predicted: Array
    period: float
    model_errors: Array = field(default_factory=lambda: np.zeros((0, 0, 6)))

    @cached_property
    def bands(self) -> list[_Band]:
        """The pair in each band of frequencies, once it was asked for."""
        return _bands(self)

    @property
    def slim(self) -> Pair:
        """A copy without bands and draws of wrong models, which together are far larger than the rest."""
        return replace(self, model_errors=np.zeros((0, 0, 6)))


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
    value, found = 0.0, None
    bands = [pair.bands for pair in pairs if closes(pair)]
    for _ in range(ROUNDS):
        cells = [cell for own in bands for band in own for cell in _cells(band, value)]
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
class _Band:
    """A pair in one band of frequencies of `width` [Hz], thinned, with rates; `bend` is the second one of measured.

    `errors_along`, `errors_by_rate` (draws, 6): products of drawn wrong models with the predicted signal and its rate.
    `enough` (6,): the squares below which an axis holds nothing in this band.
    """

    measured: Array
    rate: Array
    bend: Array
    predicted: Array
    predicted_rate: Array
    errors_along: Array
    errors_by_rate: Array
    enough: Array
    width: float
    duration: float

    def at(self, delay: float) -> tuple[Array, Array]:
        """Measured signal and its rate as if read `delay` later: by their own rates, smooth as a band is."""
        return self.measured + delay * self.rate + 0.5 * delay**2 * self.bend, self.rate + delay * self.bend


def banded(
    signals: Array, period: float, rated: slice = slice(0)
) -> Iterator[tuple[float, Array, Array, int]]:
    """Signals (n, k) in each band: its width [Hz], the filtered signals (m, k) at every nth sample, the rates of those
    columns that are `rated`, and n.

    The ends are left out: a filter answers to the end of a recording, and that is never late. Of slow signals the fast
    bands hold nothing else.
    """
    edges = [edge for edge in BAND_EDGES if edge < 0.4 / period]
    above = low_pass(signals, period, edges[0]) if edges else signals
    for place, edge in enumerate(edges[1:]):
        below, above = above, low_pass(signals, period, edge)
        end = round(min(END_CYCLES / edges[place] / period, MOST_ENDS / 2 * len(signals)))
        stride = max(1, int(1 / (SAMPLES_PER_CYCLE * edge * period)))
        kept = slice(end, len(signals) - end, stride)
        rates = differentiate(above[:, rated] - below[:, rated], period)[kept]
        yield edge - edges[place], above[kept] - below[kept], rates, stride


def _bands(pair: Pair) -> list[_Band]:
    """The pair in each band of frequencies."""
    draws, period = len(pair.model_errors), pair.period
    together = np.hstack([pair.measured, pair.rate, pair.predicted, *pair.model_errors])
    whole = np.var(pair.measured, axis=0)
    found = []
    # Rates: of the measured rate, and of the predicted signal.
    for width, thin, rates, stride in banded(together, period, slice(6, 18)):
        measured, rate, predicted = thin[:, :6], thin[:, 6:12], thin[:, 12:18]
        drawn = thin[:, 18:].reshape(len(thin), draws, 6)
        along, by_rate = (np.einsum("nda,na->da", drawn, one) for one in (predicted, rates[:, 6:]))
        enough = LEAST_SHARE * whole * len(thin)
        parts = (measured, rate, rates[:, :6], predicted, rates[:, 6:], along, by_rate, enough)
        found.append(_Band(*parts, width, len(thin) * stride * period))
    return found


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


def _cells(band: _Band, delay: float) -> list[_Cell]:
    """What is left of the delay, by axis: Σ (m - g·p) ṗ = -δ Σ ṁ ṗ for m(t) = g·p(t - δ) + noise.

    Noise is nowhere multiplied with itself, only with its own rate, so that it does not bias δ.
    """
    m, rate_m = band.at(delay)
    p, rate_p = band.predicted, band.predicted_rate
    power, slope, squares = _dots(p, p), _dots(rate_m, rate_p), _dots(m, m)
    gain = _dots(m, p) / np.where(power > 0, power, np.inf)
    rest = m - gain * p
    explains = _dots(rest, rest) < (1 - LEAST_EXPLAINED) * squares
    usable = (gain > GAIN_BAND[0]) & (gain < GAIN_BAND[1]) & (slope > 0) & (squares > band.enough)
    axes = np.flatnonzero(explains & usable)
    if not axes.size:
        return []
    p, rate_p, rate_m, rest = p[:, axes], rate_p[:, axes], rate_m[:, axes], rest[:, axes]
    power, slope, gain = power[axes], slope[axes], gain[axes]
    steps = -_dots(rest, rate_p) / slope
    scores = (rest + steps * rate_m) * rate_p
    cosines = score_cosines(scores, band.duration)
    # Few cosines are small by chance now and then, and such a cell would outweigh all others: two independent
    # signals of this band's width have scores with at least so much variance.
    usual = len(scores) * _dots(scores, scores) / (2 * band.width * band.duration)
    noise = np.sqrt(np.maximum(_dots(cosines, cosines), usual)) / slope
    floor = MODEL_ERROR * np.sqrt(power / _dots(rate_p, rate_p))
    # The gain takes what is along the prediction.
    across = band.errors_by_rate[:, axes] - band.errors_along[:, axes] * _dots(p, rate_p) / power
    moved = gain * across / slope
    each = zip(steps, np.hypot(noise, floor), moved.T, strict=True)
    return [_Cell(float(step), float(std), len(cosines), own) for step, std, own in each]


def _dots(one: Array, other: Array) -> Array:
    """Products of columns (n, k) with those of the other, (k,)."""
    return np.asarray(np.einsum("nk,nk->k", one, other))
