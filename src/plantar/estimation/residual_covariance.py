"""How far an estimate may be trusted: covariance of sums of coloured scores, intervals, relative deviations.

Residuals of a foot are strongly coloured, so the white formula is wrong by an order of magnitude. What decides is the
spectral density of the scores (regressor times residual) near frequency zero. Here it is estimated from the scores'
lowest cosines (equal-weighted cosine estimator: E. Lazarus, D. J. Lewis, J. H. Stock, M. W. Watson, "HAR inference",
J. Business & Economic Statistics 36, 2018), whose few degrees of freedom go into Student's t.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from plantar.conventions import Array
from plantar.estimation.quantiles import MOST_FREEDOM, student_quantile

SCORE_BANDWIDTH = 0.10  # Hz: the scores' spectrum counts as flat below it (docs/how_often_intervals_hold.md)
FEWEST_COSINES = 4  # degrees of freedom of a deviation, however short the recording
# Numbers of a recording's cosines up to which they are kept: products with so few take less than a transform.
FEW = 2**15
KEPT = 64  # recordings of other lengths, in bands and feet, whose cosines are: 16 MB at most


def cosine_covariance(scores: Array, duration: float) -> tuple[Array, int]:
    """Covariance of the sum of coloured `scores` (n, p), which span `duration` [s], and its degrees of freedom.

    Zero-mean scores of a least-squares fit; the sum over one recording.
    """
    cosines = score_cosines(scores, duration)
    return np.asarray(cosines.T @ cosines), len(cosines)


def cosine_count(duration: float) -> int:
    """How many cosines tell the covariance of scores that span `duration` [s]."""
    return max(round(2 * SCORE_BANDWIDTH * duration), FEWEST_COSINES)


def score_cosines(scores: Array, duration: float) -> Array:
    """The root (m, p) of `cosine_covariance`: its products are the covariance, m the degrees of freedom."""
    count = len(scores)
    cosines = min(cosine_count(duration), max(count - 1, 1))
    # Orthonormal DCT-II, √(2/n) Σ s_t cos(π j (2t + 1) / 2n): every coefficient's variance is the density.
    if count * cosines <= FEW:
        return np.asarray(_cosines(count, min(cosines, count - 1)) @ scores)
    # As a Fourier transform it is one of the even samples and, turned round, the odd ones.
    order = np.arange(1, min(cosines, count - 1) + 1)
    turned = np.fft.rfft(np.concatenate([scores[::2], scores[1::2][::-1]]), axis=0)[
        np.minimum(order, count - order)
    ]
    turned.imag[2 * order > count] *= -1
    phases = np.exp(-0.5j * np.pi * order / count)[:, None]
    coefficients = np.sqrt(2 / count) * (phases * turned).real
    return np.asarray(np.sqrt(count / max(len(coefficients), 1)) * coefficients)


@lru_cache(maxsize=KEPT)
def _cosines(count: int, number: int) -> Array:
    """The rows (number, count) whose products with scores are their cosines, each for one degree of freedom."""
    order = np.arange(1, number + 1)[:, None]
    rows = np.cos(0.5 * np.pi / count * order * (2 * np.arange(count) + 1))
    return np.asarray(np.sqrt(2 / max(number, 1)) * rows)


def pooled_freedom(variances: Array, freedoms: Array) -> Array:
    """Welch-Satterthwaite degrees of freedom of sums of independent variances, both (groups, p) -> (p,)."""
    total = variances.sum(axis=0)
    spread = np.sum(variances**2 / freedoms, axis=0)
    return np.asarray(np.where(spread > 0, total**2 / np.where(spread > 0, spread, 1.0), MOST_FREEDOM))


def interval95(value: float, std: float, freedom: float) -> tuple[float, float]:
    """Student's 95 % interval around `value` with `freedom` degrees of freedom."""
    reach = float(student_quantile(0.975, max(freedom, 1.0))) * std
    return value - reach, value + reach


def relative_std_percent(value: float, std: float) -> float | None:
    """100·std/|value|, or None where the value is zero."""
    return 100 * std / abs(value) if value else None
