"""Least squares by products of columns: at a fraction of a QR's time, for what need not be known to the last digits."""

from __future__ import annotations

import numpy as np

from plantar.conventions import ROUNDING, Array


def solved(products: Array, right: Array) -> Array:
    """Sizes (m,) or (m, k) of columns from their products (m, m) with each other and with what they explain, `right`;
    where columns depend on each other, the smallest ones."""
    length = np.sqrt(np.diag(products))
    length[length == 0] = 1.0
    told, turn = np.linalg.eigh(products / np.outer(length, length))
    clear = told > ROUNDING * np.max(told, initial=0.0)
    axes = turn[:, clear] / length[:, None]
    return np.asarray((axes / told[clear]) @ (axes.T @ right))
