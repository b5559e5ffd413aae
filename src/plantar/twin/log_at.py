"""A log at other times, to play it: short gaps are bridged, long ones said."""

from __future__ import annotations

from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.errors import DataError
from plantar.logs.motion_log import MotionLog

GAP: Final = 0.2  # s: what a straight line bridges


def log_at(log: MotionLog, time: Array) -> MotionLog:
    """By straight lines between samples and over gaps up to `GAP`, NaN in longer ones; the new time starts at 0."""
    columns = {name: _bridged(log.time, values, time) for name, values in log.columns.items()}
    return MotionLog(log.name, time - time[0], columns, log.path)


def check_whole(log: MotionLog, what: str, time: Array, values: Array) -> None:
    """Raise DataError where a log's values (n, ...), at times from its start (n,), have a gap."""
    gone = ~np.isfinite(values.reshape(time.size, -1)).all(axis=1)
    if gone.any():
        message = f"{what} have a gap: what is played must be recorded throughout"
        at = float(log.time[0] + time[gone.argmax()])
        raise DataError(message, path=log.source, time=at, valid=f"gaps of {GAP:g} s or less")


def _bridged(known: Array, values: Array, time: Array) -> Array:
    there = np.isfinite(values)
    if there.all() or not there.any():
        return np.asarray(np.interp(time, known, values))
    at = known[there]
    before, after = np.searchsorted(at, time, "right") - 1, np.searchsorted(at, time)
    apart = at[np.minimum(after, at.size - 1)] - at[np.maximum(before, 0)]
    apart = np.max([apart, at[0] - time, time - at[-1]], axis=0)  # the last two: before and after all of them
    return np.where(apart > GAP, np.nan, np.interp(time, at, values[there]))
