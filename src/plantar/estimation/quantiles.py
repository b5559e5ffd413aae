"""Quantiles of Student's and Fisher's distributions; a library's would cost start-up."""

from __future__ import annotations

from functools import cache, lru_cache
from math import cos, exp, inf, lgamma, pi, pow, sqrt

import numpy as np

from plantar.conventions import Array

MOST_FREEDOM = 1e6  # stands for a deviation that is known
NODES = 48  # of the quadrature: exact to rounding for shares up to 0.999
STEPS = 50  # of Newton's method; a dozen do


@lru_cache(maxsize=1024)
def student_quantile(share: float, freedom: float) -> float:
    """The value below which `share` (0.5 to 0.999) of Student's distribution with `freedom` ≥ 1 lies.

    With t = √freedom · tan θ the density of θ is ∝ cos(θ)^(freedom - 1). Its integral from 0 is concave, so that
    Newton's steps from 0 never pass the root.
    """
    freedom = min(freedom, MOST_FREEDOM)
    density = exp(lgamma((freedom + 1) / 2) - lgamma(freedom / 2)) / sqrt(pi)
    nodes, weights = _nodes()
    angle, step = 0.0, inf
    for _ in range(STEPS):
        within = (
            angle / 2 * density * float(np.sum(weights * np.cos(angle / 2 * (1 + nodes)) ** (freedom - 1)))
        )
        step = (share - 0.5 - within) / (density * cos(angle) ** (freedom - 1))
        angle += step
        if abs(step) <= 1e-15 * angle:
            break
    return sqrt(freedom) * float(np.tan(angle))


def fisher_quantile(share: float, count: int, freedom: float) -> float:
    """The value below which `share` of Fisher's distribution of one or two values, `count`, over `freedom` lies."""
    if count == 1:
        return student_quantile((1 + share) / 2, freedom) ** 2
    return freedom / 2 * (pow(1 - share, -2 / freedom) - 1)


@cache
def _nodes() -> tuple[Array, Array]:
    """Places in (-1, 1) and weights of Gauss and Legendre's quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    return nodes, weights
