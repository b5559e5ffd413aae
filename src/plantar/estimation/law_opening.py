"""Where an unseen recording begins: its sensors' offset, and the state of the bush's memory, from its first
part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array, Mask
from plantar.estimation.law_fit import LawFit
from plantar.estimation.law_trials import Trial
from plantar.signals import low_pass

TRIED = np.linspace(-1.0, 1.0, 21)
FORGOTTEN = 0.02  # of the span between the extreme starts' torques: below it the start no longer matters


@dataclass(frozen=True)
class Opening:
    """`predicted` torque (N,) of an unseen recording, its `offset` in it; `starts` (runs,) of the law's
    memory.

    `settling` (N,) are the samples that told the starts: until the memory of them has faded.
    """

    predicted: Array
    offset: float
    starts: Array
    settling: Mask


def open_unseen(fit: LawFit, trial: Trial, opening: Mask) -> Opening:
    """Predict an unseen recording; its offset is the mean that is missing over the samples of `opening` (N,).

    Before an element slips, its state and the sensors' offset look alike; at its first slip they part. So the
    start of every run is the one that fits best while it still matters, and the offset follows from it.
    """
    motion, cutoff = trial.motion, fit.cutoff
    measured = low_pass(trial.torque, motion.period, cutoff)
    runs = fit.path_runs(motion)
    count = len(runs)
    if not (fit.law.remembers and fit.law.forgets) or count == 0:
        torque = fit.reconstruct(motion)
        offset = _offset(measured - torque, opening)
        return Opening(torque + offset, offset, np.zeros(count), np.zeros(len(motion), dtype=bool))
    every = np.array([fit.reconstruct(motion, np.full(count, start)) for start in TRIED])
    span = np.abs(every[-1] - every[0])
    settling = trial.used & (span > FORGOTTEN * max(float(np.nanmax(span, initial=0.0)), 1e-300))
    run_of = np.full(len(motion), -1)
    for place, run in enumerate(runs):
        run_of[run] = place
    first = int(run_of[np.flatnonzero(opening)[0]]) if opening.any() else 0
    offsets = np.array([_offset(measured - torque, opening & (run_of == first)) for torque in every])
    starts = np.zeros(count)
    chosen = _best(measured, every + offsets[:, None], settling & (run_of == first))
    starts[first], offset = TRIED[chosen], float(offsets[chosen])
    torque = every[chosen].copy()
    for place in set(range(count)) - {first}:
        mine = run_of == place
        chosen = _best(measured, every + offset, settling & mine)
        starts[place], torque[mine] = TRIED[chosen], every[chosen][mine]
    return Opening(torque + offset, offset, starts, settling)


def _offset(missing: Array, opening: Mask) -> float:
    known = opening & np.isfinite(missing)
    return float(missing[known].mean()) if known.any() else 0.0


def _best(measured: Array, predicted: Array, samples: Mask) -> int:
    """Which of the predictions (m, N) fits best over `samples` (N,)."""
    known = samples & np.isfinite(measured) & np.isfinite(predicted).all(axis=0)
    if not known.any():
        return len(predicted) // 2
    return int(np.argmin(np.sum((measured[known] - predicted[:, known]) ** 2, axis=1)))
