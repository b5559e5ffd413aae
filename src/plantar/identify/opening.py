"""Where an unseen recording begins under a law with memory: the bush's inner state at its first sample."""

from __future__ import annotations

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis, Mask
from plantar.estimation.law_opening import TRIED, open_runs
from plantar.identify.axis import AxisFit
from plantar.identify.axis_blocks import motion_of
from plantar.identify.recording import Recording
from plantar.signals import low_pass


def unseen_starts(fit: AxisFit, recording: Recording, foot: str, axis: Axis, first: Mask) -> Array | None:
    """The state (runs,) at the start of each run of an unseen recording; None for laws without memory."""
    motion = motion_of(recording, foot, axis)
    runs = motion.runs
    if not fit.law.remembers or not runs or not first.any():
        return None
    starts = np.repeat(TRIED[:, None], len(runs), axis=1)
    shapes = np.repeat(fit.shape[None, :], len(TRIED), axis=0)
    extra = fit.law.extra([motion], shapes, [starts])[0]
    memory = low_pass(np.einsum("neb,e->nb", extra, fit.values[2:]), recording.period, recording.cutoff)
    linear = np.column_stack([motion.deflection, motion.rate]) @ fit.values[:2]
    measured = recording.bushes[foot].torque[:, ROTATIONAL_AXES.index(axis)]
    return open_runs(measured, memory.T + linear, runs, recording.used(foot), first).starts
