"""How late one signal is against another that it should equal (measured against predicted wrench).

Each axis in each band of frequencies gives a delay of its own. Where the prediction is wrong by more than noise these
disagree, and their disagreement goes into the deviation: a fit over everything at once could not see that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import FORCE, Array
from plantar.estimation.intervals import cosine_covariance
from plantar.signals.filters import differentiate, low_pass

ROUNDS = 4  # the moment equation is linear near its solution: each round shifts and solves again
LONGEST = 0.05  # s: later signals than this have another fault than a delay
BAND_EDGES = (0.15, 0.4, 0.8, 1.6, 3.2, 6.4)  # Hz
LEAST_EXPLAINED = 0.8  # share of an axis' variance in a band that the prediction must explain to take part
LEAST_CLOSED = (
    0.93  # share of the forces' variance that the prediction explains as it is: less, and somebody pushes
)
GAIN_BAND = (0.8, 1.25)  # measured over predicted, of an axis that takes part
SAMPLES_PER_CYCLE = 8  # of a band's upper edge, that thinning keeps
MODEL_ERROR = (
    0.003  # of the amplitude, in quadrature: what any URDF and any filter get wrong; a delay of this over ω
)


@dataclass(frozen=True)
class Pair:
    """Measured and predicted wrench of one recording, (n, 6) each, evenly sampled, without NaN, equally filtered.

    `rate` (n, 6) is how `measured` changes with the moment at which the sensors are read. It is not its derivative in
    time where sensors turn: what is late is their reading, not the frame that it is expressed in.
    """

    label: str
    measured: Array
    rate: Array
    predicted: Array
    period: float


@dataclass(frozen=True)
class Delay:
    """`value` [s] > 0: the measured signal is late; `freedom`: degrees of freedom of `std`; `cells` took part."""

    value: float
    std: float
    freedom: float
    cells: int


def estimate_delay(pairs: Sequence[Pair]) -> Delay | None:
    """Delay common to all pairs, or None where in none the prediction closes, or what it says is no delay."""
    value, found = 0.0, None
    bands = [_bands(pair) for pair in pairs if closes(pair)]
    for _ in range(ROUNDS):
        cells = [cell for own in bands for band in own for cell in _cells(band, value)]
        if not cells:
            return None
        found = _pooled(cells)
        value += found.value
        if abs(value) > LONGEST:
            return None
    return found and Delay(value, found.std, found.freedom, found.cells)


@dataclass(frozen=True)
class _Band:
    """A pair in one band of frequencies of `width` [Hz], thinned, with rates; `bend` is the second one of measured."""

    measured: Array
    rate: Array
    bend: Array
    predicted: Array
    predicted_rate: Array
    width: float
    duration: float

    def at(self, delay: float) -> tuple[Array, Array]:
        """Measured signal and its rate as if read `delay` later: by their own rates, smooth as a band is."""
        return self.measured + delay * self.rate + 0.5 * delay**2 * self.bend, self.rate + delay * self.bend


def _bands(pair: Pair) -> list[_Band]:
    """The pair in each band of frequencies."""
    together = np.hstack([pair.measured, pair.rate, pair.predicted])
    period = pair.period
    edges = [edge for edge in BAND_EDGES if edge < 0.4 / period]
    layers = [low_pass(together, period, edge) for edge in edges]
    found = []
    for place, edge in enumerate(edges[1:]):
        band = layers[place + 1] - layers[place]
        measured, rate, predicted = np.hsplit(band, 3)
        thin = slice(None, None, max(1, int(1 / (SAMPLES_PER_CYCLE * edge * period))))
        bend, predicted_rate = differentiate(rate, period)[thin], differentiate(predicted, period)[thin]
        parts = (measured[thin], rate[thin], bend, predicted[thin], predicted_rate)
        found.append(_Band(*parts, edge - edges[place], len(band) * period))
    return found


def _pooled(cells: Sequence[Delay]) -> Delay:
    """Mean by inverse variance; its deviation grows where the cells disagree by more than they claim."""
    weights = np.array([1 / cell.std**2 for cell in cells])
    values = np.array([cell.value for cell in cells])
    value = float(weights @ values / weights.sum())
    disagreement = float(weights @ (values - value) ** 2) / max(len(cells) - 1, 1)
    freedoms = np.array([cell.freedom for cell in cells])
    freedom = float(weights.sum() ** 2 / np.sum(weights**2 / freedoms))
    return Delay(value, float(np.sqrt(max(1.0, disagreement) / weights.sum())), freedom, len(cells))


def closes(pair: Pair) -> bool:
    """Whether the forces follow from the prediction: they do not where an operator holds the robot."""
    measured, rate, predicted = (
        part[:, FORCE] - part[:, FORCE].mean(axis=0) for part in (pair.measured, pair.rate, pair.predicted)
    )
    missed = unexplained(measured, rate, predicted)
    return missed <= (1 - LEAST_CLOSED) * float(np.sum(measured**2))


def unexplained(measured: Array, rate: Array, predicted: Array) -> float:
    """Squares that the prediction misses at the delay that suits it best."""
    missing, power = measured - predicted, float(np.sum(rate**2))
    delay = -float(np.sum(missing * rate)) / power if power > 0 else 0.0
    return float(np.sum((missing + np.clip(delay, -LONGEST, LONGEST) * rate) ** 2))


def _cells(band: _Band, delay: float) -> list[Delay]:
    """What is left of the delay, by axis: Σ (m - g·p) ṗ = -δ Σ ṁ ṗ for m(t) = g·p(t - δ) + noise.

    Noise is nowhere multiplied with itself, only with its own rate, so that it does not bias δ.
    """
    measured, rates_m = band.at(delay)
    predicted, rates_p = band.predicted, band.predicted_rate
    found = []
    for m, p, rate_m, rate_p in zip(measured.T, predicted.T, rates_m.T, rates_p.T, strict=True):
        power, slope = float(p @ p), float(rate_m @ rate_p)
        gain = float(m @ p) / power if power > 0 else 0.0
        rest = m - gain * p
        explains = float(rest @ rest) < (1 - LEAST_EXPLAINED) * float(m @ m)
        if not (explains and GAIN_BAND[0] < gain < GAIN_BAND[1] and slope > 0):
            continue
        step = -float(rest @ rate_p) / slope
        scores = (rest + step * rate_m) * rate_p
        coloured, freedom = cosine_covariance(scores[:, None], band.duration)
        # Few cosines are small by chance now and then, and such a cell would outweigh all others: two independent
        # signals of this band's width have scores with at least so much variance.
        usual = len(scores) * float(scores @ scores) / (2 * band.width * band.duration)
        noise = np.sqrt(max(float(coloured[0, 0]), usual)) / slope
        floor = MODEL_ERROR * np.sqrt(power / float(rate_p @ rate_p))
        found.append(Delay(step, float(np.hypot(noise, floor)), freedom, 1))
    return found
