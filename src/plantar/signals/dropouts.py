"""Stretches in which a sensor reads exactly zero between jumps: its bus was silent, and the driver wrote zeros."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array, Mask
from plantar.logs.motion_log import MotionLog, device_of
from plantar.signals.segments import runs

FAR_STEPS = 10.0  # usual steps from sample to sample: what jumps by more does not belong to its neighbours
FINEST = 1e-7  # rad: smaller steps are rounding, as of a coarse encoder that stands still
LEAST = 0.01  # rad: several steps of the coarsest encoder, which reads zero wherever its joint is near it
FEWEST = 2  # stretches: a joint that was switched on has one
LOST = 0.75  # of the usual load of all force sensors: less is left where a loaded one is silent
BESIDE = 1  # samples around a stretch, that resampling may have put between the angle and zero


def dropped_samples(values: Array) -> Mask:
    """Samples (N,) of `values` (N,) in stretches of zeros that a jump leads into and out of.

    values: joint angles [rad], or sizes that are zero where a sensor is silent.
    """
    zero, dropped = values == 0, np.zeros(len(values), dtype=bool)
    inner = [run for run in runs(zero) if run.start > BESIDE and run.stop < len(values) - BESIDE]
    if len(inner) < FEWEST:
        return dropped
    near = zero.copy()
    for run in inner:
        near[run.start - BESIDE : run.stop + BESIDE] = True
    steps = np.abs(np.diff(np.where(near, np.nan, values)))
    moving = steps[steps > FINEST]
    far = max(LEAST, FAR_STEPS * float(np.median(moving)) if moving.size else 0.0)
    outside = [np.abs([values[run.start - 1 - BESIDE], values[run.stop + BESIDE]]).min() for run in inner]
    found = [run for run, away in zip(inner, outside, strict=True) if away > far]
    if len(found) < max(FEWEST, len(inner) / 2):  # a joint that passes its zero reads it too
        return dropped
    for run in found:
        dropped[run.start - BESIDE : run.stop + BESIDE] = True
    return dropped


def dropouts_of(log: MotionLog) -> dict[tuple[str, ...], Mask]:
    """`dropped_samples` (N,) of every joint's position, every IMU and every force sensor in which there are any, by the
    columns that drop out together."""
    found = dict[tuple[str, ...], Mask]()
    for name in log.columns:
        if name.startswith("joint.") and name.endswith(".position"):
            found[name,] = dropped_samples(log.column(name))
    for columns in _devices(log, "imu"):
        if any(".linear_acceleration." in name for name in columns):
            found[columns] = _silent(log, columns, ".linear_acceleration.")
    sensors = _devices(log, "wrench")
    silent = {columns: _silent(log, columns, ".force.") for columns in sensors if len(sensors) > 1}
    if any(mask.any() for mask in silent.values()):
        loads = np.sum([_size(log, columns, ".force.") for columns in sensors], axis=0)
        if np.isfinite(loads).any():
            # A foot in the air may read zero as well, but then the other one carries what it did.
            lost = loads < LOST * np.nanmedian(loads)
            found |= {columns: mask & lost for columns, mask in silent.items()}
    return {columns: mask for columns, mask in found.items() if mask.any()}


def _silent(log: MotionLog, columns: tuple[str, ...], part: str) -> Mask:
    """`dropped_samples` of a device all of whose columns read zero, by the size of a `part` that jumps when it does."""
    silent = np.ones(len(log), dtype=bool)
    for name in columns:
        silent &= log.column(name) == 0
        if not silent.any():
            return silent
    return dropped_samples(np.where(silent, 0.0, np.maximum(_size(log, columns, part), LEAST)))


def _size(log: MotionLog, columns: tuple[str, ...], part: str) -> Array:
    """Sum (N,) of the absolute values of those columns that hold `part`."""
    return np.asarray(
        np.sum([np.abs(log.column(name)) for name in columns if part in name] or [np.zeros(len(log))], axis=0)
    )


def _devices(log: MotionLog, kind: str) -> list[tuple[str, ...]]:
    """The columns of each sensor of a kind."""
    by_name = dict[str, list[str]]()
    for name in log.columns:
        if name.startswith(f"{kind}."):
            by_name.setdefault(device_of(name), []).append(name)
    return [tuple(names) for names in by_name.values()]


def without_dropouts(log: MotionLog) -> MotionLog:
    """The log with those samples as NaN; itself where there are none."""
    emptied = {
        name: np.where(mask, np.nan, log.column(name))
        for columns, mask in dropouts_of(log).items()
        for name in columns
    }
    return log.with_columns(emptied) if emptied else log
