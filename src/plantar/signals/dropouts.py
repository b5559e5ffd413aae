"""Stretches in which an encoder reads exactly zero between jumps: its bus was silent, and the driver wrote zeros."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array, Mask
from plantar.logs.motion_log import MotionLog
from plantar.signals.segments import runs

FAR_STEPS = 10.0  # usual steps from sample to sample, by which the angle must jump: no joint moves so
FINEST = 1e-7  # rad: smaller steps are rounding, as of a coarse encoder that stands still
LEAST = 0.01  # rad: several steps of the coarsest encoder, which reads zero wherever its joint is near it
FEWEST = 2  # stretches: a joint that was switched on has one
BESIDE = 1  # samples around a stretch, that resampling may have put between the angle and zero


def dropped_samples(values: Array) -> Mask:
    """Samples of joint angles `values` (N,) [rad] in stretches of zeros that a jump leads into and out of, (N,)."""
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


def dropouts_of(log: MotionLog) -> dict[str, Mask]:
    """`dropped_samples` (N,) of every joint's position column in which there are any."""
    columns = [name for name in log.columns if name.startswith("joint.") and name.endswith(".position")]
    found = {name: dropped_samples(log.column(name)) for name in columns}
    return {name: mask for name, mask in found.items() if mask.any()}


def without_dropouts(log: MotionLog) -> MotionLog:
    """The log with those samples as NaN; itself where there are none."""
    found = dropouts_of(log)
    emptied = {name: np.where(mask, np.nan, log.column(name)) for name, mask in found.items()}
    return log.with_columns(emptied) if emptied else log
