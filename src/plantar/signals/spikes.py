"""Lone samples far from their neighbours, as radio, buses and drivers make them: found and bridged before any filter.

After a filter a spike is a hump of the filter's length, that nothing tells from motion any more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array, Mask
from plantar.errors import clock
from plantar.logs.motion_log import MotionLog, device_of
from plantar.notes import Note, Severity
from plantar.signals.dropouts import FAR_STEPS
from plantar.signals.footfalls import footfalls
from plantar.signals.held import NOTABLE

NEIGHBOURS = 2  # on either side: a segment of more than two samples is no spike
LOCAL = 1.0  # s over which steps are compared: an impact among impacts is no spike
GROUP_GAP = 0.15  # s around a spike, or around a foot that lands or leaves
FEW = 8  # quick steps around a spike: more make an impact and what it leaves ringing
QUICK = 0.9  # quantile of the steps around landings: usual there
MOST = 0.02  # share of a column that may be spikes: more of them are what this sensor reads


def without_spikes(log: MotionLog) -> MotionLog:
    """The evenly sampled log with spikes of IMU and wrenches bridged and told of; itself where there are none.

    Not those of an orientation: its four numbers are one, of either sign, and its yaw may do what it likes.
    """
    names = [
        name
        for name, values in log.columns.items()
        if name.startswith(("imu.", "wrench."))
        and ".orientation." not in name
        and not _alike(values, log.period)
    ]
    if not names:
        return log
    landings = _landings(log)
    spikes = {name: lone_spikes(log.column(name), log.period, landings) for name in names}
    spikes = {name: places for name, places in spikes.items() if places.size}
    if not spikes:
        return log
    place, bridged, told = np.arange(len(log)), {}, []
    for name, places in spikes.items():
        column = log.column(name)
        fine = np.isfinite(column)
        fine[places] = False
        bridged[name] = column.copy()
        bridged[name][places] = np.interp(places, place[fine], column[fine])
        first = int(places[0])
        told.append(f"{name} ({places.size}, first at t = {clock(log.time[first])} s: {column[first]:.4g})")
    more = f" and {len(told) - 3} more columns" if len(told) > 3 else ""
    text = f"{log.name}: lone samples far from their neighbours bridged: {', '.join(told[:3])}{more}"
    severity: Severity = "warning" if max(map(len, spikes.values())) > NOTABLE * len(log) else "info"
    return log.with_columns(bridged, Note("spikes", severity, text))


def _alike(values: Array, period: float) -> bool:
    """Whether more than half of the steps of each second are a tenth of its largest: then none is far from the usual.

    The quick question before any median, to which clean columns of a standing robot say yes.
    """
    steps = np.abs(np.diff(values))
    width = _second(len(steps), period)
    starts = width * np.arange(len(steps) // width)
    lengths = np.diff(starts, append=len(steps))  # the last one with what is left of a second
    large = FAR_STEPS * steps > np.repeat(np.maximum.reduceat(steps, starts), lengths)
    return bool((2 * (np.add.reduceat(large, starts, dtype=np.intp) - lengths + width) > width).all())


def _second(count: int, period: float) -> int:
    """How many of `count` steps make a second, or all of them."""
    return min(count, max(8, round(LOCAL / period)))


def _landings(log: MotionLog) -> Mask:
    """Samples (N,) around those at which a foot lands or leaves: the sole's edge knocks there, on every sensor."""
    around = np.zeros(len(log), dtype=bool)
    reach = max(1, round(GROUP_GAP / log.period))
    sensors = {device_of(name) for name in log.columns if name.startswith("wrench.")}
    for sensor in sensors:
        for change in footfalls(log, sensor.removeprefix("wrench.")):
            around[max(0, change - reach) : change + reach + 2] = True
    return around


def lone_spikes(values: Array, period: float, landings: Mask | None) -> NDArray[np.intp]:
    """Samples (k,) of a column `values` (N,) that one or two alone stand out from those around them by far.

    landings: samples (N,) at which steps are compared with those at all landings.
    """
    if len(values) < 2 * NEIGHBOURS + 2:
        return np.zeros(0, dtype=np.intp)
    steps = np.abs(np.diff(values))
    usual = _usual(steps, period)
    if landings is not None and (at := landings[1:] & np.isfinite(steps)).any():
        usual[at] = np.maximum(usual[at], np.quantile(steps[at], QUICK))
    far, reach = FAR_STEPS * usual, max(NEIGHBOURS, round(GROUP_GAP / period))
    # Only where a step is far is a median worth its time: in clean columns nowhere.
    jumps = np.flatnonzero(steps > far)
    suspects = np.unique(
        np.clip(np.concatenate([jumps - 1, jumps, jumps + 1, jumps + 2]), 0, len(values) - 1)
    )
    around = suspects[:, None] + np.arange(-NEIGHBOURS, NEIGHBOURS + 1)
    inside = (around[:, 0] >= 0) & (around[:, -1] < len(values))
    suspects, around = suspects[inside], around[inside]
    away = np.abs(values[suspects] - np.median(values[around], axis=1))
    spiked = suspects[away > far[np.minimum(suspects, len(far) - 1)]]
    quick = np.flatnonzero(2 * steps > far)
    first, last = (np.searchsorted(quick, spiked + side * reach) for side in (-1, 1))
    spiked = spiked[last - first <= FEW]
    return np.asarray(spiked if len(spiked) <= MOST * len(values) else spiked[:0])


def _usual(steps: Array, period: float) -> Array:
    """Usual size of the steps (n,) around each: the largest median of this second and the ones beside it, and of all.

    A column that moves in coarse steps has them as its smallest: a change by one of those is no spike.
    """
    count, width = len(steps), _second(len(steps), period)
    filled = np.nan_to_num(steps)
    parts = np.median(filled[: count // width * width].reshape(-1, width), axis=1)
    beside = np.maximum(parts, np.maximum(np.roll(parts, 1), np.roll(parts, -1)))
    moving = filled[filled > 0]
    least = max(float(np.median(filled)), float(moving.min()) if moving.size else 0.0)
    return np.asarray(np.maximum(beside[np.minimum(np.arange(count) // width, len(beside) - 1)], least))
