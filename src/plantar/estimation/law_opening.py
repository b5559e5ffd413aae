"""Where an unseen recording begins: its sensors' offset, and the state of the bush's memory, from its first
part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array, Mask
from plantar.estimation.law_fit import LawFit
from plantar.estimation.law_trials import Trial
from plantar.signals import low_pass

TRIED = np.linspace(-1.0, 1.0, 21)  # states of the memory
FORGOTTEN = 0.02  # of the span between the extreme starts' torques: below it the start no longer matters


@dataclass(frozen=True)
class Opening:
    """The recording's `offset`, and the state of the law's memory at the start of each run, `starts` (runs,).

    `settling` (N,) are the samples that told the starts: until the memory of them has faded.
    """

    offset: float
    starts: Array
    settling: Mask

    def of(self, every: Array, runs: Sequence[slice]) -> Array:
        """Of torques (m, N) for each state tried, each run's from where it began, with the offset: (N,)."""
        torque = every[len(every) // 2].copy()
        for run, start in zip(runs, self.starts, strict=True):
            torque[run] = every[int(np.argmin(np.abs(TRIED - start))), run]
        return np.asarray(torque + self.offset)


def open_runs(measured: Array, every: Array, runs: Sequence[slice], used: Mask, opening: Mask) -> Opening:
    """Where the memory began in each run of an unseen recording, and the recording's offset.

    `every` (m, N): the law's torque without offset for each of the states `TRIED`, filtered as `measured` (N,). Before
    an element slips, its state and the sensors' offset look alike; at its first slip they part. So for each state the
    offset is what is missing over the samples of `opening` (N,), and the state is the one that fits best while it
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
    return Opening(offset, starts, settling)


def open_unseen(fit: LawFit, trial: Trial, opening: Mask) -> tuple[Array, Opening]:
    """Predicted torque (N,) of an unseen recording, and where it begins; `opening` (N,) shows its offset."""
    motion = trial.motion
    measured = low_pass(trial.torque, motion.period, fit.cutoff)
    runs = fit.path_runs(motion)
    if not (fit.law.remembers and fit.law.forgets and runs):
        torque = fit.reconstruct(motion)
        offset = _offset(measured - torque, opening)
        return torque + offset, Opening(offset, np.zeros(len(runs)), np.zeros(len(motion), dtype=bool))
    every = np.array([fit.reconstruct(motion, np.full(len(runs), start)) for start in TRIED])
    found = open_runs(measured, every, runs, trial.used, opening)
    return found.of(every, runs), found


def _offset(missing: Array, opening: Mask) -> float:
    known = opening & np.isfinite(missing)
    return float(missing[known].mean()) if known.any() else 0.0


def _best(measured: Array, predicted: Array, samples: Mask) -> int:
    """Which of the predictions (m, N) fits best over `samples` (N,)."""
    known = samples & np.isfinite(measured) & np.isfinite(predicted).all(axis=0)
    if not known.any():
        return len(predicted) // 2
    return int(np.argmin(np.sum((measured[known] - predicted[:, known]) ** 2, axis=1)))
