"""Samples at which a channel repeats its value though it changes nearly always: a frozen driver, a full scale.

What such a channel reads is not what happens: in a fit, a clipped torque is a softer foot.
"""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array, Mask
from plantar.logs.motion_log import MotionLog, device_of
from plantar.signals.segments import runs

SHORTEST, FEWEST = 0.2, 10  # s and samples at one value: less happens by chance
LIVELY = 0.9  # share of the other steps that change the value: of a coarse or slow channel nothing is said
# Of a usual step, the mean of so many beside a standstill: motions begin and end slowly.
SLOW, BESIDE = 0.3, 5
NOTABLE = 0.005  # share of the log
BEYOND_ROUNDING = 3.0  # times what a quaternion's length is usually off by: a number of it is wrong
ONE_STEP = 1.5  # of a scale's steps: a usual change that is smaller is one of them


def held_samples(values: Array, period: float, *, full_scale: bool = True) -> Mask:
    """Samples of `values` (N,) in stretches at one value, where these are no chance and no coarse scale, (N,).

    Where the largest or the smallest value is repeated FEWEST times, it is the channel's full scale: then every sample
    that repeats it is held, however short the stretch. `full_scale`: whether the channel has one; a unit quaternion's
    components have not.
    """
    still = (values[1:] == values[:-1]) & (values[1:] != 0)  # a foot in the air may read zero
    # Each belongs to two samples at most.
    if 2 * np.count_nonzero(still) <= NOTABLE * len(values) or coarse(values):
        return np.zeros(len(values), dtype=bool)
    least = max(FEWEST, round(SHORTEST / period))
    held = np.zeros(len(values), dtype=bool)
    limits = (np.nanmin(values), np.nanmax(values)) if full_scale and np.isfinite(values).any() else ()
    steps = np.abs(np.diff(values))
    slow = SLOW * float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0  # nor NaN
    for run in runs(still):
        if run.stop - run.start >= least and not _comes_to_rest(steps, run, slow):
            held[run.start : run.stop + 1] = True
    for limit in limits:
        stretches = runs(still & (values[1:] == limit))
        long = (run for run in stretches if run.stop - run.start >= FEWEST)
        if not all(_comes_to_rest(steps, run, slow) for run in long):
            for run in stretches:
                held[run.start : run.stop + 1] = True
    if not NOTABLE * len(values) < held.sum() < len(values):
        return np.zeros_like(held)
    others = np.diff(values)[~(held[1:] & held[:-1])]
    others = others[np.isfinite(others)]
    lively = others.size >= least and np.mean(others != 0) >= LIVELY
    return held if lively else np.zeros_like(held)


def _comes_to_rest(steps: Array, run: slice, slow: float) -> bool:
    """Whether the `steps` (n,) on either side of a `run` without any are small: so does a sensor without noise change
    whose robot stops and starts; one that freezes does not slow down before, and has missed much behind."""
    sides = [steps[max(run.start - BESIDE, 0) : run.start], steps[run.stop : run.stop + BESIDE]]
    return all(float(np.mean(side)) < slow for side in sides if side.size)


def coarse(values: Array) -> bool:
    """Whether values (N,) usually change by one step of their scale: that, and no fault, makes them stand still."""
    changes = np.abs(np.diff(values))
    changes = changes[changes > 0]  # nor NaN
    return bool(changes.size) and float(np.median(changes)) < ONE_STEP * float(changes.min())


def can_be_held(column: str) -> bool:
    """Whether a column is of an IMU or a force sensor and changes with whatever it measures.

    Joints are not: encoders read in steps, and a joint may stand. Nor is the first number of a quaternion, which is 1
    to rounding as long as the IMU is level.
    """
    return column.startswith(("imu.", "wrench.")) and not column.endswith(".orientation.w")


def held_in(log: MotionLog, column: str) -> Mask:
    """`held_samples` of one column of an evenly sampled log, (N,)."""
    held = held_samples(log.column(column), log.period, full_scale=".orientation." not in column)
    if held.any() and column.startswith("wrench."):
        held &= ~_untouched(log, device_of(column))
    if held.any() and ".orientation." in column:
        held &= _unlike_unit(log, column, held)
    return held


def _unlike_unit(log: MotionLog, column: str, held: Mask) -> Mask:
    """Samples (N,) at which a quaternion's number that is `held` fits no unit quaternion, or all others stopped too.

    A small turn, or one about one axis, leaves some of its numbers where they are.
    """
    stem = column.rpartition(".")[0]
    parts = [log.column(f"{stem}.{axis}") for axis in "wxyz"]
    off = np.abs(sum(part**2 for part in parts) - 1)
    if np.nanmedian(off[held]) > BEYOND_ROUNDING * np.nanmedian(off[~held]):
        return held
    largest = max(range(4), key=lambda place: float(np.nanmedian(np.abs(parts[place]))))
    others = [
        held_samples(part, log.period, full_scale=False) for part in parts[:largest] + parts[largest + 1 :]
    ]
    return np.asarray(np.logical_and.reduce(others))  # the largest, near 1, hardly ever changes


def _untouched(log: MotionLog, sensor: str) -> Mask:
    """Samples (N,) in which all of a force sensor's channels stand still at values to which they come back.

    That is a simulated foot in the air: it reads its zeros, the same ones in each swing. A frozen sensor holds what it
    happened to read.
    """
    channels = log.stack([name for name in log.columns if device_of(name) == sensor])
    still = np.concatenate([[False], (np.diff(channels, axis=0) == 0).all(axis=1)])
    stretches = [slice(run.start - 1, run.stop) for run in runs(still)]
    read = [tuple(channels[run.start]) for run in stretches]
    found = np.zeros(len(channels), dtype=bool)
    for run, values in zip(stretches, read, strict=True):
        found[run] = read.count(values) > 1
    return found


def without_held(log: MotionLog) -> MotionLog:
    """The log without the held samples of IMU and force sensors, which become NaN; itself where there are none."""
    emptied = {}
    for name in filter(can_be_held, log.columns):
        if (held := held_in(log, name)).any():
            emptied[name] = np.where(held, np.nan, log.column(name))
    return log.with_columns(emptied) if emptied else log
