"""Segments: runs of consecutive samples that hold, and their ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array, Mask


def complete(*values: Array) -> Mask:
    """The samples (N,) at which no number of `values`, (N, k) each, is NaN or infinite."""
    with np.errstate(invalid="ignore", over="ignore"):  # one sum of each sample says what its values would
        return np.asarray(np.isfinite(sum(part @ np.ones(part.shape[1]) for part in values)))


def runs(valid: Mask) -> list[slice]:
    """The segments of consecutive true samples, as slices."""
    return [slice(start, stop) for start, stop in _edges(valid).reshape(-1, 2).tolist()]


def _edges(valid: Mask) -> NDArray[np.intp]:
    """Where runs start and stop, in turn."""
    changes = np.flatnonzero(valid[1:] != valid[:-1]) + 1
    return np.concatenate(
        [[0] * bool(valid[:1].any()), changes, [len(valid)] * bool(valid[-1:].any())]
    ).astype(np.intp)


def longest_run(valid: Mask) -> slice:
    """The longest of `runs`, empty where there is none."""
    edges = _edges(valid)
    if not edges.size:
        return slice(0, 0)
    longest = int(np.argmax(edges[1::2] - edges[::2]))
    return slice(int(edges[2 * longest]), int(edges[2 * longest + 1]))


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


def spread_out(rows: NDArray[np.intp], most: int) -> NDArray[np.intp]:
    """About `most` of the rows (n,), evenly spread over them; all where they are fewer than twice as many."""
    return rows[:: max(1, rows.size // most)]


def steps_in(seconds: float, period: float) -> int:
    """How many samples a time takes, at least one: of a slow log, a short time is the next sample."""
    return max(1, round(seconds / period))
