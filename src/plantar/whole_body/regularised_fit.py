"""Eq. 2 and 3 as one weighted least-squares problem, regularised towards the CAD as far as held-out data allow.

The weight of the regularisation is chosen by cross-validation: for each weight the fit to all folds but one predicts
that one. The largest weight is taken whose held-out error is within one standard error of the smallest (of the paired
differences).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import BaseParameters, Equation
from plantar.dynamics.consistency import Normal, Prior, consistent_fit
from plantar.whole_body.folds import Folds, Samples

REGULARISATIONS = tuple(float(regularisation) for regularisation in 10.0 ** np.arange(-1.0, 6.5))
WEIGHTING_ROUNDS = 2  # in which rows are weighed by what they missed
HOPELESS = 3.0  # times the smallest held-out error: larger weights are not tried any more
FIRST_REGULARISATION = 10.0  # of the fit that gives the first weights
LEAST_ERROR = 1e-5  # N, N.m: what a row misses by less is rounding, and its weight would drown all others


@dataclass(frozen=True)
class HeldOutError:
    """Held-out error of one regularisation weight: mean of the rows' squared errors over their weights, by fold."""

    regularisation: float
    errors: Array


@dataclass(frozen=True)
class RegularisedFit:
    """inertial: (10 n_links,); extras: coefficients of each row's further columns; weights: of each row [1 / unit];
    regularisation: its weight, infinite where the inertial parameters were given; held_out: see `HeldOutError`."""

    equation: Equation
    base: BaseParameters
    prior: Prior
    inertial: Array
    extras: Mapping[int, Array]
    weights: Mapping[int, float]
    regularisation: float
    held_out: tuple[HeldOutError, ...]
    triangle: Array

    def predict(self, samples: Samples) -> Array:
        """Every row in another motion, (n_rows, N); rows without extras hold Y phi alone."""
        rows = self.equation.inverse_dynamics(samples.motion, self.inertial)
        for row, columns in samples.extras.items():
            for value, column in zip(self.extras[row], columns, strict=True):
                rows[row] += value * column
        return rows


def normal_of(base: BaseParameters, prior: Prior, triangle: Array) -> Normal:
    """The normal equations of an R factor whose columns are base parameters, extras and the measured side."""
    regressor = np.hstack([triangle[:, : len(base)] @ base.grouping, triangle[:, len(base) : -1]])
    return Normal.of(regressor, triangle[:, -1], prior)


class RegularisedProblem:
    """The folds of all recordings, and the CAD that fits to them are regularised towards."""

    def __init__(self, equation: Equation, prior: Prior, folds: Folds) -> None:
        self.equation, self.base, self.prior, self.folds = equation, folds.base, prior, folds
        self.every = range(len(folds))

    @classmethod
    def of(
        cls, equation: Equation, base: BaseParameters, prior: Prior, recordings: Sequence[Samples]
    ) -> RegularisedProblem:
        """The problem of recordings that are all in memory."""
        return cls(equation, prior, Folds.of(equation, base, recordings))

    def solve(self, progress: Callable[[str], None] = lambda _: None) -> RegularisedFit:
        """Weights from the data, then the regularisation weight, then the fit to everything."""
        weights = dict.fromkeys(self.folds.rows, 1.0)
        regularisation = FIRST_REGULARISATION * self._scale()
        for _ in range(WEIGHTING_ROUNDS):
            progress("weigh the rows")
            weights = self._weights(self._fit(self.folds.triangle(self.every, weights), regularisation))
            regularisation = FIRST_REGULARISATION
        held_out = self._errors(weights, progress)
        regularisation = chosen_regularisation(held_out)
        progress(f"fit with regularisation weight {regularisation:g}")
        x = self._fit(self.folds.triangle(self.every, weights), regularisation)
        return self._found(x, weights, regularisation, held_out)

    def with_known(self, inertial: Array) -> RegularisedFit:
        """Only the rows' extras, the inertial parameters (10 n_links,) given: each row by itself."""
        x = self.folds.with_known(self.every, inertial)
        weights = self._weights(x)
        held_out = []
        if len(self.folds) > 1:
            fits = [self.folds.with_known(self.folds.but(out), inertial) for out in self.every]
            held_out.append(HeldOutError(np.inf, self._held_out(fits, weights)))
        return self._found(x, weights, np.inf, held_out)

    def _found(
        self, x: Array, weights: Mapping[int, float], regularisation: float, held_out: Sequence[HeldOutError]
    ) -> RegularisedFit:
        return RegularisedFit(
            equation=self.equation,
            base=self.base,
            prior=self.prior,
            inertial=x[: len(self.prior.cad)],
            extras=self.folds.extras_of(x),
            weights=weights,
            regularisation=regularisation,
            held_out=tuple(held_out),
            triangle=self.folds.triangle(self.every, weights),
        )

    def _weights(self, x: Array) -> dict[int, float]:
        """One over what each row misses, rms over everything."""
        missed = {row: float(np.sqrt(self.folds.error(self.every, row, x))) for row in self.folds.rows}
        return {row: 1 / max(rms, LEAST_ERROR) for row, rms in missed.items()}

    def _errors(self, weights: Mapping[int, float], progress: Callable[[str], None]) -> list[HeldOutError]:
        if len(self.folds) < 2:
            return []
        triangles = (self.folds.triangle(self.folds.but(out), weights) for out in self.every)
        normals = [normal_of(self.base, self.prior, triangle) for triangle in triangles]
        held_out = []
        for regularisation in REGULARISATIONS:
            progress(f"held-out error of regularisation weight {regularisation:g}")
            fits = [self._regularised(normal, regularisation) for normal in normals]
            held_out.append(HeldOutError(regularisation, self._held_out(fits, weights)))
            if errors_of(held_out)[-1] > HOPELESS * errors_of(held_out).min():
                break
        return held_out

    def _held_out(self, fits: Sequence[Array], weights: Mapping[int, float]) -> Array:
        """Each fold's error by the fit to the others."""
        errors = [self.folds.weighted_error([out], x, weights) for out, x in enumerate(fits)]
        return np.array(errors)

    def _regularised(self, normal: Normal, regularisation: float) -> Array:
        return consistent_fit(normal, self.prior, regularisation, self.folds.positive)

    def _fit(self, triangle: Array, regularisation: float) -> Array:
        return self._regularised(normal_of(self.base, self.prior, triangle), regularisation)

    def _scale(self) -> float:
        """Mean square of what the CAD misses, so that the first weight has its unit."""
        x = np.concatenate([self.prior.cad, np.zeros(sum(self.folds.counts.values()))])
        return float(np.mean([self.folds.error(self.every, row, x) for row in self.folds.rows]))


def errors_of(held_out: Sequence[HeldOutError]) -> Array:
    """Mean held-out error of each regularisation weight."""
    return np.array([tried.errors.mean() for tried in held_out])


def chosen_regularisation(held_out: Sequence[HeldOutError]) -> float:
    """The largest regularisation weight whose held-out error is as good as the smallest."""
    if not held_out:
        return FIRST_REGULARISATION
    good = as_good([tried.errors for tried in held_out])
    return max(tried.regularisation for tried, one in zip(held_out, good, strict=True) if one)


def as_good(errors: Sequence[Array]) -> list[bool]:
    """Whether each of these held-out errors of folds is within one standard error of the smallest (of the paired
    differences)."""
    excess = [error - min(errors, key=np.mean) for error in errors]
    return [bool(more.mean() <= more.std(ddof=1) / np.sqrt(len(more))) for more in excess]
