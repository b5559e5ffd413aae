"""Least squares that stream, and what may be believed of them."""

from plantar.estimation.blocks import Block, LinearFit
from plantar.estimation.least_squares import fit_linear
from plantar.estimation.linear import effect_of, fit_blocks, influences_of, least_left
from plantar.estimation.residual_covariance import interval95, relative_std_percent
from plantar.estimation.triangular import TriangularFactor

__all__ = [
    "Block",
    "LinearFit",
    "TriangularFactor",
    "effect_of",
    "fit_blocks",
    "fit_linear",
    "influences_of",
    "interval95",
    "least_left",
    "relative_std_percent",
]
