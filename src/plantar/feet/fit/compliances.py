"""What the heights of two soles tell of each foot's vertical compliance: their sum, and how alike the feet are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.estimation import interval95
from plantar.results.feet import Parameter

ALIKE = 0.15  # of the compliances' sum: usual deviation of their difference between feet of one robot


@dataclass(frozen=True)
class Compliances:
    """Sum and difference (left - right) of two feet's vertical compliances [m/N], with their covariance (2, 2).

    `alike`: share of the sum that is the usual deviation of the difference, before any data.
    """

    total: float
    difference: float
    covariance: Array
    freedom: float
    white_std: Array
    alike: float = ALIKE

    @property
    def clear(self) -> bool:
        """Whether the sum is positive beyond doubt."""
        return interval95(self.total, float(np.sqrt(self.covariance[0, 0])), self.freedom)[0] > 0

    @property
    def trust(self) -> float:
        """How far the data tell the feet apart, 0 to 1: the rest is that feet of one robot are `alike`."""
        prior = (self.alike * self.total) ** 2
        return float(prior / (prior + self.covariance[1, 1]))

    @property
    def separable(self) -> bool:
        """Whether the data, more than their likeness, tell the feet apart."""
        return self.trust > 0.5

    def of(self, side: float) -> tuple[float, float]:
        """Compliance and its std of the left (+1) or right (-1) foot; half of the sum where they do not separate."""
        gain = self.trust
        weights = np.array([0.5, 0.5 * side * gain])
        unseen = 0.25 * (1 - gain) ** 2 * (self.alike * self.total) ** 2
        return float(weights @ [self.total, self.difference]), float(
            np.sqrt(weights @ self.covariance @ weights + unseen)
        )


def share_apart(rows: Sequence[Parameter]) -> float:
    """By which share of their sum two feet's stiffnesses differ at least, in pitch or in roll, as their 95 % intervals
    leave it; 0 where these overlap."""
    least = 0.0
    for axis in ROTATIONAL_AXES:
        known = [
            row.interval95 for row in rows if (row.axis, row.name) == (axis, "stiffness") and row.interval95
        ]
        if len(known) == 2:
            softer, stiffer = sorted(known)
            low, high = stiffer[0], softer[1]
            if low > high > 0:
                least = max(least, (low - high) / (low + high))
    return least
