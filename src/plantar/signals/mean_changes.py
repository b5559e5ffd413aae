"""Moments at which the mean of a signal changes: a jump stands out among the usual differences of its means."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.signals.segments import runs


def mean_changes(values: Array, stretch: NDArray[np.intp], width: int, far: float) -> list[int]:
    """The rows of `values` (n,) about which their mean over `width` rows changes by more than `far` times what it
    usually does, the largest change first.

    stretch: (n,), the number of the stretch that a row belongs to: no change is looked for from one to another.
    """
    if len(values) < 6 * width:
        return []
    until = np.concatenate([[0.0], np.cumsum(values)])
    means = (until[width:] - until[:-width]) / width
    apart = np.abs(means[width:] - means[:-width])
    same = stretch[2 * width - 1 :] == stretch[: len(stretch) - 2 * width + 1]
    if not same.any():
        return []
    large = np.where(same, apart, 0.0) > far * float(np.median(apart[same]))
    tops = [run.start + int(np.argmax(apart[run])) for run in runs(large)]
    return [top + width for top in sorted(tops, key=lambda top: -apart[top])]
