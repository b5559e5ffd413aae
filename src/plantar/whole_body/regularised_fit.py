"""Eq. 2 and 3 as one weighted least-squares problem, pulled towards the CAD as far as held-out data allow.

For each strength of the pull the fit to all stretches of the recordings but one predicts that one; the strength with
the smallest held-out error serves, or the strongest one that cannot be told from it (within one standard error of the
paired differences).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import BaseParameters, Equation
from plantar.dynamics.consistency import Normal, Prior, consistent_fit
from plantar.whole_body.folds import Samples, Stretches

STRENGTHS = tuple(float(strength) for strength in 10.0 ** np.arange(-1.0, 6.5))
WEIGHTING_ROUNDS = 2
HOPELESS = 3.0  # times the smallest held-out error: stronger pulls are not tried any more
FIRST_STRENGTH = 10.0  # of the fit that gives the first weights
LEAST_ERROR = 1e-5  # N, N.m: what a row misses by less is rounding, and its weight would drown all others


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
    """The stretches of all recordings and the CAD that fits to them are pulled towards."""

    def __init__(
        self, equation: Equation, base: BaseParameters, prior: Prior, recordings: Sequence[Samples]
    ) -> None:
        self.equation, self.base, self.prior = equation, base, prior
        self.stretches = Stretches(equation, base, recordings)
        self.every = range(len(self.stretches))

    def solve(self, progress: Callable[[str], None] = lambda _: None) -> PulledFit:
        """Weights from the data, then the strength of the pull, then the fit to everything."""
        weights = dict.fromkeys(self.stretches.rows, 1.0)
        strength = FIRST_STRENGTH * self._scale()
        for _ in range(WEIGHTING_ROUNDS):
            progress("weigh the rows")
            weights = self._weights(self._fit(self.stretches.triangle(self.every, weights), strength))
            strength = FIRST_STRENGTH
        trials = self._trials(weights, progress)
        strength = chosen_strength(trials)
        progress(f"fit, pulled with strength {strength:g}")
        x = self._fit(self.stretches.triangle(self.every, weights), strength)
        return self._found(x, weights, strength, trials)

    def with_known(self, inertial: Array) -> PulledFit:
        """Only the rows' extras, the inertial parameters (10 n_links,) given: each row by itself. Strength infinite."""
        x = self.stretches.with_known(self.every, inertial)
        weights = self._weights(x)
        trials = []
        if len(self.stretches) > 1:
            fits = [self.stretches.with_known(self.stretches.but(out), inertial) for out in self.every]
            trials.append(Trial(np.inf, self._held_out(fits, weights)))
        return self._found(x, weights, np.inf, trials)

    def _found(
        self, x: Array, weights: Mapping[int, float], strength: float, trials: Sequence[Trial]
    ) -> PulledFit:
        return PulledFit(
            equation=self.equation,
            base=self.base,
            prior=self.prior,
            inertial=x[: len(self.prior.cad)],
            extras=self.stretches.extras_of(x),
            weights=weights,
            strength=strength,
            trials=tuple(trials),
            triangle=self.stretches.triangle(self.every, weights),
        )

    def _weights(self, x: Array) -> dict[int, float]:
        """One over what each row misses, rms over everything."""
        missed = {
            row: float(np.sqrt(self.stretches.error(self.every, row, x))) for row in self.stretches.rows
        }
        return {row: 1 / max(rms, LEAST_ERROR) for row, rms in missed.items()}

    def _trials(self, weights: Mapping[int, float], progress: Callable[[str], None]) -> list[Trial]:
        if len(self.stretches) < 2:
            return []
        triangles = (self.stretches.triangle(self.stretches.but(out), weights) for out in self.every)
        normals = [self._normal(triangle) for triangle in triangles]
        trials = []
        for strength in STRENGTHS:
            progress(f"held-out error of pull {strength:g}")
            fits = [self._pulled(normal, strength) for normal in normals]
            trials.append(Trial(strength, self._held_out(fits, weights)))
            if errors_of(trials)[-1] > HOPELESS * errors_of(trials).min():
                break
        return trials

    def _held_out(self, fits: Sequence[Array], weights: Mapping[int, float]) -> Array:
        """Each stretch's error by the fit to the others."""
        errors = [self.stretches.weighted_error([out], x, weights) for out, x in enumerate(fits)]
        return np.array(errors)

    def _normal(self, triangle: Array) -> Normal:
        base = len(self.base)
        regressor = np.hstack([triangle[:, :base] @ self.base.grouping, triangle[:, base:-1]])
        return Normal.of(regressor, triangle[:, -1], self.prior)

    def _pulled(self, normal: Normal, strength: float) -> Array:
        return consistent_fit(normal, self.prior, strength, self.stretches.positive)

    def _fit(self, triangle: Array, strength: float) -> Array:
        return self._pulled(self._normal(triangle), strength)

    def _scale(self) -> float:
        """Mean square of what the CAD misses, so that the first pull has its unit."""
        x = np.concatenate([self.prior.cad, np.zeros(sum(self.stretches.counts.values()))])
        return float(np.mean([self.stretches.error(self.every, row, x) for row in self.stretches.rows]))


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
