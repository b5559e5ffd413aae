"""Noise in the regressors: it adds to their squares but to no product with the response, and so draws values to zero.

White noise of angles and rates is measured far above the fit's cutoff, in what the torque there does not explain (a
foot that shakes is no noise), and followed through the filter; its expected share is taken off the regressor's
products (W. A. Fuller, Measurement Error Models, Wiley 1987).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import Array, Mask
from plantar.estimation.blocks import Block
from plantar.estimation.linear import information_inverse
from plantar.signals.filters import gain, low_pass

ABOVE = 4.0  # cutoffs: from there on a signal counts as noise
NORMAL = 1.4826  # standard deviation over median absolute value, of normal noise
FEWEST = 50  # samples
MOST = 0.5  # share of a direction's square that may be noise: beyond, nothing of it is known


def noise_after_filter(raw: Array, response: Array, period: float, cutoff: float) -> Array:
    """Variance (k,) that the white noise of unfiltered signals (N, k) has behind the filter at `cutoff` [Hz].

    `response` (N, m): other sensors' unfiltered signals; what moves with them or with their rates is no noise. The
    lower of two densities, just below and above `ABOVE` cutoffs: what rings at one frequency is not white. Zero
    where the samples are too slow to show any frequency without motion.
    """
    highest = 0.5 / period
    if ABOVE * cutoff > 0.8 * highest:
        return np.zeros(raw.shape[1])
    both = np.column_stack([raw, response])
    smooth, smoother = (low_pass(both, period, share * cutoff) for share in (ABOVE, ABOVE / 2))
    whole = np.asarray(np.isfinite(smoother).all(axis=1) & np.isfinite(both).all(axis=1))
    if whole.sum() < FEWEST:
        return np.zeros(raw.shape[1])
    frequency = np.linspace(0.0, highest, 2000, endpoint=False)
    passed, wide, narrow = (gain(frequency, period, share * cutoff) for share in (1, ABOVE, ABOVE / 2))
    upper, lower = 1 - wide, wide - narrow
    densities = [
        (NORMAL * np.median(np.abs(_unexplained(part, whole, raw.shape[1])), axis=0)) ** 2 / np.mean(shape**2)
        for part, shape in ((both - smooth, upper), (smooth - smoother, lower))
    ]
    return np.asarray(np.minimum(*densities) * np.mean(passed**2))


def _unexplained(band: Array, whole: Mask, count: int) -> Array:
    """The first `count` columns of a band less what the other columns and their rates explain, the whole samples."""
    rates = np.gradient(band[:, count:], axis=0)
    clear = whole & np.asarray(np.isfinite(rates).all(axis=1))
    values, explaining = band[clear, :count], np.column_stack([band[:, count:], rates])[clear]
    return np.asarray(values - explaining @ np.linalg.lstsq(explaining, values, rcond=None)[0])


def attenuation(blocks: Sequence[Block], values: Array, *, shared_offset: bool = False) -> Array | None:
    """What the blocks' noise has taken off `values` (k,): to be added; None where noise is most of what there is."""
    size = len(values)
    noise = np.diag(
        np.sum([one.rows * one.noise for one in blocks if one.noise is not None], axis=0) * np.ones(size)
    )
    inverse = information_inverse(blocks, shared_offset=shared_offset)
    share = inverse @ noise  # nothing along a direction that no block excites
    if np.max(np.linalg.eigvals(share).real) > MOST:
        return None
    return np.asarray(np.linalg.solve(np.eye(size) - share, share @ values))


def offsets_moved(blocks: Sequence[Block], change: Array, *, shared_offset: bool = False) -> dict[str, float]:
    """How each block's offset follows values that move by `change` (k,): its mean response stays explained."""
    means = {one.label: one.regressor.mean(axis=0) for one in blocks}
    if shared_offset:
        means = dict.fromkeys(means, np.concatenate([one.regressor for one in blocks]).mean(axis=0))
    return {label: -float(mean @ change) for label, mean in means.items()}
