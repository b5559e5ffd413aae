"""Eq. 2 and 3 as one weighted least-squares problem, pulled towards the CAD as far as held-out data allow.

The recordings are cut into stretches. For each strength of the pull the fit to all stretches but one predicts that
one; the strength with the smallest held-out error serves, or the strongest one that cannot be told from it (within
one standard error of the paired differences).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy import optimize

from plantar.conventions import Array, Mask
from plantar.dynamics import BaseParameters, Equation, EquationStream, Motion, RowFactor, stacked
from plantar.dynamics.consistency import Normal, Prior, consistent_fit

STRETCHES = 6  # over all recordings
STRENGTHS = tuple(float(strength) for strength in 10.0 ** np.arange(-1.0, 6.5))
WEIGHTING_ROUNDS = 2
HOPELESS = 3.0  # times the smallest held-out error: stronger pulls are not tried any more
FIRST_STRENGTH = 10.0  # of the fit that gives the first weights
LEAST_ERROR = 1e-5  # N, N.m: what a row misses by less is rounding, and its weight would drown all others


@dataclass(frozen=True)
class Samples:
    """One recording ready for eq. 1: finite samples only.

    measured: right side of each row, (N,); extras: further columns of a row, (N,) each; period [s]; positive: which of
    a row's extras have coefficients that may not be negative.
    """

    name: str
    time: Array
    motion: Motion
    measured: Mapping[int, Array]
    extras: Mapping[int, tuple[Array, ...]]
    period: float
    positive: Mapping[int, tuple[bool, ...]] = field(default_factory=dict)

    def select(self, rows: slice | Mask) -> Samples:
        return Samples(
            self.name,
            self.time[rows],
            self.motion.select(rows),
            {row: values[rows] for row, values in self.measured.items()},
            {row: tuple(column[rows] for column in columns) for row, columns in self.extras.items()},
            self.period,
            self.positive,
        )


@dataclass(frozen=True)
class Trial:
    """Held-out error of one strength: mean of the rows' squared errors over their weights, by stretch."""

    strength: float
    errors: Array


@dataclass(frozen=True)
class PulledFit:
    """inertial: (10 n_links,); extras: those of each row; weights: of each row [1 / unit]; strength: of the pull,
    infinite where the inertial parameters were given; trials: see `Trial`."""

    equation: Equation
    base: BaseParameters
    prior: Prior
    inertial: Array
    extras: Mapping[int, Array]
    weights: Mapping[int, float]
    strength: float
    trials: tuple[Trial, ...]
    triangle: Array

    def predict(self, samples: Samples) -> Array:
        """Every row in another motion, (n_rows, N); rows without extras hold Y phi alone."""
        rows = self.equation.inverse_dynamics(samples.motion, self.inertial)
        for row, columns in samples.extras.items():
            for value, column in zip(self.extras[row], columns, strict=True):
                rows[row] += value * column
        return rows


class PulledProblem:
    """The stretches of all recordings as R factors, one for each row of eq. 1 that is measured."""

    def __init__(
        self, equation: Equation, base: BaseParameters, prior: Prior, recordings: Sequence[Samples]
    ) -> None:
        self.equation, self.base, self.prior = equation, base, prior
        self.rows = tuple(recordings[0].measured)
        self.counts = {row: len(recordings[0].extras.get(row, ())) for row in self.rows}
        flags = [
            flag for row in self.rows for flag in recordings[0].positive.get(row, (False,) * self.counts[row])
        ]
        self.positive = tuple(place for place, flag in enumerate(flags) if flag)
        self.stretches: list[dict[int, RowFactor]] = []
        each = max(1, -(-STRETCHES // len(recordings)))
        for samples in recordings:
            bounds = np.linspace(0, len(samples.time), each + 1).astype(int)
            for start, stop in pairwise(bounds):
                if stop > start:
                    self.stretches.append(self._factors(samples.select(slice(start, stop))))

    def _factors(self, samples: Samples) -> dict[int, RowFactor]:
        stream = EquationStream(self.equation, self.base, self.rows, self.counts)
        stream.add(samples.motion, samples.measured, samples.extras)
        return stream.factors()

    def solve(self, progress: Callable[[str], None] = lambda _: None) -> PulledFit:
        """Weights from the data, then the strength of the pull, then the fit to everything."""
        every = range(len(self.stretches))
        weights = dict.fromkeys(self.rows, 1.0)
        strength = FIRST_STRENGTH * self._scale(every)
        for _ in range(WEIGHTING_ROUNDS):
            progress("weigh the rows")
            x = self._fit(self._triangle(every, weights), strength)
            weights = self._weights(x)
            strength = FIRST_STRENGTH
        trials = self._trials(weights, progress)
        strength = chosen_strength(trials)
        progress(f"fit, pulled with strength {strength:g}")
        triangle = self._triangle(every, weights)
        x = self._fit(triangle, strength)
        size = len(self.prior.cad)
        return PulledFit(
            equation=self.equation,
            base=self.base,
            prior=self.prior,
            inertial=x[:size],
            extras={row: x[size + start : size + stop] for row, (start, stop) in self._places().items()},
            weights=weights,
            strength=strength,
            trials=tuple(trials),
            triangle=triangle,
        )

    def with_known(self, inertial: Array) -> PulledFit:
        """Only the rows' extras, the inertial parameters (10 n_links,) given: each row by itself. Strength infinite."""
        every = range(len(self.stretches))
        size = len(self.prior.cad)

        def extras(chosen: Sequence[int]) -> Array:
            found = [self._row_extras(chosen, row, self.base.grouping @ inertial) for row in self.rows]
            return np.concatenate([inertial, *found])

        x = extras(every)
        weights = self._weights(x)
        trials = []
        if len(self.stretches) > 1:
            fits = [extras([k for k in every if k != out]) for out in every]
            errors = [self._weighted_error(out, fit, weights) for out, fit in enumerate(fits)]
            trials.append(Trial(np.inf, np.array(errors)))
        return PulledFit(
            equation=self.equation,
            base=self.base,
            prior=self.prior,
            inertial=inertial,
            extras={row: x[size + start : size + stop] for row, (start, stop) in self._places().items()},
            weights=weights,
            strength=np.inf,
            trials=tuple(trials),
            triangle=self._triangle(every, weights),
        )

    def _weights(self, x: Array) -> dict[int, float]:
        """One over what each row misses, rms over everything."""
        every = range(len(self.stretches))
        return {row: 1 / max(float(np.sqrt(self._error(every, row, x))), LEAST_ERROR) for row in self.rows}

    def _row_extras(self, chosen: Sequence[int], row: int, base: Array) -> Array:
        """Least squares of one row's extras beside known base parameters; some may not be negative."""
        count = self.counts[row]
        if count == 0:
            return np.zeros(0)
        factor = _pooled([self.stretches[k][row] for k in chosen])
        own = len(factor.columns)
        target = factor.upper[:, -1] - factor.upper[:, :own] @ base[factor.columns]
        first = self._places()[row][0]
        lower = [0.0 if first + k in self.positive else -np.inf for k in range(count)]
        return np.asarray(optimize.lsq_linear(factor.upper[:, own:-1], target, (lower, np.inf)).x)

    def _weighted_error(self, stretch: int, x: Array, weights: Mapping[int, float]) -> float:
        """Mean over the rows of one stretch's mean squared errors, over their weights."""
        return float(np.mean([self._error([stretch], row, x) * weights[row] ** 2 for row in self.rows]))

    def _trials(self, weights: Mapping[int, float], progress: Callable[[str], None]) -> list[Trial]:
        every = range(len(self.stretches))
        if len(self.stretches) < 2:
            return []
        triangles = [self._triangle([k for k in every if k != out], weights) for out in every]
        normals = [self._normal(triangle) for triangle in triangles]
        trials = []
        for strength in STRENGTHS:
            progress(f"held-out error of pull {strength:g}")
            errors = []
            for out in every:
                x = consistent_fit(normals[out], self.prior, strength, self.positive)
                errors.append(self._weighted_error(out, x, weights))
            trials.append(Trial(strength, np.array(errors)))
            if errors_of(trials)[-1] > HOPELESS * errors_of(trials).min():
                break
        return trials

    def _places(self) -> dict[int, tuple[int, int]]:
        places, start = {}, 0
        for row in self.rows:
            places[row] = (start, start + self.counts[row])
            start += self.counts[row]
        return places

    def _triangle(self, chosen: Sequence[int], weights: Mapping[int, float]) -> Array:
        """R of the chosen stretches, each row times its weight: base parameters, extras, measured."""
        parts = []
        for row in self.rows:
            parts.append(_pooled([self.stretches[k][row] for k in chosen]))
        return stacked(parts, len(self.base), [weights[row] for row in self.rows])

    def _normal(self, triangle: Array) -> Normal:
        base = len(self.base)
        regressor = np.hstack([triangle[:, :base] @ self.base.grouping, triangle[:, base:-1]])
        return Normal.of(regressor, triangle[:, -1], self.prior)

    def _fit(self, triangle: Array, strength: float) -> Array:
        return consistent_fit(self._normal(triangle), self.prior, strength, self.positive)

    def _scale(self, chosen: Sequence[int]) -> float:
        """Mean square of what the CAD misses, so that the first pull has its unit."""
        count = sum(self.counts.values())
        x = np.concatenate([self.prior.cad, np.zeros(count)])
        return float(np.mean([self._error(chosen, row, x) for row in self.rows]))

    def _error(self, chosen: Sequence[int], row: int, x: Array) -> float:
        """Mean squared error of a row over the chosen stretches."""
        size = len(self.prior.cad)
        base = self.base.grouping @ x[:size]
        start, stop = self._places()[row]
        total, samples = 0.0, 0
        for k in chosen:
            factor = self.stretches[k][row]
            solution = np.concatenate([base[factor.columns], x[size + start : size + stop], [-1.0]])
            total += float(np.sum((factor.upper @ solution) ** 2))
            samples += factor.samples
        return total / max(samples, 1)


def errors_of(trials: Sequence[Trial]) -> Array:
    """Mean held-out error of each strength."""
    return np.array([trial.errors.mean() for trial in trials])


def chosen_strength(trials: Sequence[Trial]) -> float:
    """The strongest pull whose held-out error is within one standard error of the smallest."""
    if not trials:
        return FIRST_STRENGTH
    best = min(trials, key=lambda trial: float(trial.errors.mean()))
    tolerated = [best.strength]
    for trial in trials:
        excess = trial.errors - best.errors
        if trial.strength > best.strength and excess.mean() <= excess.std(ddof=1) / np.sqrt(len(excess)):
            tolerated.append(trial.strength)
    return max(tolerated)


def _pooled(factors: Sequence[RowFactor]) -> RowFactor:
    """One row's factors over several stretches as one."""
    first = factors[0]
    size = len(first.columns) + first.extras + 1
    if len(factors) == 1:
        return first
    upper = stacked([RowFactor(f.upper, np.arange(size - 1), 0, f.samples) for f in factors], size - 1)
    return RowFactor(upper, first.columns, first.extras, sum(f.samples for f in factors))
