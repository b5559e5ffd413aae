"""Initial state of a model with memory in an unseen recording, from the recording's first part."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array, Mask
from plantar.models import BESIDE, BushModel, BushMotion
from plantar.signals.filters import low_pass

TRIED = np.linspace(-1.0, 1.0, 21)  # states of the memory where a run begins
# Of the span between the torques of the extreme initial states: below it the state has faded.
FORGOTTEN = 0.02


def initial_states_of(
    model: BushModel,
    values: Array,
    shape: Array,
    motion: BushMotion,
    measured: Array,
    used: Mask,
    first_samples: Mask,
    cutoff: float,
) -> Array:
    """Initial state (runs,) of each run of an unseen motion under a model with `values` (k,) and `shape` (s,).

    `motion` and `measured` torque (N,) are filtered at `cutoff` [Hz]; `used` (N,) are fitted; `first_samples` (N,) show
    the sensors' offset.
    """
    tried = np.repeat(TRIED[:, None], len(motion.runs), axis=1)
    extra = model.basis_columns(motion, np.repeat(shape[None, :], len(TRIED), axis=0), tried)
    own = len(BESIDE)
    memory = low_pass(np.einsum("neb,e->nb", extra, values[own:]), motion.period, cutoff)
    every = memory.T + np.column_stack([motion.deflection, motion.rate]) @ values[:own]
    return _best_states(measured, every, motion.runs, used, first_samples)


def _best_states(
    measured: Array, every: Array, runs: Sequence[slice], used: Mask, first_samples: Mask
) -> Array:
    """Of the torques `every` (m, N), without offset, of the states `TRIED`: which state fits each run best.

    Before an element slips, its state and the sensors' offset look alike; at its first slip they part. So for each
    state the offset is what is missing over the samples of `first_samples`, and the state is the one that fits best
    while it matters.
    """
    span = np.abs(every[-1] - every[0])
    settling = used & (span > FORGOTTEN * max(float(np.nanmax(span, initial=0.0)), 1e-300))
    run_of = np.full(len(measured), -1)
    for place, run in enumerate(runs):
        run_of[run] = place
    first = int(run_of[np.flatnonzero(first_samples)[0]]) if first_samples.any() else 0
    offsets = np.array([_offset(measured - torque, first_samples & (run_of == first)) for torque in every])
    initial_states = np.zeros(len(runs))
    chosen = _best(measured, every + offsets[:, None], settling & (run_of == first))
    initial_states[first], offset = TRIED[chosen], float(offsets[chosen])
    for place in set(range(len(runs))) - {first}:
        initial_states[place] = TRIED[_best(measured, every + offset, settling & (run_of == place))]
    return initial_states


def _offset(missing: Array, first_samples: Mask) -> float:
    known = first_samples & np.isfinite(missing)
    return float(missing[known].mean()) if known.any() else 0.0


def _best(measured: Array, predicted: Array, samples: Mask) -> int:
    """Which of the predictions (m, N) fits best over `samples` (N,)."""
    known = samples & np.isfinite(measured) & np.isfinite(predicted).all(axis=0)
    if not known.any():
        return len(predicted) // 2
    return int(np.argmin(np.sum((measured[known] - predicted[:, known]) ** 2, axis=1)))
