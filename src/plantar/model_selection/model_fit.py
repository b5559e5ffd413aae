"""Fit of a bush model by variable projection: nonlinear parameters outside, linear least squares inside.

A grid search (`grid`) gives the first guess. Gauss-Newton then refines the nonlinear parameters together with the
unknown initial state in every run. The uncertainty of all of them enters the intervals.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array
from plantar.errors import DataError
from plantar.estimation.residual_covariance import interval95
from plantar.model_selection.absorbed_noise import lacking
from plantar.model_selection.data_sets import DataSet, FilteredDataSet, prepare_data_sets
from plantar.model_selection.grid import Pieces, fit_all
from plantar.model_selection.partialled_out import robust_covariance
from plantar.model_selection.variable_projection import (
    ITERATIONS,
    LANDING_GAIN,
    LANDING_ITERATIONS,
    NARROWEST_SCAN,
    NARROWING,
    SETTLED,
    WIDEST_SCAN,
    Point,
    Problem,
    best_candidate,
    landed,
    scan,
    scan_shape,
    step,
)
from plantar.models import BESIDE, BushModel

AT_LIMIT = 0.02  # of a nonlinear parameter: this near to the end of its range it counts as at the end
HARDLY_KNOWN = 0.5  # a standard deviation beyond this share of the value
SLIP_ANGLE = "slip_angle"
# Slip angles all over their range, each two thirds larger; iterations at each, and how many are gone on from.
ANGLES, FIRST_ITERATIONS, GONE_ON_FROM = 9, 2, 3


@dataclass(frozen=True)
class ModelFit:
    """A model fitted to several recordings.

    `values` (k,) as `model.terms`, `shape` (s,) as `model.shape_terms`. `covariance` (k + s, same): of both, with
    autocorrelated residuals and the uncertainty of `shape` and of the initial states included; `freedom` (k + s,) are
    its degrees of freedom; `white_std` (k + s,) is the paper's. `offsets`, `offset_std`, `initial_states` (runs,) and
    `residuals` (of the thinned samples that were used) by recording. `limits` (2, s): the range in which the motions
    can show `shape`.
    """

    model: BushModel
    values: Array
    shape: Array
    covariance: Array
    freedom: Array
    white_std: Array
    offsets: dict[str, float]
    offset_std: dict[str, float]
    initial_states: dict[str, Array]
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
        return (*self.model.terms, *self.model.shape_terms)

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
        """Why the model's own terms cannot be trusted, one line each; empty where they can."""
        found = []
        for place, term in enumerate(self.model.shape_terms):
            low, high = self.limits[:, place]
            value = self.shape[place]
            if (term, "high") in self.model.blind_ends and self.at_upper_end(term):
                found.append(f"{term} lies at or beyond {high:.3g}, the largest that these motions can show")
            if (term, "low") in self.model.blind_ends and value < (1 + AT_LIMIT) * low:
                found.append(f"{term} lies at or below {low:.3g}, the smallest that these motions can show")
        own = range(len(BESIDE), len(self.model.terms))
        if own and not any(self._told(place) for place in own):
            known = (
                f"{self.model.terms[place]} {self.values[place]:.3g} ± {self.std[place]:.2g}" for place in own
            )
            found.append(f"cannot be told from zero: {', '.join(known)}")
        return tuple(found)

    def at_upper_end(self, term: str) -> bool:
        """Whether a nonlinear parameter lies at the largest that was tried."""
        place = self.model.shape_terms.index(term)
        return bool(self.shape[place] > (1 - AT_LIMIT) * self.limits[1, place])

    def _told(self, place: int) -> bool:
        """Whether a term of the model's own is told from zero: by itself, or by the stiffness of its element.

        An element that slips one way alone may slip at any torque, at an angle that goes with it; how stiff it is
        before it slips, torque over angle, shows where it slips at all.
        """
        value, own = self.values[place], self.covariance[place, place]
        if SLIP_ANGLE in self.model.shape_terms:
            angle = self.names.index(SLIP_ANGLE)
            ratio = value / self.shape[angle - len(self.values)]
            mixed = self.covariance[place, angle] - ratio * self.covariance[angle, angle] / 2
            own = min(own, own - 2 * ratio * mixed)
        return bool(np.sqrt(max(own, 0.0)) < HARDLY_KNOWN * abs(value))


def fit_model(
    model: BushModel, data_sets: Sequence[DataSet], cutoff: float = 5.0, *, shared_offset: bool
) -> ModelFit:
    """Least squares of the data sets' torques under `model`, both sides filtered at `cutoff` [Hz].

    One offset for each recording, or with `shared_offset` one for all. Raises DataError where no sample can be used.
    """
    prepared = prepare_data_sets(data_sets, cutoff, drift=not shared_offset)
    if not prepared:
        raise DataError(
            "no recording has a sample that this fit can use (valid: at least one standing second)"
        )
    folds = [np.zeros(int(each.used.sum()), dtype=np.intp) for each in prepared]
    shapes = model.candidates([each.motion for each in prepared])
    limits = np.array([shapes.min(axis=0), shapes.max(axis=0)])
    problem, pieces = Problem(model, prepared, shared_offset), Pieces.of(model, prepared, folds, shapes)
    return refine(problem, best_candidate(problem, pieces, fit_all(pieces, shared_offset)), limits)


def fit_again(before: ModelFit, data_sets: Sequence[DataSet], *, elsewhere: bool = False) -> ModelFit:
    """The fit of the same recordings with other torques, from where it came to rest before; if asked to, or where the
    search comes to rest from slip angles `elsewhere`, all over their range.

    With the state of every landing free the squares have several minima along it.
    """
    prepared = prepare_data_sets(data_sets, before.cutoff, drift=not before.shared_offset)
    problem = Problem(before.model, prepared, before.shared_offset)
    found = refine(problem, where_it_rested(problem, before), before.limits, rested=True)
    if not elsewhere or SLIP_ANGLE not in before.model.shape_terms:
        return found
    place, tried = before.model.shape_terms.index(SLIP_ANGLE), list[ModelFit]()
    for angle in np.geomspace(before.limits[0, place], before.limits[1, place], ANGLES):
        shape = found.shape.copy()
        shape[place] = angle
        held, start = np.array([shape, shape]), where_it_rested(problem, replace(found, shape=shape))
        tried.append(refine(problem, start, held, searches=[(FIRST_ITERATIONS, WIDEST_SCAN)]))
    tried.sort(key=lambda fit: fit.rms)
    wide = [(LANDING_ITERATIONS, WIDEST_SCAN)]
    rests = [
        refine(problem, where_it_rested(problem, fit), before.limits, searches=wide)
        for fit in tried[:GONE_ON_FROM]
    ]
    best = min(rests, key=lambda fit: fit.rms)
    if best.rms**2 > (1 - LANDING_GAIN) * found.rms**2:
        return found
    return refine(problem, where_it_rested(problem, best), before.limits, rested=True)


def refits_without_each(
    model: BushModel,
    shape: Array,
    initial_states: Mapping[str, Array],
    data_sets: Sequence[DataSet],
    cutoff: float,
) -> Array:
    """Values and shape (R, k + s) of the fits that lack one recording each, from where the fit of all came to rest."""
    prepared = prepare_data_sets(data_sets, cutoff, drift=True)
    limits, found = _limits(model, prepared), []
    for left_out in prepared:
        others = [each for each in prepared if each is not left_out]
        problem = Problem(model, others, shared_offset=False)
        start = problem.at(shape, np.concatenate([initial_states[each.label] for each in others]))
        fit = refine(problem, start, limits, rested=True)
        found.append(np.append(fit.values, fit.shape))
    return np.array(found)


def _limits(model: BushModel, prepared: Sequence[FilteredDataSet]) -> Array:
    """The range in which the motions can show a model's shape, (2, s)."""
    shapes = model.candidates([each.motion for each in prepared])
    return np.array([shapes.min(axis=0), shapes.max(axis=0)])


def where_it_rested(problem: Problem, before: ModelFit) -> Point:
    """The point of an earlier fit of the same recordings."""
    states = [before.initial_states[each.label] for each in problem.prepared]
    return problem.at(before.shape, np.concatenate(states))


def refine(
    problem: Problem,
    start: Point,
    limits: Array,
    *,
    refined: bool = True,
    rested: bool = False,
    searches: Sequence[tuple[int, float]] = (),
) -> ModelFit:
    """The fit where steps and scans from `start` come to rest, nonlinear parameters within `limits` (2, s).

    Where the foot steps, they go from the better one of two guesses of the state at each landing: where steps lead, and
    what the air leaves of that. A fit that had come to rest (`rested`) with other torques keeps its landings and looks
    about it for corners only nearby. Not `refined`, it stays at the start: enough to see that a model is wrong, as are
    deviations without what a fit takes up of noise. searches: iterations of each search and how wide its first scan is,
    in place of all that.
    """
    if not refined or not (len(start.shape) or problem.model.remembers):
        return _finished(problem, start, limits, refined)
    if not searches:
        searches = [(ITERATIONS, WIDEST_SCAN * (NARROWING if rested else 1.0))]
        if problem.lands and not rested:
            searches = [*2 * [(LANDING_ITERATIONS, WIDEST_SCAN)], *searches]
    remembers, rests = problem.model.remembers, list[Point]()
    for iterations, width in searches:
        point = _onward(problem, rests) if rests else start
        for _ in range(iterations):
            moved = step(problem, point, limits)
            if moved is not None and moved.squares <= (1 - SETTLED) * point.squares:
                point = moved
                continue
            rest = moved or point
            scanned = scan(problem, rest, width) if remembers else None
            if remembers and scanned is None:
                scanned = scan_shape(problem, rest, limits, width)
            width *= NARROWING
            point = scanned or rest
            if scanned is None and (not remembers or width < NARROWEST_SCAN):
                break
        rests.append(point)
    return _finished(problem, rests[-1], limits, refined)


def _onward(problem: Problem, rests: Sequence[Point]) -> Point:
    """Where the next search starts: at what the air leaves of the first one's rest, then at the better of both."""
    if len(rests) == 1:
        return landed(problem, rests[0])
    first, landing = rests
    return first if landing.squares > (1 - LANDING_GAIN) * first.squares else landing


def _finished(problem: Problem, point: Point, limits: Array, refined: bool) -> ModelFit:
    linear = problem.linearised(point)
    scale = np.concatenate([np.ones(len(point.values)), point.shape])
    residuals = np.split(point.residuals, np.cumsum(problem.rows[:-1]))
    durations = [each.duration for each in problem.prepared]
    covariance, freedom = robust_covariance(linear, residuals, durations)
    lacks = np.ones(linear.size)
    if refined and all(each.steps is None for each in problem.prepared):
        lacks = lacking(linear, [each.drift for each in problem.prepared], durations)
    wide = np.concatenate([lacks * scale, np.ones(len(covariance) - len(scale))])
    covariance = covariance * wide[:, None] * wide[None, :]
    count, rows = len(scale), sum(len(each.response) * each.every for each in problem.prepared)
    white = point.squares / max(rows - len(covariance), 1) * linear.inverse_diagonal() * scale**2
    labels = [each.label for each in problem.prepared]
    spread = np.sqrt(np.diag(covariance)[count:])
    return ModelFit(
        model=problem.model,
        values=point.values,
        shape=point.shape,
        covariance=covariance[:count, :count],
        freedom=freedom[:count],
        white_std=np.sqrt(white),
        offsets=dict(zip(labels, point.offsets.tolist(), strict=True)),
        offset_std=dict(zip(labels, spread.tolist(), strict=True)),
        initial_states=dict(zip(labels, problem.by_recording(point.initial_states), strict=True)),
        residuals=dict(zip(labels, residuals, strict=True)),
        limits=limits,
        cutoff=problem.prepared[0].cutoff,
        shared_offset=problem.shared_offset,
    )
