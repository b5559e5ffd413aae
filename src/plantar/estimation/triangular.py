"""A least-squares problem kept as its triangular factor: rows come and go, only R stays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array

RANK_TOLERANCE = 1e-10  # of the largest scaled diagonal element of R: below it a direction is not excited


@dataclass(frozen=True)
class TriangularFactor:
    """The factor R of [regressor response], (k + 1, k + 1), and how many rows it has seen.

    Factors add: `a + b` is the factor of both sets of rows, in any order, so that motions can be summed up one by one
    (eq. 7) without ever standing in memory together.
    """

    factor: Array
    rows: int

    @classmethod
    def of(cls, rows: Array) -> TriangularFactor:
        """Factor of the rows [regressor response], (n, k + 1)."""
        short = rows.shape[1] - len(rows)
        filled = np.vstack([rows, np.zeros((short, rows.shape[1]))]) if short > 0 else rows
        return cls(np.asarray(np.linalg.qr(filled, mode="r")), len(rows))

    @classmethod
    def together(cls, parts: Sequence[TriangularFactor]) -> TriangularFactor:
        """The factor of all their rows, one part or more."""
        stacked = np.vstack([part.factor for part in parts])
        return cls(np.asarray(np.linalg.qr(stacked, mode="r")), sum(part.rows for part in parts))

    def __add__(self, other: TriangularFactor) -> TriangularFactor:
        return self.together([self, other])

    def among(self, places: Array, size: int) -> TriangularFactor:
        """The same rows as part of a problem with `size` parameters, of which these are the ones at `places` (k,)."""
        wide = np.zeros((len(self.factor), size + 1))
        wide[:, [*places, size]] = self.factor
        return TriangularFactor(np.vstack([wide, np.zeros((size - self.size, size + 1))]), self.rows)

    @property
    def size(self) -> int:
        """Number of parameters k."""
        return len(self.factor) - 1

    @property
    def residual_norm(self) -> float:
        """Norm of the residual of the least-squares solution."""
        return float(abs(self.factor[-1, -1]))

    def _scaled(self) -> tuple[Array, Array]:
        triangle = self.factor[:-1, :-1]
        scale = np.linalg.norm(triangle, axis=0)
        return triangle / np.where(scale > 0, scale, 1.0), np.where(scale > 0, scale, 1.0)

    @property
    def condition_number(self) -> float:
        """Condition of the regressor with its columns scaled to one length; inf where it is singular."""
        values = np.linalg.svd(self._scaled()[0], compute_uv=False)
        return float(values[0] / values[-1]) if values.size and values[-1] > 0 else float("inf")

    @property
    def rank(self) -> int:
        """How many directions of the parameters the rows excite."""
        values = np.linalg.svd(self._scaled()[0], compute_uv=False)
        return int(np.sum(values > RANK_TOLERANCE * max(values[0], 1e-300))) if values.size else 0

    def solve(self) -> Array:
        """The least-squares parameters (k,); of minimum norm in scaled columns where the rank is short."""
        triangle, scale = self._scaled()
        solution = np.linalg.lstsq(triangle, self.factor[:-1, -1], rcond=RANK_TOLERANCE)[0]
        return np.asarray(solution / scale)

    def information_inverse(self) -> Array:
        """(RᵀR)⁻¹, (k, k): the parameters' covariance for unit residuals; the pseudo-inverse where singular."""
        triangle, scale = self._scaled()
        inverse = np.linalg.pinv(triangle, rcond=RANK_TOLERANCE) / scale[:, None]
        return np.asarray(inverse @ inverse.T)
