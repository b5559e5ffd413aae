"""Variable projection: nonlinear parameters and the initial state of every run, refined together by Gauss-Newton.

At each point the linear parameters are those that fit best there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.model_selection.data_sets import FilteredDataSet, filtered_columns
from plantar.model_selection.grid import Pieces, fit_pieces
from plantar.model_selection.landing import STATE, Hysteresis, landing_states
from plantar.model_selection.partialled_out import Linearised
from plantar.models import BushModel

ITERATIONS = 16
LANDINGS = 3  # times that the states at landings are found anew with better parameters
WIDEST_SCAN, NARROWEST_SCAN, NARROWING = (
    1.0,
    0.05,
    0.2,
)  # of the initial states about where the steps came to rest
SCANNED_RATIO = (
    0.25  # of a nonlinear parameter's logarithm, to either side at the widest scan: a step of the grid's
)
HALVINGS = 4
SETTLED = 1e-4  # relative fall of the squares below which the refinement has arrived
BOLDEST = 0.4  # largest step of a nonlinear parameter's logarithm
SHAPE_STEP, STATE_STEP = 0.01, 0.02  # of the differences that stand for derivatives


@dataclass(frozen=True)
class Point:
    """Nonlinear parameters (`shape`) and initial states, with the linear parameters that fit best there."""

    shape: Array
    initial_states: list[Array]
    values: Array
    offsets: Array
    residuals: list[Array]
    squares: float


@dataclass(frozen=True)
class Problem:
    """What is fitted: a model to recordings, with an offset each or a shared one."""

    model: BushModel
    prepared: Sequence[FilteredDataSet]
    shared_offset: bool

    def at(self, shape: Array, initial_states: list[Array], extras: Sequence[Array] | None = None) -> Point:
        """Solve the linear part. extras: the model's own columns there, (n, e, 1) of each recording, if known."""
        if extras is None:
            starts = [start[None, :] for start in initial_states]
            extras = filtered_columns(self.model, self.prepared, shape[None, :], starts)
        designs = [np.column_stack([e.base, x[:, :, 0]]) for e, x in zip(self.prepared, extras, strict=True)]
        problem = Linearised(designs, [e.response for e in self.prepared], self.shared_offset)
        values = problem.solve()
        offsets = problem.offsets(values)
        residuals = [y - x @ values - o for x, y, o in zip(designs, problem.responses, offsets, strict=True)]
        return Point(shape, initial_states, values, offsets, residuals, float(sum(r @ r for r in residuals)))

    def linearised(self, point: Point) -> Linearised:
        """Columns of values and log shape about a point, residuals as response; initial states are projected out."""
        model, shape, count = self.model, point.shape, len(point.shape)
        shapes = np.repeat(shape[None, :], 3 + 2 * count, axis=0)
        for place in range(count):
            shapes[3 + 2 * place : 5 + 2 * place, place] *= np.exp([SHAPE_STEP, -SHAPE_STEP])
        initial_states = []
        for start in point.initial_states:
            variants = np.repeat(start[None, :], len(shapes), axis=0)
            variants[1:3] = np.clip([start + STATE_STEP, start - STATE_STEP], -1.0, 1.0)
            initial_states.append(variants)
        extras = filtered_columns(model, self.prepared, shapes, initial_states)
        designs, memories = [], []
        for each, extra, variants in zip(self.prepared, extras, initial_states, strict=True):
            torque = np.einsum("neb,e->nb", extra, point.values[2:])
            slopes = (torque[:, 3::2] - torque[:, 4::2]) / (2 * SHAPE_STEP)
            designs.append(np.column_stack([each.base, extra[:, :, 0], slopes]))
            width = (variants[1] - variants[2])[each.run_of]
            memories.append((torque[:, 1] - torque[:, 2]) / width)
        runs = [each.run_of for each in self.prepared]
        if not model.remembers:
            return Linearised(designs, point.residuals, self.shared_offset)
        counts = [len(each.motion.runs) for each in self.prepared]
        return Linearised(designs, point.residuals, self.shared_offset, memories, runs, counts)


def best_candidate(problem: Problem, pieces: Pieces) -> Point:
    """The best candidate of `pieces`: nonlinear parameters and initial states."""
    rough = fit_pieces(pieces, np.ones(len(pieces.grams), dtype=bool), shared_offset=problem.shared_offset)
    best = int(np.argmin(rough.squares))
    begin = [np.zeros(len(each.motion.runs)) for each in problem.prepared]
    if problem.model.remembers:
        runs = np.concatenate([[0], np.cumsum([len(each) for each in begin])])
        for data_set, run, start in zip(
            pieces.data_set, pieces.run, rough.initial_states[:, best], strict=True
        ):
            begin[data_set][run - runs[data_set]] = pieces.initial_states[data_set][
                start, run - runs[data_set]
            ]
    return problem.at(pieces.shapes[best], begin)


def landed(problem: Problem, point: Point) -> Point | None:
    """The point with the states that the air leaves for each landing; None for a foot that does not step.

    What the states of all stances have in common hardly shows in any one of them: from a wrong guess no step by step
    search finds it.
    """
    if STATE not in problem.model.terms or any(each.steps is None for each in problem.prepared):
        return None
    states = []
    for each, begin, offset in zip(problem.prepared, point.initial_states, point.offsets, strict=True):
        bush = Hysteresis(problem.model, point.values, point.shape, float(offset))
        states.append(landing_states(bush, [each.path.deflection[run] for run in each.path.runs], begin))
    return problem.at(point.shape, states)


def step(problem: Problem, point: Point, limits: Array) -> Point | None:
    """The next point of the refinement, or None where none is better."""
    linear = problem.linearised(point)
    change = linear.solve()
    move = np.clip(change[len(point.values) :], -BOLDEST, BOLDEST)
    moves = linear.initial_states(change)
    share = 1.0
    for _ in range(HALVINGS):
        shape = np.clip(point.shape * np.exp(share * move), limits[0], limits[1])
        initial_states = [
            np.clip(s + share * m, -1.0, 1.0) for s, m in zip(point.initial_states, moves, strict=True)
        ]
        tried = problem.at(shape, initial_states)
        if tried.squares < point.squares:
            return tried
        share *= 0.4
    return None


def scan_shape(problem: Problem, point: Point, limits: Array, width: float) -> Point | None:
    """The point with one nonlinear parameter at the best of several about it, or None where none is better.

    Where an element begins to slip the squares have corners too, and more than one minimum.
    """
    ratios = np.exp(width * SCANNED_RATIO * np.linspace(-1.0, 1.0, 9))
    shapes = [
        _with_ratio(point.shape, place, ratio, limits)
        for place in range(len(point.shape))
        for ratio in ratios[ratios != 1.0]
    ]
    if not shapes:
        return None
    starts = [np.tile(start, (len(shapes), 1)) for start in point.initial_states]
    extras = filtered_columns(problem.model, problem.prepared, np.array(shapes), starts)
    tried = [
        problem.at(shape, point.initial_states, [extra[:, :, place, None] for extra in extras])
        for place, shape in enumerate(shapes)
    ]
    best = min(tried, key=lambda each: each.squares, default=point)
    return best if best.squares < (1 - SETTLED) * point.squares else None


def _with_ratio(shape: Array, place: int, ratio: float, limits: Array) -> Array:
    changed = shape.copy()
    changed[place] = np.clip(ratio * shape[place], limits[0, place], limits[1, place])
    return changed


def scan(problem: Problem, point: Point, width: float) -> Point | None:
    """The point with each run's initial state moved to the best of several about it, or None where none is better.

    A state that stops at its ends makes corners, at which the derivative by the initial state misleads.
    """
    around = np.linspace(-width, width, 9)
    initial_states = [np.clip(start[None, :] + around[:, None], -1.0, 1.0) for start in point.initial_states]
    shapes = np.repeat(point.shape[None, :], len(around), axis=0)
    extras = filtered_columns(problem.model, problem.prepared, shapes, initial_states)
    best = []
    for place, (each, extra, tried) in enumerate(zip(problem.prepared, extras, initial_states, strict=True)):
        linear = each.base @ point.values[:2] + point.offsets[place]
        missing = each.response[:, None] - linear[:, None] - np.einsum("neb,e->nb", extra, point.values[2:])
        if tried.shape[1] == 1 and not problem.shared_offset:
            missing = missing - missing.mean(axis=0)
        squares = np.array([np.bincount(each.run_of, column**2, tried.shape[1]) for column in missing.T])
        best.append(tried[np.argmin(squares, axis=0), np.arange(tried.shape[1])])
    moved = problem.at(point.shape, best)
    return moved if moved.squares < (1 - SETTLED) * point.squares else None
