"""Columns that are fitted and forgotten, made orthonormal: taking them off rows is two products then.

Of columns that are slow it takes less. Sixty cosines of ten minutes hardly bend within three seconds: there each is a
polynomial, to rounding. So their products with some rows follow from those of a dozen polynomials in each stretch.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array

RANK_TOLERANCE = 1e-9  # of a column's length: what is left of it beside those before it counts as rounding
STRETCH = 0.16  # of the shortest period of a column
TERMS = 12  # of the polynomials, constant and all: what they miss of half a radian to both sides is rounding
WORTH = 3  # times as many columns as terms: fewer are taken off as they are


def orthonormal(columns: Array, beside: Array | None = None) -> Array:
    """A basis (n, r) of what columns (n, m) span beside orthonormal ones (n, p); without dependent ones."""
    left = columns if beside is None else without(beside, without(beside, columns))
    basis, triangle = np.linalg.qr(left)
    length = np.linalg.norm(columns, axis=0)
    if (np.abs(np.diag(triangle)) > RANK_TOLERANCE * length[: len(triangle)]).all():
        return basis
    # A dependent column's direction is rounding's, and would take a part of what comes behind it.
    basis, singular, _ = np.linalg.svd(left / np.where(length > 0, length, 1.0), full_matrices=False)
    return np.ascontiguousarray(basis[:, singular > RANK_TOLERANCE])


def without(basis: Array, rows: Array) -> Array:
    """Rows (n, ...) without what an orthonormal basis (n, m) explains of them."""
    return np.asarray(rows - basis @ (basis.T @ rows))


class SlowSpan:
    """The span of orthonormal columns (n, m) over times (n,) [s] that increase; none has periods below `shortest` [s].

    Few columns are taken off as they are.
    """

    def __init__(self, basis: Array, time: Array, shortest: float) -> None:
        self.basis = basis
        self._parts: tuple[NDArray[np.intp], Array, Array] | None = None
        if basis.shape[1] >= WORTH * TERMS:
            self._parts = _in_stretches(basis, time, STRETCH * shortest)

    @property
    def rows(self) -> int:
        """How many rows the columns are multiplied with."""
        return len(self.basis) if self._parts is None else len(self._parts[2])

    def off(self, rows: Array) -> Array:
        """Rows (n, k) without what the columns explain of them."""
        if self._parts is None:
            return without(self.basis, rows)
        place, terms, columns = self._parts
        count, length, size = terms.shape
        stood = np.zeros((count * length, rows.shape[1]))
        stood[place] = rows
        stretches = stood.reshape(count, length, -1)
        products = (terms.transpose(0, 2, 1) @ stretches).reshape(count * size, -1)
        explained = (columns @ (columns.T @ products)).reshape(count, size, -1)
        stretches -= terms @ explained
        return stood[place]


def _in_stretches(basis: Array, time: Array, stretch: float) -> tuple[NDArray[np.intp], Array, Array]:
    """Where each row stands (n,) among those of the stretches, these polynomials' orthonormal values (s, l, TERMS), and
    how much of each the columns hold, (s TERMS, m)."""
    from numpy.polynomial.legendre import legvander  # it costs start-up, and few logs are that long

    number = np.floor((time - time[0]) / stretch).astype(np.intp)
    _, first, counts = np.unique(number, return_index=True, return_counts=True)
    of_row = np.repeat(np.arange(len(first)), counts)
    length = int(counts.max())
    place = of_row * length + np.arange(len(time)) - first[of_row]
    share = 2 * ((time - time[0]) / stretch - number) - 1
    values = np.zeros((len(first) * length, TERMS))
    values[place] = legvander(share, TERMS - 1)
    terms = np.linalg.qr(values.reshape(len(first), length, TERMS))[0]
    stood = np.zeros((len(first) * length, basis.shape[1]))
    stood[place] = basis
    columns = terms.transpose(0, 2, 1) @ stood.reshape(len(first), length, -1)
    return place, terms, columns.reshape(-1, basis.shape[1])
