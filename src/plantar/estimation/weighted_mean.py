"""One number from several that each claim a deviation: how well it is known, and whether they agree."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class WeightedMean(NamedTuple):
    """`value`, its deviation `std`, and how far the numbers are `apart`: the root of their mean square about it, in
    deviations that they claim."""

    value: float
    std: float
    apart: float


def weighted_mean(values: Sequence[float], stds: Sequence[float]) -> WeightedMean:
    """The mean of values (n,) by the inverse squares of their deviations (n,), all > 0 and finite; n ≥ 1.

    Where they are farther apart than they claim, its deviation is larger by as much (R. T. Birge, Physical Review 40,
    1932).
    """
    numbers, weights = np.asarray(values, dtype=np.float64), np.asarray(stds, dtype=np.float64) ** -2
    mean = float(weights @ numbers / weights.sum())
    apart = float(np.sqrt(weights @ (numbers - mean) ** 2 / max(len(numbers) - 1, 1)))
    return WeightedMean(mean, max(apart, 1.0) / float(np.sqrt(weights.sum())), apart)
