"""The best motion of a family within its limits: from linear program to linear program."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from scipy.optimize import linprog

from plantar.conventions import Array
from plantar.cores import over_cores
from plantar.design.family import CHANNELS, SHAPES, Lines
from plantar.design.information import Criterion, badness
from plantar.design.reach import Reach

# Of which the best end counts: limits have corners in which a way ends, and some frequencies go badly together.
STARTS: Final = 8
TRIES: Final = 25  # linear programs from each start at most
SMALL: Final = 1e-3  # of a coefficient that is just allowed: what a slope is taken over
BEGIN, SMALLEST, FARTHEST = 0.5, 0.01, 1.0  # how far a step goes, of coefficients that are just allowed
# Motions beside one whose values are computed together: ten minutes of them fit into memory
AT_ONCE: Final = 10
# Programs of one step at most: each knows, beside what the motion comes near, the limits that the one before passed.
# So few of thousands make a program quick.
CUTS: Final = 10
PASSED: Final = 1.0  # of a limit
SLIGHT: Final = 0.01  # over a limit: the motion is made smaller by as much
GROW, SHRINK = 1.5, 0.4  # of that, after a step that helped and one that did not
# Where the search begins: over the left foot, whose ankle moves more than the other and than the body.
START: Final = {"left": 1.0, "right": 0.3}
BODY: Final = 0.1
LOADED: Final = 1.0


def best_motion(
    stances: Sequence[Callable[[Lines], Reach]],
    duration: float,
    criterion: Criterion,
    seed: int,
    known: Array | float = 0.0,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[int, Lines, Array]:
    """Place of the stance, lines of a motion of `duration` [s], each beginning's own, and coefficients (size,) of the
    best one within the limits of its stance on its lines; beginnings take the stances in turn. `known` as in
    `half_widths`.

    Limits are linear in the coefficients, but for rubber that slips, and there are many: a small sole bends far only
    where load, ankles and trunk go together. So each step goes as far down the slope of what is minimised as all
    limits and a box around the motion allow, which is a linear program.
    """

    def end(place: int) -> tuple[float, int, Lines, Array]:
        random = np.random.default_rng([seed, place])
        lines, stance = Lines.drawn(duration, random), place % len(stances)
        reach = stances[stance](lines)
        least, found = _end(reach, criterion, _start(random) / _alone(reach), known)
        return least, stance, lines, found

    progress(f"search from {STARTS} beginnings")
    _, stance, lines, coefficients = min(over_cores(end, range(STARTS)), key=lambda found: found[0])
    return stance, lines, coefficients


def better_motion(reach: Reach, criterion: Criterion, start: Array, known: Array | float = 0.0) -> Array:
    """The same from one beginning, a motion that is known, where limits are no longer what they were."""
    return _end(reach, criterion, start, known)[1]


def _end(reach: Reach, criterion: Criterion, start: Array, known: Array | float) -> tuple[float, Array]:
    """What is minimised where a way through the limits ends, and the motion there."""
    climb = _Climb(reach, criterion, known, 1.0 / _alone(reach), start)
    for _ in range(TRIES):
        if not climb.step():
            break
    return climb.least, climb.best


def _alone(reach: Reach) -> Array:
    """What one unit of each coefficient alone uses of the limits, (size,)."""
    return np.array([reach.used(row) for row in np.eye(reach.lines.size)])


def _start(random: np.random.Generator) -> Array:
    """Coefficients (size,) as shares of what is just allowed of each alone."""
    shape = random.standard_normal((len(CHANNELS), SHAPES)) * [
        [START.get(channel.split(".")[0], BODY)] for channel in CHANNELS
    ]
    shape[CHANNELS.index("centre.y"), 0] = LOADED
    return np.asarray(shape.ravel())


class _Climb:
    """One way through the limits: `best`, the motion reached, and `least`, what is minimised there."""

    def __init__(
        self, reach: Reach, criterion: Criterion, known: Array | float, units: Array, start: Array
    ) -> None:
        self._reach, self._units, self._far = reach, units, BEGIN
        self._criterion, self._known = criterion, known
        self._slope: Array | None = None  # at the best motion, once known
        self.best = start / reach.used(start)
        self.least = float(self._value(self.best))

    def _value(self, coefficients: Array) -> Array:
        return badness(self._reach, coefficients, self._criterion, self._known)

    def step(self) -> bool:
        """To a better motion, or none: then the next step is smaller. Whether another may help."""
        if self._slope is None:
            beside = self.best + np.diag(SMALL * self._units)
            parts = np.split(beside, range(AT_ONCE, len(beside), AT_ONCE))
            self._slope = np.concatenate([self._value(part) for part in parts]) - self.least
        rows, left = self._reach.near(self.best)
        tried, used = self.best, 1.0
        for _ in range(CUTS):
            found = linprog(
                self._slope / SMALL,
                A_ub=rows * self._units,
                b_ub=np.maximum(left, 0.0),
                bounds=(-self._far, self._far),
            )
            if not found.success:
                break
            tried = self.best + self._units * found.x
            more, room = self._reach.near(tried, PASSED)
            used = 1.0 - room.min(initial=0.0)
            if used < 1.0 + SLIGHT:
                break
            rows, left = np.vstack([rows, more]), np.append(left, room + more @ (tried - self.best))
        tried = tried / used
        value = float(self._value(tried))
        if value < self.least:
            self.best, self.least, self._slope = tried, value, None
            self._far = min(GROW * self._far, FARTHEST)
        else:
            self._far *= SHRINK
        return self._far > SMALLEST
