"""Where an unseen recording begins under a law with memory: the bush's inner state at its first sample."""

from __future__ import annotations

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis, Mask
from plantar.identify.axis_fit import AxisFit, motion_of
from plantar.identify.recording import Recording
from plantar.signals import low_pass

TRIED = np.linspace(-1.0, 1.0, 15)  # states of the memory
FADED = 0.02  # of the widest span between the states' torques: below it the start no longer matters


def unseen_starts(fit: AxisFit, recording: Recording, foot: str, axis: Axis, first: Mask) -> Array | None:
    """The state (runs,) at the start of each run of an unseen recording; None for laws without memory.

    Before an element slips, its state and the sensors' offset look alike; at its first slip they part. So for every
    state the offset is what is missing over `first` (N,), and the state is the one that fits best while it matters.
    """
    motion = motion_of(recording, foot, axis)
    if not fit.law.remembers or not motion.runs or not first.any():
        return None
    starts = np.repeat(TRIED[:, None], len(motion.runs), axis=1)
    shapes = np.repeat(fit.shape[None, :], len(TRIED), axis=0)
    extra = fit.law.extra([motion], shapes, [starts])[0]
    torque = low_pass(np.einsum("neb,e->nb", extra, fit.values[2:]), recording.period, recording.cutoff)
    linear = np.column_stack([motion.deflection, motion.rate]) @ fit.values[:2]
    missing = recording.bushes[foot].torque[:, ROTATIONAL_AXES.index(axis)] - linear
    error = missing[:, None] - torque
    error = error - np.nanmean(error[first], axis=0)
    span = np.ptp(torque, axis=1)
    matters = (
        recording.used(foot) & (span > FADED * np.nanmax(span, initial=0.0)) & np.isfinite(error).all(axis=1)
    )
    if not matters.any():
        return None
    best = int(np.argmin(np.sum(error[matters] ** 2, axis=0)))
    return np.asarray(starts[best])
