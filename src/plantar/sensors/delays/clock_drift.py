"""Clocks that run apart: the force sensors are later at the end of a log than at its beginning."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plantar.estimation.delays.bands import HALVES
from plantar.estimation.delays.delay import Delay, Pair, closes, delay_in
from plantar.notes import Note

SURE = 4.0  # deviations by which two halves must differ
LEAST = 0.002  # s, and by so much: less is within what any search leaves


class ClockDrift(NamedTuple):
    """By which `share` of the time the clocks of force sensors and IMU run apart, over logs of up to `duration` [s]."""

    share: float
    duration: float

    @property
    def std(self) -> float:
        """Deviation of a delay [s] that grows through the log, about its mean."""
        return abs(self.share) * self.duration / float(np.sqrt(12))

    @property
    def note(self) -> Note:
        late, told = 1e3 * self.share * self.duration, f"{100 * abs(self.share):.2g} %"
        text = (
            f"the force sensors' clock and the IMU's run apart by {told}: by {abs(late):.0f} ms at the end of a log of "
            f"{self.duration:.0f} s; not corrected, and damping is unsure (valid: one clock for all columns)"
        )
        return Note("clock_drift", "warning", text)


def clock_drift(pairs: Sequence[Pair]) -> ClockDrift | None:
    """What the delays of each log's halves say; None where they do not clearly differ."""
    told = [(pair, _apart(*(_delay_of(pair, half) for half in HALVES))) for pair in pairs]
    found = [(pair, halves) for pair, halves in told if halves is not None]
    if not found:
        return None
    apart, variance = (np.array(values) for values in zip(*(halves for _, halves in found), strict=True))
    half = np.array([len(pair.predicted) * pair.period / 2 for pair, _ in found])
    weights = half / variance
    share, std = float(weights @ apart / (weights @ half)), float(1 / np.sqrt(weights @ half))
    longest = 2 * float(half.max())
    if abs(share) < SURE * std or abs(share) * longest / 2 < LEAST:
        return None
    return ClockDrift(share, longest)


def _delay_of(pair: Pair, half: int) -> Delay | None:
    """What one half of a log says of the sensors' delay."""
    middle = len(pair.predicted) // 2
    rows = slice(middle, None) if half == HALVES[1] else slice(0, middle)
    own = Pair(pair.label, pair.measured[rows], pair.rate[rows], pair.predicted[rows], pair.period)
    bands = [band.half(half) for band in pair.bands]
    return delay_in([band for band in bands if band is not None]) if closes(own) else None


def _apart(first: Delay | None, second: Delay | None) -> tuple[float, float] | None:
    """By how much the sensors are later in the second half than in the first [s], and its variance [s²]."""
    if first is None or second is None:
        return None
    return second.value - first.value, first.wide_std**2 + second.wide_std**2
