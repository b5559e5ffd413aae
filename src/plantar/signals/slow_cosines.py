"""Signals without their slow cosines: a projection, where a filter hangs all of a short segment on its two ends."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from plantar.conventions import Array

KEPT = 2  # lengths whose cosines are: groups of one log's signals ask one after the other


def without_slow_cosines(rows: Array, period: float, slowest: float) -> Array:
    """Rows (n, k), `period` [s] apart, without their cosines from a constant up to a frequency `slowest` [Hz]."""
    cosines = _cosines(len(rows), round(2 * slowest * len(rows) * period) + 1)
    return np.asarray(rows - cosines @ (cosines.T @ rows))


@lru_cache(maxsize=KEPT)
def _cosines(rows: int, count: int) -> Array:
    """The slowest cosines (rows, count), orthonormal."""
    cosines = np.cos(np.pi * np.arange(count) * (np.arange(rows)[:, None] + 0.5) / rows)
    return np.asarray(cosines / np.linalg.norm(cosines, axis=0))
