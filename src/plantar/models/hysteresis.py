"""Rate-independent memory: a state z in [-1, 1] that depends on the path of the deflection, not on its speed.

Between two turning points of the path, z runs along one curve, mirrored for the way back; so the only
sequential work is from turning point to turning point, and everything between them is computed at once.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.models.bush_model import BESIDE, BushModel, BushMotion, reach

SMALLEST_SLIP_ANGLE = 0.02  # of the reach: below it the element looks like dry friction
LARGEST_SLIP_ANGLE = 1.3  # of the reach: an element that hardly slips looks like a spring
SURE_SLIP_ANGLE = 0.8  # of the reach: beyond it few turns make the element slip, if any but the first
# Slip angles that are tried, a quarter apart, and closer where few turns are as long: of coarser ones the best led to
# another minimum.
RARE = 0.5  # of the reach
TRIED, TRIED_RARE = 14, 14


@dataclass(frozen=True)
class Branches:
    """Runs of deflection cut at their turning points, packed side by side; T branches at most, r runs, n samples.

    `direction` (T, r) is ±1 in turn; `length` (T, r) the way from turning point to turning point [rad], zero after the
    last. For each sample of each run, `branch` (n, r) and `travelled` (n, r), the way since that branch began.
    """

    direction: Array
    length: Array
    branch: NDArray[np.intp]
    travelled: Array

    @classmethod
    def of(cls, paths: Sequence[Array]) -> Branches:
        """Cut every path (n_i,) where it turns back."""
        cut = [_turning_points(path) for path in paths]
        count, samples = max(len(turns) for turns, _ in cut), max(len(path) for path in paths)
        direction, length = np.ones((count, len(paths))), np.zeros((count, len(paths)))
        branch, travelled = np.zeros((samples, len(paths)), dtype=np.intp), np.zeros((samples, len(paths)))
        for column, (path, (turns, first)) in enumerate(zip(paths, cut, strict=True)):
            ends = np.append(turns[1:], len(path) - 1)
            direction[:, column] = first * (-1.0) ** np.arange(count)
            length[: len(turns), column] = np.abs(path[ends] - path[turns])
            place = np.searchsorted(turns, np.arange(len(path)), side="right") - 1
            branch[: len(path), column] = place
            travelled[: len(path), column] = np.abs(path - path[turns[place]])
        return cls(direction, length, branch, travelled)


@lru_cache(maxsize=32)
def _branches_of(motions: tuple[BushMotion, ...]) -> Branches:
    """The branches of all runs of these motions: a fit asks for them again with each of its steps."""
    return Branches.of([motion.deflection[run] for motion in motions for run in motion.runs])


def _turning_points(path: Array) -> tuple[NDArray[np.intp], float]:
    """Where each monotonic branch begins, and the first branch's direction. A pause belongs to the branch before."""
    step = np.sign(np.diff(path))
    moving = np.flatnonzero(step)
    if moving.size == 0:
        return np.zeros(1, dtype=np.intp), 1.0
    turned = moving[1:][step[moving[1:]] != step[moving[:-1]]]
    return np.concatenate([[0], turned]).astype(np.intp), float(step[moving[0]])


class Hysteretic(BushModel):
    """torque = K·q + C·q̇ + slip_torque·z + offset: an element beside the spring that yields around `slip_angle`.

    Before it yields it is a spring of slip_torque / slip_angle. The initial state of a run is z there.
    """

    terms: ClassVar[tuple[str, ...]] = (*BESIDE, "slip_torque")
    shape_terms: ClassVar[tuple[str, ...]] = ("slip_angle",)
    remembers: ClassVar[bool] = True
    tried_states: ClassVar[tuple[float, ...]] = (-0.9, -0.45, 0.0, 0.45, 0.9)
    blind_ends: ClassVar[frozenset[tuple[str, str]]] = frozenset({("slip_angle", "high")})
    dissipative_terms: ClassVar[tuple[str, ...]] = ("slip_torque",)
    units: ClassVar[dict[str, tuple[str, str]]] = {"slip_torque": ("N.m", "N"), "slip_angle": ("rad", "m")}

    @abstractmethod
    def states(self, branches: Branches, shapes: Array, initial_states: Array) -> Array:
        """z (n, r, b) along r runs, for b variants of shape (b, s) and initial state (r, b)."""

    def candidates(self, motions: Sequence[BushMotion]) -> Array:
        """Slip angles in equal ratios, from what looks like dry friction to what hardly slips in these motions."""
        size = reach(motions) or 1.0
        usual = np.geomspace(SMALLEST_SLIP_ANGLE, RARE, TRIED)
        rare = np.linspace(RARE, LARGEST_SLIP_ANGLE, TRIED_RARE + 1)[1:]
        return size * np.concatenate([usual, rare])[:, None]

    def hardly_shown(self, shape: Array, limits: Array) -> str | None:
        """Where few turns of the path, if any, are as long as it takes to slip."""
        sure = limits[1, 0] * SURE_SLIP_ANGLE / LARGEST_SLIP_ANGLE
        return f"slip_angle {shape[0]:.3g} is hardly reached by these motions" if shape[0] > sure else None

    def initial_states(self, motion: BushMotion, shape: Array) -> Array:
        """State of an element that was loaded from rest to where each run begins."""
        first = np.array([motion.deflection[run.start] for run in motion.runs])
        return np.asarray(np.clip(first / shape[0], -1.0, 1.0))

    def basis_columns(
        self, motions: Sequence[BushMotion], shapes: Array, initial_states: Sequence[Array]
    ) -> list[Array]:
        """The state z, (N, 1, b)."""
        places = [(m, run) for m, motion in enumerate(motions) for run in motion.runs]
        columns = [np.full((len(motion), 1, len(shapes)), np.nan) for motion in motions]
        if places:
            branches = _branches_of(tuple(motions))
            state = self.states(branches, shapes, np.concatenate([start.T for start in initial_states]))
            for column, (m, run) in enumerate(places):
                columns[m][run, 0] = state[: run.stop - run.start, column]
        return columns
