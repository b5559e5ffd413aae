"""Columns that are fitted and forgotten, made orthonormal: taking them off rows is two products then."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array

RANK_TOLERANCE = 1e-9  # of a column's length: what is left of it beside those before it counts as rounding


def orthonormal(columns: Array, beside: Array | None = None) -> Array:
    """A basis (n, r) of what columns (n, m) span beside orthonormal ones (n, p); column by column, without dependent
    ones."""
    left = columns if beside is None else without(beside, without(beside, columns))
    basis, triangle = np.linalg.qr(left)
    told = np.abs(np.diag(triangle)) > RANK_TOLERANCE * np.linalg.norm(columns, axis=0)[: len(triangle)]
    return basis if told.all() else np.ascontiguousarray(basis[:, told])


def without(basis: Array, rows: Array) -> Array:
    """Rows (n, ...) without what an orthonormal basis (n, m) explains of them."""
    return np.asarray(rows - basis @ (basis.T @ rows))
