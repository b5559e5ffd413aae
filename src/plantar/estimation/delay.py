"""How late one signal is against another that it should equal (measured against predicted wrench)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.estimation.intervals import cosine_covariance, pooled_freedom
from plantar.signals import differentiate, shifted

ROUNDS = 4  # the moment equation is linear near its solution: each round shifts and solves again
LONGEST = 0.05  # s: later signals than this are another fault than a delay
LEAST_EXPLAINED = 0.8  # share of an axis' variance that the prediction must explain to take part
GAIN_BAND = (0.75, 1.35)  # measured over predicted: outside it something else acts on the robot


@dataclass(frozen=True)
class Pair:
    """Measured and predicted signals of one recording, (n, k) each, evenly sampled, without NaN, equally filtered."""

    label: str
    measured: Array
    predicted: Array
    period: float


@dataclass(frozen=True)
class Delay:
    """`value` [s] > 0: the measured signal is late. `explained` (pairs, k): share of variance explained, NaN where
    an axis did not take part."""

    value: float
    std: float
    freedom: float
    explained: Array


def estimate_delay(pairs: Sequence[Pair]) -> Delay | None:
    """Delay common to all pairs and axes, or None where nothing follows the prediction.

    With m(t) = g·p(t - δ) + noise, Σ m ṗ = -δ Σ ṁ ṗ for small δ. Only products of the two signals enter, so that
    noise of either one does not bias δ. Axes weigh by the inverse variance of what the prediction leaves.
    """
    value, last = 0.0, None
    for _ in range(ROUNDS):
        step = _step(pairs, value)
        if step is None:
            return None
        value, last = float(np.clip(value + step.value, -LONGEST, LONGEST)), step
    return last and Delay(value, last.std, last.freedom, last.explained)


def _step(pairs: Sequence[Pair], delay: float) -> Delay | None:
    numerator = denominator = 0.0
    explained = np.full((len(pairs), pairs[0].measured.shape[1]), np.nan)
    moments: list[tuple[Array, Array, float]] = []
    for place, pair in enumerate(pairs):
        measured = shifted(pair.measured, pair.period, delay)
        whole = np.isfinite(measured).all(axis=1)
        m, p = measured[whole], pair.predicted[whole]
        m, p = m - m.mean(axis=0), p - p.mean(axis=0)
        gain = np.sum(m * p, axis=0) / np.maximum(np.sum(p * p, axis=0), 1e-300)
        left = np.var(m - gain * p, axis=0)
        share = 1 - left / np.maximum(np.var(m, axis=0), 1e-300)
        takes_part = (share > LEAST_EXPLAINED) & (gain > GAIN_BAND[0]) & (gain < GAIN_BAND[1])
        if not takes_part.any():
            continue
        explained[place, takes_part] = share[takes_part]
        rate_m, rate_p = differentiate(m, pair.period), differentiate(p, pair.period)
        weight = np.where(takes_part, 1 / np.maximum(left, 1e-300), 0.0)
        moment, slope = (m * rate_p) @ weight, (rate_m * rate_p) @ weight
        numerator += float(moment.sum())
        denominator += float(slope.sum())
        moments.append((moment, slope, pair.period))
    if denominator <= 0:
        return None
    step = -numerator / denominator
    variances, freedoms = [], []
    for moment, slope, period in moments:
        covariance, freedom = cosine_covariance((moment + step * slope)[:, None], len(moment) * period)
        variances.append(covariance[0, 0] / denominator**2)
        freedoms.append(freedom)
    variance = np.array(variances)[:, None]
    freedom = float(pooled_freedom(variance, np.array(freedoms, dtype=float)[:, None])[0])
    return Delay(step, float(np.sqrt(variance.sum())), freedom, explained)
