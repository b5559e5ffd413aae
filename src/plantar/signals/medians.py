"""Medians as NumPy gives them, at a fraction of its time: one place of the order is looked for instead of three."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array


def median(values: Array) -> Array:
    """Median along the last axis of values (..., n), which must be finite and at least one."""
    rows = np.array(values, order="C")
    middle = rows.shape[-1] // 2
    rows.partition(middle, axis=-1)
    upper = rows[..., middle]
    return np.asarray(upper if rows.shape[-1] % 2 else (upper + rows[..., :middle].max(axis=-1)) / 2)


def running_median(values: Array, window: int) -> Array:
    """Median of each `window` (odd) of values (n,) in a row, (n - window + 1,)."""
    return median(np.lib.stride_tricks.sliding_window_view(values, window))
