"""Where an unseen recording begins under a law with memory: the bush's inner state, from the recording's first part."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array, Mask
from plantar.models import BESIDE, Law, Motion
from plantar.signals.filters import low_pass

TRIED = np.linspace(-1.0, 1.0, 21)  # states of the memory
FORGOTTEN = 0.02  # of the span between the extreme starts' torques: below it the start no longer matters


def opening_states(
    law: Law,
    values: Array,
    shape: Array,
    motion: Motion,
    measured: Array,
    used: Mask,
    opening: Mask,
    cutoff: float,
) -> Array:
    """The state (runs,) at the start of each run of an unseen motion under a law with parameters (k,) and shape (s,).

    `motion` and `measured` torque (N,) are filtered at `cutoff` [Hz]; `used` (N,) serve, those of `opening` (N,) show
    the sensors' offset.
    """
    tried = np.repeat(TRIED[:, None], len(motion.runs), axis=1)
    extra = law.extra([motion], np.repeat(shape[None, :], len(TRIED), axis=0), [tried])[0]
    own = len(BESIDE)
    memory = low_pass(np.einsum("neb,e->nb", extra, values[own:]), motion.period, cutoff)
    every = memory.T + np.column_stack([motion.deflection, motion.rate]) @ values[:own]
    return _best_starts(measured, every, motion.runs, used, opening)


def _best_starts(measured: Array, every: Array, runs: Sequence[slice], used: Mask, opening: Mask) -> Array:
    """Of the torques `every` (m, N), without offset, of the states `TRIED`: which state fits each run best.

    Before an element slips, its state and the sensors' offset look alike; at its first slip they part. So for each
    state the offset is what is missing over the samples of `opening`, and the state is the one that fits best while it
    matters.
    """
    span = np.abs(every[-1] - every[0])
    settling = used & (span > FORGOTTEN * max(float(np.nanmax(span, initial=0.0)), 1e-300))
    run_of = np.full(len(measured), -1)
    for place, run in enumerate(runs):
        run_of[run] = place
    first = int(run_of[np.flatnonzero(opening)[0]]) if opening.any() else 0
    offsets = np.array([_offset(measured - torque, opening & (run_of == first)) for torque in every])
    starts = np.zeros(len(runs))
    chosen = _best(measured, every + offsets[:, None], settling & (run_of == first))
    starts[first], offset = TRIED[chosen], float(offsets[chosen])
    for place in set(range(len(runs))) - {first}:
        starts[place] = TRIED[_best(measured, every + offset, settling & (run_of == place))]
    return starts


def _offset(missing: Array, opening: Mask) -> float:
    known = opening & np.isfinite(missing)
    return float(missing[known].mean()) if known.any() else 0.0


def _best(measured: Array, predicted: Array, samples: Mask) -> int:
    """Which of the predictions (m, N) fits best over `samples` (N,)."""
    known = samples & np.isfinite(measured) & np.isfinite(predicted).all(axis=0)
    if not known.any():
        return len(predicted) // 2
    return int(np.argmin(np.sum((measured[known] - predicted[:, known]) ** 2, axis=1)))
