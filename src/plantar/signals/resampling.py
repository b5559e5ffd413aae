"""Signals on one even time base: sampling, gaps and holes, interpolation, delays undone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note, listing

GAP_PERIODS = 3.5  # a step of time longer than this many periods is a gap
BRIDGED = 0.04  # s: no motion that a fit uses is as short
LONG_GAP = 10.0  # s: a longer gap is not spelled out sample by sample
SHOWN = 0.02  # s of a long gap, at least, that stand on the grid: every few samples of a quick log show it
JITTER_SHARE = 0.25  # of a period: below it, samples count as evenly spaced


@dataclass(frozen=True)
class Sampling:
    """How evenly a log is sampled: `rate` [Hz], rms `jitter` of the steps [s], gaps as (start, end) [s]: what was left
    out is none."""

    rate: float
    jitter: float
    gaps: tuple[tuple[float, float], ...]


def sampling(log: MotionLog) -> Sampling:
    """Rate, jitter and gaps of a log's time column."""
    step, period = np.diff(log.time), log.period
    gap = step > GAP_PERIODS * period
    jitter = float(np.sqrt(np.mean((step[~gap] - period) ** 2)))
    spans = ((float(log.time[i]), float(log.time[i + 1])) for i in np.flatnonzero(gap))
    return Sampling(1 / period, jitter, tuple(span for span in spans if span not in log.left_out))


def is_even(log: MotionLog) -> bool:
    """Whether a log stands on an even grid of its usual period, but for what is left out: it is empty before that."""
    even = np.abs(np.diff(log.time) - log.period) < JITTER_SHARE * log.period
    return bool(len(even) - np.count_nonzero(even) == len(log.left_out))


def evenly_sampled(log: MotionLog) -> MotionLog:
    """The log on an even grid of its usual period; untouched (the same object) where it already stands on one.

    Values are interpolated linearly, quaternions with their signs aligned; inside a gap they are NaN. Of a gap longer
    than LONG_GAP only the beginning stands on the grid: a clock that jumps by days costs no memory.
    """
    if is_even(log):
        return log
    period, steps = log.period, np.diff(log.time)
    breaks = np.flatnonzero(steps > max(LONG_GAP, 2 * GAP_PERIODS * period))
    starts, ends = log.time[[0, *(breaks + 1)]], log.time[[*breaks, -1]]
    ends[:-1] += max(GAP_PERIODS * period, SHOWN)
    first, last = (np.round((times - log.time[0]) / period).astype(np.int64) for times in (starts, ends))
    grid = log.time[0] + period * np.concatenate(
        [np.arange(a, b + 1) for a, b in zip(first, last, strict=True)]
    )
    columns = {
        name: interpolate(grid, log.time, values, GAP_PERIODS * period)
        for name, values in with_continuous_quaternions(log).items()
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
            values = with_continuous_quaternions(log)[name]
        there = interpolate(log.time, log.time, values, longest)
        if np.isfinite(there).sum() > np.isfinite(values).sum():
            filled[name] = there
    if not filled:
        return log
    some = listing(list(filled), 3)
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


def shifted(values: Array, period: float, delay: float, kept: slice = slice(None)) -> Array:
    """Evenly sampled `values` (N, ...) as they were `delay` [s] later, at the samples `kept`: undoes a sensor that
    reports late by `delay`.
    """
    if delay == 0:
        return values[kept]
    whole, share = int(delay // period), delay % period / period
    rows = np.arange(*kept.indices(len(values))) + whole
    before = _at(values, rows)
    return before if share == 0 else before + share * (_at(values, rows + 1) - before)


def _at(values: Array, rows: NDArray[np.intp]) -> Array:
    """Values at `rows`, NaN beyond the ends."""
    inside = (rows >= 0) & (rows < len(values))
    if inside.all():
        return np.asarray(values[rows])
    found = np.full((len(rows), *values.shape[1:]), np.nan)
    found[inside] = values[rows[inside]]
    return found


def with_continuous_quaternions(log: MotionLog) -> dict[str, Array]:
    """The log's columns with each quaternion's sign made continuous, so that it can be interpolated."""
    columns = dict(log.columns)
    imus = {name.removesuffix(".orientation.w") for name in columns if name.endswith(".orientation.w")}
    for imu in imus:
        names = [f"{imu}.orientation.{axis}" for axis in "wxyz"]
        if log.has(*names):
            turned = sum((columns[name][1:] * columns[name][:-1] for name in names), np.zeros(len(log) - 1))
            if (turned >= 0).all():  # known and continuous throughout
                continue
            quaternion = log.stack(names)
            signs, known = np.ones(len(log)), np.isfinite(quaternion).all(axis=1)
            dots = np.sum(quaternion[known][1:] * quaternion[known][:-1], axis=1)
            signs[known] = np.cumprod(np.append(1.0, np.where(dots < 0, -1.0, 1.0)))[: known.sum()]
            columns.update(zip(names, (quaternion * signs[:, None]).T, strict=True))
    return columns
