"""A straight line through days: by how much a number changes a month, and how sure that is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtr, stdtrit

from plantar.conventions import MONTH, ROUNDING, Array
from plantar.fleet.statistics.control_chart import BASELINE


@dataclass(frozen=True)
class Trend:
    """Change of a value a month with its 95 % interval, and the probability of one as large where nothing changes."""

    slope: float
    low: float
    high: float
    probability: float
    days: int


def trend_of(time: Array, values: Array, weights: Array) -> Trend | None:
    """Weighted least squares through values (n,) at days `time` (n,), the noise taken from what they miss of the line.

    weights: (n,), one over the variance of each value up to one factor. None with fewer than four days.
    """
    if len(time) < BASELINE:
        return None
    months = time / MONTH
    centred = months - weights @ months / weights.sum()
    spread = float(weights @ centred**2)
    if spread <= 0:
        return None
    slope = float(weights @ (centred * values)) / spread
    level = float(weights @ values / weights.sum())
    freedom = len(time) - 2
    missed = values - level - slope * centred
    std = float(np.sqrt(weights @ missed**2 / freedom / spread))
    rounding = ROUNDING * float(np.abs(values).max())
    if float(np.abs(missed).max()) <= rounding:
        moves = abs(slope) * float(np.ptp(months)) > rounding
        return Trend(slope, slope, slope, 0.0 if moves else 1.0, len(time))
    wide = float(stdtrit(freedom, 0.975)) * std
    probability = 2 * float(stdtr(freedom, -abs(slope) / std))
    return Trend(slope, slope - wide, slope + wide, probability, len(time))
