"""Zero-phase low-pass and differentiation of evenly sampled signals."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from plantar import _core
from plantar.conventions import Array

LOWEST_CUTOFF = 0.1  # Hz: below it nothing of a motion is left
FILTER_ORDER = 4  # Butterworth, run forth and back
SHORTEST_RUN = 27  # samples: of fewer a filter that runs forth and back sees ends alone
SHORTEST_FITTED_RUN = 8  # samples of a stance, or between gaps of a thinned log: one cycle of the cutoff
PADDED = 3.0  # of the cutoff's period, by which a run is continued: its filter has settled by then
MOST_PADDED = 10_000  # samples, however quick the log: so slow a filter is no motion's
KEPT = 2  # lengths whose cosines are: groups of one log's signals ask one after the other


def low_pass(
    values: Array, period: float, cutoff: float, shortest: int = SHORTEST_RUN, every: int = 1
) -> Array:
    """Zero-phase low-pass of (N,) or (N, k) at `cutoff` [Hz], each run without NaN by itself; `every` nth sample of it.

    A Butterworth filter of fourth order, run forth and back (`gain`), on the run continued point-symmetrically beyond
    both ends. A cutoff at or above the Nyquist frequency changes nothing; runs of `shortest` samples or fewer become
    NaN.
    """
    if cutoff >= 0.95 * 0.5 / period:
        return values[::every].copy()
    padding = int(min(PADDED / cutoff / period, MOST_PADDED))
    flat = np.ascontiguousarray(values.reshape(len(values), -1), dtype=np.float64)
    smooth = np.empty((-(-len(flat) // every), flat.shape[1]))
    _core.low_pass(flat, smooth, cutoff * period, padding, shortest, every)
    return smooth.reshape(len(smooth), *values.shape[1:])


def gain(frequency: Array, period: float, cutoff: float) -> Array:
    """What `low_pass` leaves of tones at these frequencies [Hz], of signals sampled each `period` [s]."""
    share = np.tan(np.pi * period * frequency) / np.tan(np.pi * period * cutoff)
    return np.asarray(1 / (1 + share ** (2 * FILTER_ORDER)))


def differentiate(values: Array, period: float) -> Array:
    """Central differences of fourth order of evenly sampled (N,) or (N, k): use beside `low_pass`, never raw.

    Second order next to the ends and to NaN.
    """
    if len(values) < 5:
        return np.asarray(np.gradient(values, period, axis=0)) if len(values) > 1 else np.zeros_like(values)
    values = np.asarray(values, dtype=np.float64)
    slope = np.empty_like(values)
    np.subtract(values[3:-1], values[1:-3], out=slope[2:-2])
    slope[2:-2] *= 8
    slope[2:-2] -= values[4:]
    slope[2:-2] += values[:-4]
    slope[2:-2] /= 12 * period
    slope[[0, -1]] = (values[[1, -1]] - values[[0, -2]]) / period
    slope[[1, -2]] = (values[[2, -1]] - values[[0, -3]]) / (2 * period)
    if not np.isfinite(slope.sum()):
        near = np.gradient(values, period, axis=0)
        slope = np.where(np.isfinite(slope), slope, near)
    return slope


def without_slow_cosines(rows: Array, period: float, slowest: float) -> Array:
    """Rows (n, k), `period` [s] apart, without their cosines from a constant up to a frequency `slowest` [Hz]."""
    cosines = _cosines(len(rows), round(2 * slowest * len(rows) * period) + 1)
    return np.asarray(rows - cosines @ (cosines.T @ rows))


@lru_cache(maxsize=KEPT)
def _cosines(rows: int, count: int) -> Array:
    """The slowest cosines (rows, count), orthonormal."""
    cosines = np.cos(np.pi * np.arange(count) * (np.arange(rows)[:, None] + 0.5) / rows)
    return np.asarray(cosines / np.linalg.norm(cosines, axis=0))
