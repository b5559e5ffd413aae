"""Least squares from products of columns with each other, of which some are solved for beside the others."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array


class Beside(NamedTuple):
    """Products of what is missing and its columns beside other columns, which are solved for: `products` (parts,
    k + 1, k + 1), and `shares` (others, k + 1), by which each of the others is taken off what stands beside it."""

    products: Array
    shares: Array


def beside(products: Sequence[Array], weights: Array, deviations: Array) -> Beside:
    """Beside the last columns of `products`, (k + 1 + others, ...) of each part, times its own of `weights` (parts,);
    coefficients of these columns are drawn towards nothing with `deviations` (others,)."""
    kept = len(products[0]) - len(deviations)
    total: Array = np.zeros_like(products[0])
    # One by one: those of all logs together take tens of megabytes.
    for part, weight in zip(products, weights, strict=True):
        total += weight * part
    known = np.diag(deviations**-2.0)
    others, with_kept = _positive(total[kept:, kept:], total[kept:, :kept], deviations)
    share = np.linalg.solve(others + known, with_kept)
    left = np.vstack([np.eye(kept), -share])
    # What the others' own priors say against a share of them belongs to all parts alike.
    alike = share.T @ known @ share / len(products)
    own = [weight * (left.T @ part @ left) + alike for part, weight in zip(products, weights, strict=True)]
    return Beside(np.array(own), np.asarray(-share))


def coefficients(products: Array, deviations: Array) -> Array:
    """The solution (k,) of products (k + 1, k + 1) of what is missing and its columns, drawn towards nothing with
    `deviations` (k,)."""
    columns, with_missing = _positive(products[1:, 1:], products[1:, 0], deviations)
    return np.asarray(np.linalg.solve(columns + np.diag(deviations**-2.0), with_missing))


def information(products: Array, deviations: Array) -> Array:
    """What products (k + 1, k + 1) and `deviations` (k,) say of the coefficients, (k, k): inverse, their covariance."""
    return _positive(products[1:, 1:], products[1:, 0], deviations)[0] + np.diag(deviations**-2.0)


def _positive(products: Array, others: Array, deviations: Array) -> tuple[Array, Array]:
    """The nearest products (k, k) that real columns can have, as noise taken off may leave less than nothing, and their
    products with `others` (k, ...): nothing where nothing is left of the columns. Near is what `deviations` (k,) call
    so: columns have units of their own."""
    with suppress(np.linalg.LinAlgError):  # raised where less is left
        np.linalg.cholesky(products)
        return products, others
    sizes, vectors = np.linalg.eigh(products * np.outer(deviations, deviations))
    real = vectors[:, sizes > 0]
    scaled = real / deviations[:, None]
    kept = real.T * deviations
    return np.asarray((scaled * sizes[sizes > 0]) @ scaled.T), np.asarray(scaled @ (kept @ others))
