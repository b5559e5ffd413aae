"""Fit of a law of the bush that is linear in all but its shape: the shape outside, linear least squares
inside.

The search over the shape is in `law_search`; here it is refined together with the unknown start of the law's
memory in every run (Gauss-Newton on the variable projection), and everything that had to be estimated enters
the intervals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from plantar.conventions import Array
from plantar.errors import DataError
from plantar.estimation.intervals import interval95
from plantar.estimation.law_influence import Linearised, robust_covariance
from plantar.estimation.law_search import Pieces, fit_pieces
from plantar.estimation.law_trials import Prepared, Trial, filtered_columns, prepare_trials
from plantar.models import Law, Motion

ITERATIONS = 16
WIDEST_SCAN, NARROWEST_SCAN, NARROWING = 0.4, 0.05, 0.25  # of the starts about where the steps came to rest
HALVINGS = 4
SETTLED = 1e-4  # relative fall of the squares below which the refinement has arrived
BOLDEST = 0.4  # largest step of a shape's logarithm
SHAPE_STEP, START_STEP = 0.01, 0.02  # of the differences that stand for derivatives
AT_LIMIT = 0.02  # of a shape: so near to its range's end it counts as there
HARDLY_KNOWN = 0.5  # a standard deviation beyond this share of the value


@dataclass(frozen=True)
class LawFit:
    """A law fitted to several recordings.

    `values` (k,) as `law.terms`, `shape` (s,) as `law.shape_terms`, `covariance` (k + s, same) of both with
    coloured residuals, the shape's and the starts' uncertainty inside; `freedom` (k + s,) goes with it,
    `white_std` (k + s,) is the paper's. `offsets`, `offset_std`, `starts` (runs,) and `residuals` (of the
    thinned samples that served) by recording. `limits` (2, s) is the range that the motions let the shape be
    looked for in.
    """

    law: Law
    values: Array
    shape: Array
    covariance: Array
    freedom: Array
    white_std: Array
    offsets: dict[str, float]
    offset_std: dict[str, float]
    starts: dict[str, Array]
    residuals: dict[str, Array]
    limits: Array
    cutoff: float
    shared_offset: bool

    @property
    def std(self) -> Array:
        """Standard deviations of values and shape, (k + s,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of values and shape."""
        return (*self.law.terms, *self.law.shape_terms)

    @property
    def rms(self) -> float:
        """Root mean square of the residuals [N·m]."""
        return float(np.sqrt(np.mean(np.concatenate(list(self.residuals.values())) ** 2)))

    def value(self, name: str) -> float:
        """A parameter by its name."""
        return float(np.append(self.values, self.shape)[self.names.index(name)])

    def interval95(self, name: str) -> tuple[float, float]:
        """A parameter's 95 % interval."""
        place = self.names.index(name)
        return interval95(self.value(name), float(self.std[place]), float(self.freedom[place]))

    @property
    def doubts(self) -> tuple[str, ...]:
        """Why the law's own terms are not to be trusted, one line each; empty where they are."""
        found = []
        for place, term in enumerate(self.law.shape_terms):
            low, high = self.limits[:, place]
            value = self.shape[place]
            if (term, "high") in self.law.blind_ends and value > (1 - AT_LIMIT) * high:
                found.append(f"{term} lies at or beyond {high:.3g}, the largest that these motions can show")
            if (term, "low") in self.law.blind_ends and value < (1 + AT_LIMIT) * low:
                found.append(f"{term} lies at or below {low:.3g}, the smallest that these motions can show")
        for term in self.law.dissipative_terms:
            place = self.names.index(term)
            if not self.std[place] < HARDLY_KNOWN * abs(self.value(term)):
                found.append(
                    f"{term} is known to {self.std[place]:.2g} only, at a value of {self.value(term):.3g}"
                )
        return tuple(found)

    def reconstruct(self, motion: Motion, starts: Array | None = None) -> Array:
        """Torque (N,) without offset along a motion, filtered as in the fit; NaN outside its runs.

        `starts` (runs of `path_runs`): where the memory begins, `Law.starts` where not given.
        """
        prepared = self._path(motion)
        path = prepared.motion
        if not path.runs:
            return np.full(len(motion), np.nan)
        starts = self.law.starts(path, self.shape) if starts is None else starts
        extra = filtered_columns(self.law, [prepared], self.shape[None, :], [starts[None, :]])[0]
        torque = np.full(len(path), np.nan)
        torque[prepared.used] = np.column_stack([prepared.base, extra[:, :, 0]]) @ self.values
        return _spread(torque, path, motion)

    def path_runs(self, motion: Motion) -> list[slice]:
        """The motion's runs that are long enough to filter, as slices of its own samples."""
        path = self._path(motion).motion
        stride = round(path.period / motion.period)
        return [slice(run.start * stride, min(run.stop * stride, len(motion))) for run in path.runs]

    def _path(self, motion: Motion) -> Prepared:
        everywhere = np.ones(len(motion), dtype=bool)
        trial = Trial("", motion, np.zeros(len(motion)), everywhere)
        return Prepared.of(trial.thinned(self.cutoff), self.cutoff)


def fit_law(law: Law, trials: Sequence[Trial], cutoff: float = 5.0, *, shared_offset: bool = False) -> LawFit:
    """Least squares of the trials' torques under `law`, both sides filtered at `cutoff` [Hz].

    One offset for each recording, or with `shared_offset` one for all. Raises DataError where no sample
    serves.
    """
    prepared = prepare_trials(trials, cutoff)
    if not prepared:
        raise DataError(
            "no recording has a sample that serves this fit (valid: at least one standing second)"
        )
    folds = [np.zeros(int(each.used.sum()), dtype=np.intp) for each in prepared]
    shapes = law.candidates([each.motion for each in prepared])
    limits = np.array([shapes.min(axis=0), shapes.max(axis=0)])
    return refine(Pieces.of(law, prepared, folds, shapes), prepared, limits, shared_offset=shared_offset)


def refine(
    pieces: Pieces, prepared: Sequence[Prepared], limits: Array, *, shared_offset: bool = False
) -> LawFit:
    """The fit that starts from the best candidate of `pieces` and keeps the shape between `limits` (2, s)."""
    law, shapes = pieces.law, pieces.shapes
    rough = fit_pieces(pieces, np.ones(len(pieces.grams), dtype=bool), shared_offset=shared_offset)
    best = int(np.argmin(rough.squares))
    begin = [np.zeros(len(each.motion.runs)) for each in prepared]
    if law.remembers:
        runs = np.concatenate([[0], np.cumsum([len(each) for each in begin])])
        for trial, run, start in zip(pieces.trial, pieces.run, rough.starts[:, best], strict=True):
            begin[trial][run - runs[trial]] = pieces.starts[trial][start, run - runs[trial]]
    problem = _Problem(law, prepared, shared_offset)
    point = problem.at(shapes[best], begin)
    width = WIDEST_SCAN
    for _ in range(ITERATIONS if shapes.shape[1] or law.remembers else 0):
        moved = _step(problem, point, limits)
        if moved is None or moved.squares > (1 - SETTLED) * point.squares:
            scanned = _scan(problem, moved or point, width) if law.remembers else None
            width *= NARROWING
            if scanned is None and (not law.remembers or width < NARROWEST_SCAN):
                point = moved or point
                break
            moved = scanned or moved or point
        point = moved
    return _finished(problem, point, limits)


@dataclass(frozen=True)
class _Point:
    """A shape and starts, with the linear parameters that fit best there."""

    shape: Array
    starts: list[Array]
    values: Array
    offsets: Array
    residuals: list[Array]
    squares: float


@dataclass(frozen=True)
class _Problem:
    law: Law
    prepared: Sequence[Prepared]
    shared_offset: bool

    def at(self, shape: Array, starts: list[Array]) -> _Point:
        """Solve the linear part."""
        extras = filtered_columns(
            self.law, self.prepared, shape[None, :], [start[None, :] for start in starts]
        )
        designs = [np.column_stack([e.base, x[:, :, 0]]) for e, x in zip(self.prepared, extras, strict=True)]
        problem = Linearised(designs, [e.response[e.used] for e in self.prepared], self.shared_offset)
        values = problem.solve()
        offsets = problem.offsets(values)
        residuals = [y - x @ values - o for x, y, o in zip(designs, problem.responses, offsets, strict=True)]
        return _Point(shape, starts, values, offsets, residuals, float(sum(r @ r for r in residuals)))

    def linearised(self, point: _Point) -> Linearised:
        """Columns of values and log shape about a point, residuals as response, starts to be projected
        out."""
        law, shape, count = self.law, point.shape, len(point.shape)
        shapes = np.repeat(shape[None, :], 3 + 2 * count, axis=0)
        for place in range(count):
            shapes[3 + 2 * place : 5 + 2 * place, place] *= np.exp([SHAPE_STEP, -SHAPE_STEP])
        starts = []
        for start in point.starts:
            variants = np.repeat(start[None, :], len(shapes), axis=0)
            variants[1:3] = np.clip([start + START_STEP, start - START_STEP], -1.0, 1.0)
            starts.append(variants)
        extras = filtered_columns(law, self.prepared, shapes, starts)
        designs, memories = [], []
        for each, extra, variants in zip(self.prepared, extras, starts, strict=True):
            torque = np.einsum("neb,e->nb", extra, point.values[2:])
            slopes = (torque[:, 3::2] - torque[:, 4::2]) / (2 * SHAPE_STEP)
            designs.append(np.column_stack([each.base, extra[:, :, 0], slopes]))
            width = (variants[1] - variants[2])[each.run_of]
            memories.append((torque[:, 1] - torque[:, 2]) / width)
        runs = [each.run_of for each in self.prepared]
        if not law.remembers:
            return Linearised(designs, point.residuals, self.shared_offset)
        return Linearised(designs, point.residuals, self.shared_offset, memories, runs)


def _step(problem: _Problem, point: _Point, limits: Array) -> _Point | None:
    """The next point of the refinement, or None where none is better."""
    linear = problem.linearised(point)
    change = linear.solve()
    move = np.clip(change[len(point.values) :], -BOLDEST, BOLDEST)
    moves = linear.starts(change)
    share = 1.0
    for _ in range(HALVINGS):
        shape = np.clip(point.shape * np.exp(share * move), limits[0], limits[1])
        starts = [np.clip(s + share * m, -1.0, 1.0) for s, m in zip(point.starts, moves, strict=True)]
        tried = problem.at(shape, starts)
        if tried.squares < point.squares:
            return tried
        share *= 0.4
    return None


def _scan(problem: _Problem, point: _Point, width: float) -> _Point | None:
    """The point with each run's start moved to the best of several about it, or None where none is better.

    A state that stops at its ends makes corners, at which the derivative by the start misleads.
    """
    around = np.linspace(-width, width, 9)
    starts = [np.clip(start[None, :] + around[:, None], -1.0, 1.0) for start in point.starts]
    shapes = np.repeat(point.shape[None, :], len(around), axis=0)
    extras = filtered_columns(problem.law, problem.prepared, shapes, starts)
    best = []
    for place, (each, extra, tried) in enumerate(zip(problem.prepared, extras, starts, strict=True)):
        linear = each.base @ point.values[:2] + point.offsets[place]
        missing = each.response[each.used][:, None] - linear[:, None] - np.einsum("neb,e->nb", extra, point.values[2:])
        if tried.shape[1] == 1 and not problem.shared_offset:
            missing = missing - missing.mean(axis=0)
        squares = np.array([np.bincount(each.run_of, column**2, tried.shape[1]) for column in missing.T])
        best.append(tried[np.argmin(squares, axis=0), np.arange(tried.shape[1])])
    moved = problem.at(point.shape, best)
    return moved if moved.squares < (1 - SETTLED) * point.squares else None


def _finished(problem: _Problem, point: _Point, limits: Array) -> LawFit:
    linear = problem.linearised(point)
    scale = np.concatenate([np.ones(len(point.values)), point.shape])
    durations = [len(r) * e.motion.period for e, r in zip(problem.prepared, point.residuals, strict=True)]
    covariance, freedom = robust_covariance(linear, point.residuals, durations)
    wide = np.concatenate([scale, np.ones(len(covariance) - len(scale))])
    covariance = covariance * wide[:, None] * wide[None, :]
    count, rows = len(scale), sum(len(residual) for residual in point.residuals)
    white = point.squares / max(rows - len(covariance), 1) * linear.inverse_diagonal() * scale**2
    labels = [each.label for each in problem.prepared]
    spread = np.sqrt(np.diag(covariance)[count:])
    return LawFit(
        law=problem.law,
        values=point.values,
        shape=point.shape,
        covariance=covariance[:count, :count],
        freedom=freedom[:count],
        white_std=np.sqrt(white),
        offsets=dict(zip(labels, point.offsets.tolist(), strict=True)),
        offset_std=dict(zip(labels, spread.tolist(), strict=True)),
        starts=dict(zip(labels, point.starts, strict=True)),
        residuals=dict(zip(labels, point.residuals, strict=True)),
        limits=limits,
        cutoff=problem.prepared[0].cutoff,
        shared_offset=problem.shared_offset,
    )


def _spread(torque: Array, thin: Motion, motion: Motion) -> Array:
    """A torque on the thinned samples, put back onto all samples of the motion's runs."""
    if len(thin) == len(motion):
        return torque
    result = np.full(len(motion), np.nan)
    at, dense = thin.period * np.arange(len(thin)), motion.period * np.arange(len(motion))
    for run in motion.runs:
        inside = np.isfinite(torque) & (at >= dense[run.start] - 1e-9) & (at <= dense[run.stop - 1] + 1e-9)
        if inside.sum() >= 4:
            result[run] = CubicSpline(at[inside], torque[inside])(dense[run])
    return result
