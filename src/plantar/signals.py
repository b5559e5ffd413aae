"""Signals on one time base: runs without gaps, zero-phase filtering, differentiation, resampling, delay."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from plantar.conventions import Array, Mask
from plantar.log import MotionLog
from plantar.notes import Note

GAP_PERIODS = 3.5  # a step of time longer than this many periods is a gap
BRIDGED = 0.04  # s: no motion that a fit uses is as short
LONG_GAP = 10.0  # s: a longer gap is not spelled out sample by sample
JITTER_SHARE = 0.25  # of a period: below it, samples count as evenly spaced
FILTER_ORDER = 4  # Butterworth, run forth and back
SHORTEST_RUN = 27  # samples


@dataclass(frozen=True)
class Sampling:
    """How evenly a log is sampled: `rate` [Hz], rms `jitter` of the steps [s], gaps as (start, end) [s]."""

    rate: float
    jitter: float
    gaps: tuple[tuple[float, float], ...]


def sampling(log: MotionLog) -> Sampling:
    """Rate, jitter and gaps of a log's time column."""
    step, period = np.diff(log.time), log.period
    gap = step > GAP_PERIODS * period
    jitter = float(np.sqrt(np.mean((step[~gap] - period) ** 2)))
    gaps = tuple((float(log.time[i]), float(log.time[i + 1])) for i in np.flatnonzero(gap))
    return Sampling(1 / period, jitter, gaps)


def evenly_sampled(log: MotionLog) -> MotionLog:
    """The log on an even grid of its usual period; untouched (the same object) where it already stands on one.

    Values are interpolated linearly, quaternions with their signs aligned; inside a gap they are NaN. Of a gap longer
    than LONG_GAP only the beginning stands on the grid: a clock that jumps by days costs no memory.
    """
    period = log.period
    steps = np.diff(log.time)
    if np.all(np.abs(steps - period) < JITTER_SHARE * period):
        return log
    breaks = np.flatnonzero(steps > max(LONG_GAP, 2 * GAP_PERIODS * period))
    starts, ends = log.time[[0, *(breaks + 1)]], log.time[[*breaks, -1]]
    ends[:-1] += GAP_PERIODS * period
    first, last = (np.round((times - log.time[0]) / period).astype(np.int64) for times in (starts, ends))
    grid = log.time[0] + period * np.concatenate(
        [np.arange(a, b + 1) for a, b in zip(first, last, strict=True)]
    )
    columns = {
        name: interpolate(grid, log.time, values, GAP_PERIODS * period)
        for name, values in _aligned(log).items()
    }
    text = f"{log.name}: sampled unevenly or with gaps; put on an even grid of {1 / period:.4g} Hz, gaps kept as gaps"
    note = Note("resampled", "info", text)
    return MotionLog(log.name, grid, columns, log.path, log.sha256, (*log.notes, note))


def without_holes(log: MotionLog) -> MotionLog:
    """The log with short holes in its columns filled by straight lines; the same object where it has none.

    A slower sensor in a table of faster ones leaves such holes at every row but its own. Longer than BRIDGED they stay.
    """
    filled, longest = {}, max(BRIDGED, 2.5 * log.period)
    for name, values in log.columns.items():
        if not np.isnan(values).any():
            continue
        if ".orientation." in name:
            values = _aligned(log)[name]
        there = interpolate(log.time, log.time, values, longest)
        if np.isfinite(there).sum() > np.isfinite(values).sum():
            filled[name] = there
    if not filled:
        return log
    some = ", ".join(list(filled)[:3]) + (f" and {len(filled) - 3} more" if len(filled) > 3 else "")
    text = f"{log.name}: holes of at most {1e3 * longest:.0f} ms filled by straight lines: {some}"
    return log.with_columns(filled, Note("holes_filled", "info", text))


def interpolate(at: Array, time: Array, values: Array, longest: float) -> Array:
    """Linear interpolation of `values` (N,) at the times `at`; NaN where the samples around are `longest` [s] apart."""
    finite = np.isfinite(values)
    if finite.sum() < 2:
        return np.full(at.shape, np.nan)
    time, values = time[finite], values[finite]
    result = np.interp(at, time, values, left=np.nan, right=np.nan)
    after = np.clip(np.searchsorted(time, at), 1, time.size - 1)
    exact = (time[after] == at) | (time[after - 1] == at)
    result[(time[after] - time[after - 1] > longest) & ~exact] = np.nan
    return result


def shifted(values: Array, period: float, delay: float) -> Array:
    """Evenly sampled `values` (N, k) as they were `delay` [s] later: undoes a sensor that reports late by `delay`."""
    if delay == 0:
        return values
    time: Array = period * np.arange(len(values), dtype=np.float64)
    flat = values.reshape(len(values), -1)
    moved = [interpolate(time + delay, time, column, 2 * period) for column in flat.T]
    return np.column_stack(moved).reshape(values.shape)


def runs(valid: Mask) -> list[slice]:
    """The stretches of consecutive true samples, as slices."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], valid, [False]]).astype(np.int8)))
    return [slice(int(start), int(stop)) for start, stop in edges.reshape(-1, 2)]


def run_ends(valid: Mask, reach: int) -> Mask:
    """The first and last `reach` samples of every run: where a filter knew only one side."""
    ends = np.zeros(len(valid), dtype=bool)
    for run in runs(valid):
        ends[run.start : min(run.stop, run.start + reach)] = True
        ends[max(run.start, run.stop - reach) : run.stop] = True
    return ends


def low_pass(values: Array, period: float, cutoff: float) -> Array:
    """Zero-phase low-pass of (N,) or (N, k) at `cutoff` [Hz], each run without NaN by itself.

    The gain is a Butterworth filter's, run forth and back, 1 / (1 + (f / cutoff)^(2·order)), applied to the spectrum
    of the run mirrored about its ends. A cutoff at or above the Nyquist frequency changes nothing; runs too short to
    filter become NaN.
    """
    if cutoff >= 0.95 * 0.5 / period:
        return values.copy()
    padding = int(min(3 / cutoff / period, 10_000))
    flat = values.reshape(len(values), -1)
    result = np.full_like(flat, np.nan)
    for run in runs(np.asarray(np.isfinite(flat).all(axis=1))):
        if run.stop - run.start > SHORTEST_RUN:
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


def _aligned(log: MotionLog) -> dict[str, Array]:
    """The log's columns with each quaternion's sign made continuous, so that it can be interpolated."""
    columns = dict(log.columns)
    imus = {name.removesuffix(".orientation.w") for name in columns if name.endswith(".orientation.w")}
    for imu in imus:
        names = [f"{imu}.orientation.{axis}" for axis in "wxyz"]
        if log.has(*names):
            quaternion = log.stack(names)
            signs, known = np.ones(len(log)), np.isfinite(quaternion).all(axis=1)
            dots = np.sum(quaternion[known][1:] * quaternion[known][:-1], axis=1)
            signs[known] = np.cumprod(np.append(1.0, np.where(dots < 0, -1.0, 1.0)))[: known.sum()]
            columns.update(zip(names, (quaternion * signs[:, None]).T, strict=True))
    return columns
