"""The stances of a foot that steps: short, many, each with a landing, a load that ramps, and zeros of its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.contact.phases import FootContact
from plantar.conventions import Array
from plantar.signals.segments import runs

FEWEST_STANCES = 3  # in one recording: a robot that walks; fewer are a robot that stands and shifts its feet
LONGEST_STANCE = 5.0  # s, their median: in longer ones a foot moves as in any standing motion, and drifts


@dataclass(frozen=True)
class Stances:
    """One foot's stances through a walk: `number` (N,) of each sample, -1 in the air; `weight` (N,) from 0 to 1.

    A sample weighs as much as the foot carries: what the ground moves by does not grow with the load, while what the
    bush says does.
    """

    number: NDArray[np.intp]
    weight: Array

    @property
    def count(self) -> int:
        return int(self.number.max(initial=-1)) + 1


def stances_of(contact: FootContact, force: Array, weight: float, period: float) -> Stances | None:
    """The stances of a foot that steps, None for one that does not.

    force: vertical, (N,) [N]; weight: the robot's [N].
    """
    found = runs(contact.loaded)
    seconds = [(run.stop - run.start) * period for run in found]
    if len(found) < FEWEST_STANCES or np.median(seconds) > LONGEST_STANCE:
        return None
    number = np.full(len(force), -1, dtype=np.intp)
    for place, run in enumerate(found):
        number[run] = place
    return Stances(number, np.clip(np.nan_to_num(force) / weight, 0.0, 1.0))
