"""Segments: runs of consecutive samples that hold, and their ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Mask


def runs(valid: Mask) -> list[slice]:
    """The segments of consecutive true samples, as slices."""
    if valid.size and valid.all():
        return [slice(0, len(valid))]
    edges = np.flatnonzero(np.diff(np.concatenate([[False], valid, [False]]).astype(np.int8)))
    return [slice(int(start), int(stop)) for start, stop in edges.reshape(-1, 2)]


def longest_run(valid: Mask) -> slice:
    """The longest of `runs`, empty where there is none."""
    return max(runs(valid), key=lambda run: run.stop - run.start, default=slice(0, 0))


def run_numbers(valid: Mask) -> NDArray[np.intp]:
    """The place among `runs` of each sample, (N,), -1 outside."""
    number = np.full(len(valid), -1, dtype=np.intp)
    for place, run in enumerate(runs(valid)):
        number[run] = place
    return number


def run_ends(valid: Mask, reach: int) -> Mask:
    """The first and last `reach` samples of every run: where a filter knew only one side."""
    ends = np.zeros(len(valid), dtype=bool)
    for run in runs(valid):
        ends[run.start : min(run.stop, run.start + reach)] = True
        ends[max(run.start, run.stop - reach) : run.stop] = True
    return ends


def steps_in(seconds: float, period: float) -> int:
    """How many samples a time takes, at least one: of a slow log, a short time is the next sample."""
    return max(1, round(seconds / period))
