"""Variable projection: nonlinear parameters and the initial state of every run, refined together by Gauss-Newton.

At each point the linear parameters are those that fit best there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array
from plantar.model_selection.data_sets import FilteredDataSet, filtered_columns
from plantar.model_selection.grid import Fits, Pieces, grams_of, solve
from plantar.model_selection.landing import STATE, Hysteresis, landing_states
from plantar.model_selection.partialled_out import Linearised, Memory
from plantar.models import BushModel

ITERATIONS = 16  # at most, of a refinement
# Before and after landings are found: it settles parameters and offsets, on which they depend.
LANDING_ITERATIONS = 4
LANDING_GAIN = 0.01  # relative fall of the squares below which other landings gain nothing
WIDEST_SCAN, NARROWEST_SCAN, NARROWING = (
    1.0,
    0.05,
    0.2,
)  # of the initial states about where the steps came to rest
# Of a nonlinear parameter's logarithm, to either side at the widest scan: a step of the grid's.
SCANNED_RATIO = 0.25
SHARES = np.array([1.0, 0.4, 0.16, 0.064])  # of a step: the longest that is better is taken
SETTLED = 1e-4  # relative fall of the squares below which the refinement has arrived
BOLDEST = 0.4  # largest step of a nonlinear parameter's logarithm
ROUNDING = 1e-10  # of the torque's squares, in what products leave of them
# Of the differences that stand for derivatives: a share of a nonlinear parameter, and of a state's range.
SHAPE_STEP, STATE_STEP = 0.01, 0.02


@dataclass(frozen=True)
class Point:
    """Nonlinear parameters (`shape`) and initial states (runs,) of all recordings, with the linear parameters that fit
    best there, each recording's offset, and the residuals (n,)."""

    shape: Array
    initial_states: Array
    values: Array
    offsets: Array
    residuals: Array
    squares: float


@dataclass(frozen=True)
class Problem:
    """What is fitted: a model to recordings, with an offset each or a shared one.

    Samples and runs of all recordings stand one below the other.
    """

    model: BushModel
    prepared: Sequence[FilteredDataSet]
    shared_offset: bool

    @cached_property
    def rows(self) -> list[int]:
        """Used samples of each recording."""
        return [len(each.response) for each in self.prepared]

    @cached_property
    def counts(self) -> list[int]:
        """Runs of each recording."""
        return [len(each.motion.runs) for each in self.prepared]

    @cached_property
    def base(self) -> Array:
        """Deflection and rate of every used sample, (n, 2)."""
        return np.concatenate([each.base for each in self.prepared])

    @cached_property
    def response(self) -> Array:
        """The torque of every used sample, (n,)."""
        return np.concatenate([each.response for each in self.prepared])

    @cached_property
    def run(self) -> NDArray[np.intp]:
        """The run of every used sample, (n,)."""
        firsts = np.cumsum([0, *self.counts[:-1]])
        return np.concatenate(
            [first + each.run_of for first, each in zip(firsts, self.prepared, strict=True)]
        )

    @cached_property
    def lands(self) -> bool:
        """Whether a memory begins anew with every step of the foot."""
        return STATE in self.model.terms and all(each.steps is not None for each in self.prepared)

    def by_recording(self, states: Array) -> list[Array]:
        """Initial states (..., runs) of each recording."""
        return np.split(states, np.cumsum(self.counts[:-1]), axis=-1)

    def squares(self, extras: Array) -> Array:
        """What is left with each of b variants of the model's own columns (n, e, b), (b,), up to `ROUNDING`."""
        common = np.column_stack([self.base, np.ones(len(extras)), self.response])
        grams = grams_of(common, extras, np.cumsum([0, *self.rows[:-1]]))
        return solve(grams, self.shared_offset)[2]

    def at(self, shape: Array, initial_states: Array, extra: Array | None = None) -> Point:
        """Solve the linear part. extra: the model's own columns there, (n, e), if known."""
        if extra is None:
            states = self.by_recording(initial_states[None, :])
            extra = filtered_columns(self.model, self.prepared, shape[None, :], states)[:, :, 0]
        design = np.column_stack([self.base, extra])
        problem = Linearised(design, self.response, self.rows, self.shared_offset)
        values = problem.solve()
        offsets = problem.offsets(values)
        residuals = self.response - design @ values - np.repeat(offsets, self.rows)
        return Point(shape, initial_states, values, offsets, residuals, float(residuals @ residuals))

    def linearised(self, point: Point) -> Linearised:
        """Columns of values and log shape about a point, residuals as response; initial states are projected out."""
        count = len(point.shape)
        shapes = np.repeat(point.shape[None, :], 3 + 2 * count, axis=0)
        for place in range(count):
            shapes[3 + 2 * place : 5 + 2 * place, place] *= np.exp([SHAPE_STEP, -SHAPE_STEP])
        variants = np.repeat(point.initial_states[None, :], len(shapes), axis=0)
        variants[1:3] = np.clip(
            [point.initial_states + STATE_STEP, point.initial_states - STATE_STEP], -1.0, 1.0
        )
        extra = filtered_columns(self.model, self.prepared, shapes, self.by_recording(variants))
        torque = np.einsum("neb,e->nb", extra, point.values[2:])
        slopes = (torque[:, 3::2] - torque[:, 4::2]) / (2 * SHAPE_STEP)
        design = np.column_stack([self.base, extra[:, :, 0], slopes])
        memory = None
        if self.model.remembers:
            effect = (torque[:, 1] - torque[:, 2]) / (variants[1] - variants[2])[self.run]
            memory = Memory(effect, self.run, self.counts)
        return Linearised(design, point.residuals, self.rows, self.shared_offset, memory)


def best_candidate(problem: Problem, pieces: Pieces, rough: Fits) -> Point:
    """The best candidate of `pieces` by their fits: nonlinear parameters and initial states."""
    best = int(np.argmin(rough.squares))
    begin = np.zeros(sum(problem.counts))
    if problem.model.remembers:
        tried = np.concatenate(pieces.initial_states, axis=1)
        begin[pieces.run] = tried[rough.initial_states[:, best], pieces.run]
    return problem.at(pieces.shapes[best], begin)


def landed(problem: Problem, point: Point) -> Point:
    """The point with the states that the air leaves for each landing, of a foot that steps.

    What the states of all stances have in common hardly shows in any one of them: from a wrong guess no step by step
    search finds it.
    """
    states = []
    begins = problem.by_recording(point.initial_states)
    for each, begin, offset in zip(problem.prepared, begins, point.offsets, strict=True):
        bush = Hysteresis(problem.model, point.values, point.shape, float(offset))
        states.append(landing_states(bush, [each.path.deflection[run] for run in each.path.runs], begin))
    return problem.at(point.shape, np.concatenate(states))


def step(problem: Problem, point: Point, limits: Array) -> Point | None:
    """The next point of the refinement, or None where none is better."""
    linear = problem.linearised(point)
    change = linear.solve()
    move = np.clip(change[len(point.values) :], -BOLDEST, BOLDEST)
    moves = linear.initial_states(change)
    shapes = np.clip(point.shape * np.exp(SHARES[:, None] * move), limits[0], limits[1])
    states = np.clip(point.initial_states + SHARES[:, None] * moves, -1.0, 1.0)
    extras = filtered_columns(problem.model, problem.prepared, shapes, problem.by_recording(states))
    bound = point.squares + ROUNDING * float(problem.response @ problem.response)
    for place in np.flatnonzero(problem.squares(extras) < bound):
        tried = problem.at(shapes[place], states[place], extras[:, :, place])
        if tried.squares < point.squares:
            return tried
    return None


def scan_shape(problem: Problem, point: Point, limits: Array, width: float) -> Point | None:
    """The point with one nonlinear parameter at the best of several about it, or None where none is better.

    Where an element begins to slip the squares have corners too, and more than one minimum.
    """
    ratios = np.exp(width * SCANNED_RATIO * np.linspace(-1.0, 1.0, 9))
    shapes = np.array(
        [
            _with_ratio(point.shape, place, ratio, limits)
            for place in range(len(point.shape))
            for ratio in ratios[ratios != 1.0]
        ]
    )
    if not len(shapes):
        return None
    states = problem.by_recording(np.tile(point.initial_states, (len(shapes), 1)))
    extras = filtered_columns(problem.model, problem.prepared, shapes, states)
    best = int(np.argmin(problem.squares(extras)))
    tried = problem.at(shapes[best], point.initial_states, extras[:, :, best])
    return tried if tried.squares < (1 - SETTLED) * point.squares else None


def _with_ratio(shape: Array, place: int, ratio: float, limits: Array) -> Array:
    changed = shape.copy()
    changed[place] = np.clip(ratio * shape[place], limits[0, place], limits[1, place])
    return changed


def scan(problem: Problem, point: Point, width: float) -> Point | None:
    """The point with each run's initial state moved to the best of several about it, or None where none is better.

    A state that stops at its ends makes corners, at which the derivative by the initial state misleads.
    """
    around = np.linspace(-width, width, 9)
    tried = np.clip(point.initial_states + around[:, None], -1.0, 1.0)
    shapes = np.repeat(point.shape[None, :], len(around), axis=0)
    extras = filtered_columns(problem.model, problem.prepared, shapes, problem.by_recording(tried))
    linear = problem.base @ point.values[:2] + np.repeat(point.offsets, problem.rows)
    missing = (problem.response - linear)[:, None] - np.einsum("neb,e->nb", extras, point.values[2:])
    runs = tried.shape[1]
    squares = np.array([np.bincount(problem.run, column**2, runs) for column in missing.T])
    if not problem.shared_offset:  # of a recording of one run the offset follows
        sums = np.array([np.bincount(problem.run, column, runs) for column in missing.T])
        alone = np.repeat(np.equal(problem.counts, 1), problem.counts)
        squares -= np.where(alone, sums**2 / np.bincount(problem.run, minlength=runs).clip(1), 0.0)
    best = tried[np.argmin(squares, axis=0), np.arange(runs)]
    moved = problem.at(point.shape, best)
    return moved if moved.squares < (1 - SETTLED) * point.squares else None
