"""The stances of a foot that steps: short, many, each with a landing, a load that ramps, and zeros of its own."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plantar.contact.phases import SETTLING_SHARE, FootContact
from plantar.contact.polygon import inside_distance
from plantar.conventions import Array
from plantar.signals.segments import runs

FEWEST_STANCES = 3  # in one recording: a robot that walks; fewer are a robot that stands and shifts its feet
# Usual stances, as long as one offset may last: a robot that stands before it walks drifts meanwhile.
LONG_STANCE = 2.0
ROLLING_SHARE = 0.1  # of the sole's half width: a centre of pressure so near to the outline may roll about it
LONGEST_STANCE = 5.0  # s, their median: in longer ones a foot moves as in any standing motion, and drifts


@dataclass(frozen=True)
class Stances:
    """One foot's stances through a walk: `number` (N,) of each sample, -1 in the air; `weight` (N,) from 0 to 1.

    A stance far longer than usual, before the first step and after the last, counts as several.

    A sample weighs as much as the foot carries: what the ground moves by does not grow with the load, while what the
    bush says does.
    """

    number: NDArray[np.intp]
    weight: Array

    @property
    def count(self) -> int:
        return int(self.number.max(initial=-1)) + 1

    def readings(self, wrench: Array) -> float:
        """How often the force sensor, `wrench` (N, 6), reads another value in a usual stance."""
        changed = np.append(True, np.any(wrench[1:] != wrench[:-1], axis=1))
        inside = self.number >= 0
        return (
            float(np.median(np.bincount(self.number[inside], changed[inside], self.count)))
            if inside.any()
            else 0.0
        )


def stances_of(contact: FootContact, force: Array, weight: float, period: float) -> Stances | None:
    """The stances of a foot that steps, None for one that does not.

    force: vertical, (N,) [N]; weight: the robot's [N].
    """
    found = runs(contact.loaded)
    usual = float(np.median([run.stop - run.start for run in found])) if found else 0.0
    if len(found) < FEWEST_STANCES or usual * period > LONGEST_STANCE:
        return None
    number = np.full(len(force), -1, dtype=np.intp)
    for run in found:
        parts = max(1, round((run.stop - run.start) / (LONG_STANCE * usual)))
        for part in np.array_split(np.arange(run.start, run.stop), parts):
            number[part] = number.max() + 1
    return Stances(number, np.clip(np.nan_to_num(force) / weight, 0.0, 1.0))


def without_rolling(stances: Stances, cop: Array, polygon: Array) -> Stances:
    """The stances without the samples in which the sole rolls on its outline as it lands and lifts.

    A heel that strikes leans by milliradians, which a filter would carry far into the stance. cop: centre of pressure
    in the sole's frame, (N, 2) [m]; polygon: the sole's corners, (n, 2) [m]. At most SETTLING_SHARE of a stance goes at
    either end, which no fit uses anyway.
    """
    depth = inside_distance(cop, polygon)
    middle = inside_distance(polygon.mean(axis=0)[None], polygon)
    flat = np.nan_to_num(depth, nan=-1.0) > ROLLING_SHARE * float(middle[0])
    number = stances.number.copy()
    for run in runs(number >= 0):
        rows = np.arange(run.start, run.stop)
        most = int(SETTLING_SHARE * len(rows))
        for end in (rows[:most], rows[len(rows) - most :][::-1]):
            rolls = np.flatnonzero(~flat[end])
            number[end[: rolls[-1] + 1 if rolls.size else 0]] = -1
    return replace(stances, number=number)
