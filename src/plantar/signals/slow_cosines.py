"""Signals without their slow cosines: a projection, where a filter hangs all of a short segment on its two ends."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from plantar.conventions import Array

FEW = 32  # cosines up to which products with them take less than a transform
KEPT = 2  # lengths whose cosines are: groups of one log's signals ask one after the other


def without_slow_cosines(rows: Array, period: float, slowest: float) -> Array:
    """Rows (n, k), `period` [s] apart, without their cosines from a constant up to a frequency `slowest` [Hz]."""
    count = round(2 * slowest * len(rows) * period) + 1
    if count <= FEW:
        cosines = _cosines(len(rows), count)
        return np.asarray(rows - cosines @ (cosines.T @ rows))
    # Mirrored at its end a signal has the same cosines, as the lowest frequencies of its Fourier transform.
    columns = np.ascontiguousarray(rows.T)
    spectrum = np.fft.rfft(np.concatenate([columns, columns[:, ::-1]], axis=1))
    spectrum[:, :count] = 0.0
    return np.asarray(np.fft.irfft(spectrum, 2 * len(rows))[:, : len(rows)].T)


@lru_cache(maxsize=KEPT)
def _cosines(rows: int, count: int) -> Array:
    """The slowest cosines (rows, count), orthonormal."""
    cosines = np.cos(np.pi * np.arange(count) * (np.arange(rows)[:, None] + 0.5) / rows)
    return np.asarray(cosines / np.linalg.norm(cosines, axis=0))
