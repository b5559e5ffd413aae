"""Zero-phase low-pass and differentiation of evenly sampled signals."""

from __future__ import annotations

import numpy as np
from scipy import fft

from plantar.conventions import Array
from plantar.signals.segments import runs

FILTER_ORDER = 4  # Butterworth, run forth and back
SHORTEST_RUN = 27  # samples


def low_pass(values: Array, period: float, cutoff: float, shortest: int = SHORTEST_RUN) -> Array:
    """Zero-phase low-pass of (N,) or (N, k) at `cutoff` [Hz], each run without NaN by itself.

    The gain is a Butterworth filter's, run forth and back, 1 / (1 + (f / cutoff)^(2·order)), applied to the spectrum
    of the run mirrored about its ends. A cutoff at or above the Nyquist frequency changes nothing; runs of `shortest`
    samples or fewer become NaN.
    """
    if cutoff >= 0.95 * 0.5 / period:
        return values.copy()
    padding = int(min(3 / cutoff / period, 10_000))
    flat = values.reshape(len(values), -1)
    result = np.full_like(flat, np.nan)
    for run in runs(np.asarray(np.isfinite(flat).all(axis=1))):
        if run.stop - run.start > shortest:
            result[run] = _filtered(flat[run], period, cutoff, min(padding, run.stop - run.start - 1))
    return result.reshape(values.shape)


def _filtered(values: Array, period: float, cutoff: float, padding: int) -> Array:
    """One run (n, k) through the low-pass, continued beyond both ends point-symmetrically."""
    before = 2 * values[0] - values[padding:0:-1]
    after = 2 * values[-1] - values[-2 : -padding - 2 : -1]
    extended = np.vstack([before, values, after])
    # What is left after the line between the ends is periodic: the spectrum of a jump would ring.
    line = np.linspace(extended[0], extended[-1], len(extended))
    length = fft.next_fast_len(len(extended), real=True)
    spectrum = fft.rfft(extended - line, length, axis=0)
    gain = 1 / (1 + (fft.rfftfreq(length, period) / cutoff) ** (2 * FILTER_ORDER))
    smooth = fft.irfft(spectrum * gain[:, None], length, axis=0)[: len(extended)] + line
    return np.asarray(smooth[padding : padding + len(values)])


def differentiate(values: Array, period: float) -> Array:
    """Central differences of fourth order of evenly sampled (N,) or (N, k): use beside `low_pass`, never raw.

    Second order next to the ends and to NaN.
    """
    if len(values) < 2:
        return np.zeros_like(values)
    slope = np.gradient(values, period, axis=0)
    if len(values) > 4:
        inner = (8 * (values[3:-1] - values[1:-3]) - (values[4:] - values[:-4])) / (12 * period)
        slope[2:-2] = np.where(np.isfinite(inner), inner, slope[2:-2])
    return np.asarray(slope)
