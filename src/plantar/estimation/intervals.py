"""How far an estimate may be trusted: covariance of sums of coloured scores, intervals, relative deviations.

Residuals of a foot are strongly coloured, so the white formula is wrong by an order of magnitude. What decides is the
spectral density of the scores (regressor times residual) near frequency zero. Here it is estimated from the scores'
lowest cosines (equal-weighted cosine estimator: E. Lazarus, D. J. Lewis, J. H. Stock, M. W. Watson, "HAR inference",
J. Business & Economic Statistics 36, 2018), whose few degrees of freedom go into Student's t.
"""

from __future__ import annotations

import numpy as np
from scipy import fft, special

from plantar.conventions import Array

SCORE_BANDWIDTH = 0.10  # Hz: the scores' spectrum counts as flat below it (docs/intervals.md: coverage study)
FEWEST_COSINES = 4
MOST_FREEDOM = 1e6  # stands for a deviation that is known


def cosine_covariance(scores: Array, duration: float) -> tuple[Array, int]:
    """Covariance of the sum of coloured `scores` (n, p), which span `duration` [s], and its degrees of freedom.

    Zero-mean scores of a least-squares fit; the sum over one recording.
    """
    count = len(scores)
    cosines = int(np.clip(round(2 * SCORE_BANDWIDTH * duration), FEWEST_COSINES, max(count - 1, 1)))
    # DCT-II: 2 Σ s_t cos(π j (2t + 1) / 2n); the orthonormal one makes every coefficient's variance the density.
    coefficients = fft.dct(scores, type=2, norm="ortho", axis=0)[1 : cosines + 1]
    return np.asarray(count * coefficients.T @ coefficients / max(len(coefficients), 1)), len(coefficients)


def pooled_freedom(variances: Array, freedoms: Array) -> Array:
    """Welch-Satterthwaite degrees of freedom of sums of independent variances, both (groups, p) -> (p,)."""
    total = variances.sum(axis=0)
    spread = np.sum(variances**2 / freedoms, axis=0)
    return np.asarray(np.where(spread > 0, total**2 / np.where(spread > 0, spread, 1.0), MOST_FREEDOM))


def interval95(value: float, std: float, freedom: float) -> tuple[float, float]:
    """Student's 95 % interval around `value` with `freedom` degrees of freedom."""
    reach = float(special.stdtrit(max(freedom, 1.0), 0.975)) * std
    return value - reach, value + reach


def relative_std_percent(value: float, std: float) -> float | None:
    """100·std/|value|, or None where the value is zero."""
    return 100 * std / abs(value) if value else None
