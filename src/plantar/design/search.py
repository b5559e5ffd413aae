"""The best motion of a family within its limits: from linear program to linear program."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
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
TRIES: Final = 25  # steps from each start at most
# After so many steps the best of all ways are followed to their ends: what is far behind by then stays so.
TRIED: Final = 8
FOLLOWED: Final = 3
SMALL: Final = 1e-3  # of a coefficient that is just allowed: what a slope is taken over
BEGIN, SMALLEST, FARTHEST = 0.3, 0.01, 0.3  # how far a step goes, of coefficients that are just allowed
# The same from a motion that was rehearsed: what that showed of limits, unknown to the linear robot, holds near it.
NEAR: Final = 0.1
# Motions beside one whose values are computed together: ten minutes of them fit into memory
AT_ONCE: Final = 2
# Programs of one step at most: each knows, beside what the motion comes near, the limits that the one before passed.
# So few of thousands make a program quick.
CUTS: Final = 10
CLOSE: Final = 0.3  # of a limit: those that a step watches
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
    known: Array | float,
    progress: Callable[[str], None],
) -> tuple[int, Lines, Array]:
    """Place of the stance, lines of a motion of `duration` [s], each beginning's own, and coefficients (size,) of the
    best one within the limits of its stance on its lines; beginnings take the stances in turn. `known` as in
    `half_widths`.

    Limits are linear in the coefficients, but for rubber that slips, and there are many: a small sole bends far only
    where load, ankles and trunk go together. So each step goes as far down the slope of what is minimised as all
    limits and a box around the motion allow, which is a linear program.
    """

    def followed(place: int, tries: int, far: float = BEGIN, motion: Array | None = None) -> _Way:
        random = np.random.default_rng([seed, place])
        lines, stance = Lines.drawn(duration, random), place % len(stances)
        reach = stances[stance](lines)
        units = 1.0 / reach.alone()
        climb = _Climb(
            reach, criterion, known, units, _start(random) * units if motion is None else motion, far
        )
        climb.go(tries)
        return _Way(climb.least, place, climb.far, lines, climb.best)

    progress(f"search from {STARTS} beginnings")
    ways = over_cores(lambda place: followed(place, TRIED), range(STARTS))
    best = sorted(ways, key=lambda way: way.least)[:FOLLOWED]
    progress(f"search on from the best {len(best)}")
    ends = over_cores(lambda way: followed(way.place, TRIES - TRIED, way.far, way.motion), best)
    way = min([*ends, *best], key=lambda way: way.least)
    return way.place % len(stances), way.lines, way.motion


def better_motion(reach: Reach, criterion: Criterion, start: Array, known: Array | float) -> Array:
    """The same from one beginning, a motion that is known, where limits are no longer what they were: a few small
    steps."""
    climb = _Climb(reach, criterion, known, 1.0 / reach.alone(), start, NEAR, NEAR)
    climb.go(TRIED)
    return climb.best


@dataclass(frozen=True)
class _Way:
    """How far a way from one beginning came: what is minimised there, which beginning, how far the next step goes."""

    least: float
    place: int
    far: float
    lines: Lines
    motion: Array


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
        self,
        reach: Reach,
        criterion: Criterion,
        known: Array | float,
        units: Array,
        start: Array,
        far: float,
        farthest: float = FARTHEST,
    ) -> None:
        self._reach, self._units, self.far, self._farthest = reach, units, far, farthest
        self._criterion, self._known = criterion, known
        self._at(start / reach.used(start))
        self.least = float(self._value(self.best))

    def _at(self, motion: Array) -> None:
        """The best motion is another: its slope is yet to be found, and so are the limits that it comes near."""
        self.best = motion
        self._slope: Array | None = None
        self._close = self._reach.close(motion, CLOSE)

    def _value(self, coefficients: Array) -> Array:
        return badness(self._reach, coefficients, self._criterion, self._known)

    def go(self, tries: int) -> None:
        """So many steps at most."""
        for _ in range(tries):
            if self.far <= SMALLEST:
                break
            self._step()

    def _step(self) -> None:
        """To a better motion, or none: then the next step is smaller."""
        if self._slope is None:
            beside = self.best + np.diag(SMALL * self._units)
            parts = np.split(beside, range(AT_ONCE, len(beside), AT_ONCE))
            self._slope = np.concatenate(over_cores(self._value, parts)) - self.least
        tried, (rows, left) = self.best, self._close.near(self.best)
        for _ in range(CUTS):
            box, room = (-self.far, self.far), np.maximum(left, 0.0)
            found = linprog(self._slope / SMALL, A_ub=rows * self._units, b_ub=room, bounds=box)
            if not found.success:
                break
            tried = self.best + self._units * found.x
            more, room = self._close.near(tried, 1.0)
            if room.min(initial=0.0) > -SLIGHT:
                break
            rows, left = np.vstack([rows, more]), np.append(left, room + more @ (tried - self.best))
        tried = tried / max(self._reach.used(tried), 1.0)
        value = float(self._value(tried))
        if value < self.least:
            self._at(tried)
            self.least, self.far = value, min(GROW * self.far, self._farthest)
        else:
            self.far *= SHRINK
