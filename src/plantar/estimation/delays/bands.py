"""A balance of signals in bands of frequencies, filtered once for all that asks for delays in them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise
from os import cpu_count

import numpy as np

from plantar.conventions import Array
from plantar.signals.filters import differentiate, low_pass

BAND_EDGES = (0.15, 0.4, 0.8, 1.6, 3.2, 6.4)  # Hz: from where postures change to where encoders are noise
SAMPLES_PER_CYCLE = 8  # of a band's upper edge, that thinning keeps
# Of a band's lower edge, at both ends: a filter there sees the end itself, which no delay moves.
END_CYCLES = 2.0
MOST_ENDS = 0.5  # of a recording that ends may take
# Of an axis' variance that a band must hold: less is what filters leak, an amplitude of 1 %.
LEAST_SHARE = 1e-4
LONG = 10_000  # samples beyond which threads filter axes beside each other
HALVES = (0, 2)
"""The places of the parts that are halves."""


@dataclass(frozen=True)
class Band:
    """A balance over six axes in one band of `width` [Hz], its samples `step` [s] apart.

    `signals` (6, k, m): the prediction, what each of the `sensors` behind the first reads more than that one, how what
    is missing grows with each delay [per s], and what is missing; `rates` (6, 1 + delays, m) of the prediction and of
    what grows with each delay. `products` (parts, 6, k + draws, k + draws) of signals and drawn wrong models with each
    other, `by_rate` (parts, 6, 1 + delays, draws) of rates and wrong models, in each of the `parts`: the first half of
    the recording, what is near its middle, and the second half. `least` (6,): the square for each sample below which an
    axis holds nothing in this band.
    """

    sensors: int
    signals: Array
    rates: Array
    products: Array
    by_rate: Array
    parts: Sequence[slice]
    least: Array
    width: float
    step: float

    @property
    def size(self) -> int:
        return int(self.signals.shape[-1])

    @property
    def duration(self) -> float:
        return self.size * self.step

    @property
    def late(self) -> slice:
        """The places of what grows with each delay."""
        return slice(self.sensors, self.signals.shape[1] - 1)

    def half(self, half: int) -> Band | None:
        """One of HALVES alone, as far from the recording's middle as from its end, where ends leave enough of it; None
        where that holds fewer than two independent values, twice its width times its duration."""
        rows, own = self.parts[half], slice(half, half + 1)
        signals, rates = self.signals[..., rows], self.rates[..., rows]
        if signals.shape[-1] * self.step * self.width < 1:
            return None
        return replace(
            self, signals=signals, rates=rates, products=self.products[own], by_rate=self.by_rate[own]
        )

    def read_later(self, by: Array) -> Band:
        """The band with each sensor read `by` (delays,) [s] later, to first order: of a millisecond at 6 Hz the next
        order is a thousandth of a signal. Delays behind those of the sensors are those of what is predicted."""
        count, late = self.signals.shape[1], np.arange(*self.late.indices(self.signals.shape[1]))
        turn, of_rates = np.eye(self.products.shape[-1]), np.eye(len(late) + 1)
        own = late[: self.sensors]
        turn[0, late[self.sensors :]] = of_rates[0, 1 + self.sensors :] = -by[self.sensors :]
        turn[range(1, self.sensors), own[1:]] = by[1 : self.sensors]
        turn[1 : self.sensors, own[0]] = -by[0]
        turn[count - 1, late] = -by
        return replace(
            self,
            signals=turn[:count, :count] @ self.signals,
            rates=of_rates @ self.rates,
            products=turn @ self.products @ turn.T,
            by_rate=of_rates @ self.by_rate,
        )


def bands_of(predicted: Array, measured: Array, by_delay: Array, period: float, errors: Array) -> list[Band]:
    """A balance in each band: `predicted` (n, 6) less the sum of `measured` (sensors, n, 6), which grows `by_delay`
    (delays, n, 6) with each delay [per s]; `errors` (draws, n, 6): what wrong models add to the prediction."""
    sensors, delays = len(measured), len(by_delay)
    errors = errors if len(errors) else np.zeros((0, *predicted.shape))
    whole = measured.sum(axis=0)
    parts = [predicted[None], by_delay, measured[1:] - measured[:1], (predicted - whole)[None], errors]
    # Those with rates stand together first.
    order = [0, *range(delays + 1, delays + sensors), *range(1, delays + 1)]
    order += range(delays + sensors, delays + sensors + 1 + len(errors))
    own, rated, least = sensors + delays + 1, slice(0, 1 + delays), LEAST_SHARE * np.var(whole, axis=0)

    def along(axis: int) -> Iterator[Band]:
        """Each band of one axis, as a band of that axis alone."""
        flat = np.vstack([part[:, :, axis] for part in parts]).T
        for width, thin, thin_rates, stride in banded(flat, period, rated):
            signals, rates = np.ascontiguousarray(thin.T)[order], np.ascontiguousarray(thin_rates.T)
            split = _parts(len(thin), len(flat) / stride)
            products = np.array([signals[:, rows] @ signals[:, rows].T for rows in split])
            by_rate = np.array([rates[:, rows] @ signals[own:, rows].T for rows in split])
            kept = signals[:own].copy()
            yield Band(sensors, kept, rates, products, by_rate, split, least[axis], width, stride * period)

    # An axis for each core after another: all wrong models of all axes would be the largest array of any log.
    with ThreadPoolExecutor(cpu_count()) as pool:
        each = pool.map if len(whole) > LONG else map
        return [_of_axes(axes) for axes in zip(*each(lambda axis: [*along(axis)], range(6)), strict=True)]


def _of_axes(axes: Sequence[Band]) -> Band:
    """One band of all axes, of that of each."""
    return replace(
        axes[0],
        signals=np.array([one.signals for one in axes]),
        rates=np.array([one.rates for one in axes]),
        products=np.stack([one.products for one in axes], axis=1),
        by_rate=np.stack([one.by_rate for one in axes], axis=1),
        least=np.array([one.least for one in axes]),
    )


def banded(signals: Array, period: float, rated: slice) -> Iterator[tuple[float, Array, Array, int]]:
    """Signals (n, k) in each band: its width [Hz], the filtered signals (m, k) at every nth sample, the rates of those
    columns that are `rated`, and n.

    The ends are left out: a filter answers to the end of a recording, and that is never late. Of slow signals the fast
    bands hold nothing else.
    """
    edges = [edge for edge in BAND_EDGES if edge < 0.4 / period]
    passed = pairwise(low_pass(signals, period, edge) for edge in edges)
    for (lower, edge), (below, above) in zip(pairwise(edges), passed, strict=True):
        end = round(min(END_CYCLES / lower / period, MOST_ENDS / 2 * len(signals)))
        stride = max(1, int(1 / (SAMPLES_PER_CYCLE * edge * period)))
        kept = slice(end, len(signals) - end, stride)
        rates = differentiate(above[:, rated] - below[:, rated], period)[kept]
        yield edge - lower, above[kept] - below[kept], rates, stride


def _parts(size: int, whole: float) -> tuple[slice, slice, slice]:
    """Of `size` samples without a recording's ends, of `whole` with them: those of either half, around what is near
    the middle. There the filter saw no end: of slow bands, whose ends are long, less is left out."""
    half = size // 2 - round(min((whole - size) / 2, MOST_ENDS / 2 * whole / 2))
    return slice(0, half), slice(half, size - half), slice(size - half, size)
