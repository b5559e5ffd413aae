"""Fewer samples of a quickly sampled log: what a fit reads lies far below half of its rate."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.signals.filters import low_pass
from plantar.signals.resampling import with_continuous_quaternions

LOWEST_RATE = 200.0  # Hz, that is kept: landings last some samples, delays are interpolated between two
BAND = 0.8  # of half the rate that is kept: faster changes are filtered out first, or they would pass for slow ones
TOGETHER = 4  # columns: the filter takes hardly longer for as many as for one, and more take memory


def step_of(log: MotionLog) -> int:
    """Every how many samples of a log are enough."""
    return max(1, int(np.floor(1 / (log.period * LOWEST_RATE) * (1 + 1e-6))))


def kept_size(log: MotionLog) -> int:
    """Bytes that the numbers of a log take when it is `thinned`."""
    return log.size // step_of(log)


def picked(log: MotionLog) -> MotionLog:
    """Of every k samples of a raw log the first that a column holds, as it is: enough for a look at postures and loads.

    A slower sensor may be read at any of them.
    """
    step = step_of(log)
    if step < 2 or len(log) < 2 * step:
        return log
    columns = {}
    for name, values in log.columns.items():
        first = values[::step].copy()
        for later in range(1, step):
            if not (missing := np.isnan(first)).any():
                break
            rest = values[later::step]
            first[: len(rest)] = np.where(missing[: len(rest)], rest, first[: len(rest)])
        first.setflags(write=False)  # handed over, not copied
        columns[name] = first
    return MotionLog(log.name, log.time[::step], columns, log.path, log.sha256, log.notes)


def thinned(log: MotionLog) -> MotionLog:
    """Every k-th sample of an evenly sampled log, without what is faster; the same object at less than twice the rate.

    What is slower keeps its size and its time to 1e-3. A stretch that is too short to filter becomes NaN.
    """
    step = step_of(log)
    if step < 2:
        return log
    rate = 1 / (log.period * step)
    columns = slow_columns(with_continuous_quaternions(log), log.period, BAND * rate / 2, step)
    text = f"{log.name}: {1 / log.period:.4g} Hz; one in {step} samples of the filtered signals is used ({rate:.4g} Hz)"
    note = Note("thinned", "info", text)
    return MotionLog(log.name, log.time[::step], columns, log.path, log.sha256, (*log.notes, note))


def slow_columns(read: Mapping[str, Array], period: float, cutoff: float, step: int) -> dict[str, Array]:
    """Every `step`th sample of columns (N,) without what is faster than `cutoff` [Hz], each around its own holes."""
    alike = dict[bytes, list[str]]()  # by where they have holes
    for name, values in read.items():
        alike.setdefault(np.packbits(np.isnan(values)).tobytes(), []).append(name)
    columns: dict[str, Array] = {}
    for names in (own[at : at + TOGETHER] for own in alike.values() for at in range(0, len(own), TOGETHER)):
        smooth = low_pass(np.column_stack([read[name] for name in names]), period, cutoff, every=step)
        columns |= dict(zip(names, np.ascontiguousarray(smooth.T), strict=True))
    for values in columns.values():
        values.setflags(write=False)  # handed over, not copied
    return {name: columns[name] for name in read}
