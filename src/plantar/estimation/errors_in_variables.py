"""Noise in the regressors: it adds to their squares but to no product with the response, and so draws values to zero.

Noise of angles and rates is measured far above the fit's cutoff, in what the torque there does not explain (a
foot that shakes is no noise), and followed through the filter; its expected share is taken off the regressor's
products (W. A. Fuller, Measurement Error Models, Wiley 1987).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from plantar.conventions import Array, Mask
from plantar.estimation.blocks import Block, StanceRows
from plantar.estimation.linear import fit_blocks, information_inverse
from plantar.estimation.normal_equations import solved
from plantar.estimation.stance_problem import StanceProblem, design
from plantar.estimation.triangular import RANK_TOLERANCE
from plantar.signals.filters import differentiate, gain, low_pass
from plantar.signals.medians import median
from plantar.signals.segments import complete

ABOVE = 4.0  # cutoffs: from there on a signal counts as noise
NORMAL = 1.4826  # standard deviation over median absolute value, of normal noise
FEWEST = 50  # samples of one recording, for it to take part in a fit or a score: fewer are no motion
SECOND = 1.0  # s, within which an attitude that wanders is nearly a parabola in time
PAST_ZERO = 1.5  # of a value: errors draw it to zero, and chance not far past it
DRAWN = 0.2  # of a value: one from which errors may have taken more is not known
MOST = 0.5  # share of a direction's square that may be noise: beyond, nothing of it is known


def noise_after_filter(angles: Array, rates: Array, response: Array, period: float, cutoff: float) -> Array:
    """Variances (2, k) that the noise of unfiltered angles and rates (N, k) has behind the filter at `cutoff` [Hz].

    `response` (N, m): other sensors' unfiltered signals; what moves with them or with their rates is no noise. The
    lower of two densities, just below and above `ABOVE` cutoffs: what rings at one frequency is not white. Rates that
    were differentiated from angles carry these' noise, which grows with frequency: it is not carried down to the
    filter's band as if it were white. How much of the angles' noise that is, both show together. Zero where the samples
    are too slow to show any frequency without motion.
    """
    nothing = np.zeros((2, angles.shape[1]))
    if ABOVE * cutoff > 0.8 * 0.5 / period:
        return nothing
    both = np.column_stack([angles, rates, response])
    smooth, smoother = (low_pass(both, period, share * cutoff) for share in (ABOVE, ABOVE / 2))
    whole = complete(smoother) & complete(both)
    if whole.sum() < FEWEST:
        return nothing
    white, turned = _mean_squares(period, cutoff)
    parts = [_unexplained(part, whole, nothing.size) for part in (both - smooth, smooth - smoother)]
    wide, narrow = (
        _mean_square(part).reshape(nothing.shape) / share
        for part, share in zip(parts, white[1:], strict=True)
    )
    # Encoders' noise is in both, a gyroscope's and an attitude's in one of them alone.
    angle, rate = np.hsplit(parts[1], 2)
    turn = differentiate(angle, period)
    square = np.sum(turn**2, axis=0)
    common = np.clip(np.sum(turn * rate, axis=0) / np.where(square > 0, square, np.inf), 0.0, 1.0)
    own = _mean_square(rate - common * turn) - common * (1 - common) * narrow[0] * turned[1]
    found = np.minimum(wide, narrow)
    beside = np.minimum(wide[1], np.maximum(own, 0.0) / white[2])
    of_rates = np.minimum(found[1] * white[0], beside * white[0] + common * found[0] * turned[0])
    return np.asarray([found[0] * white[0], of_rates])


def _mean_square(values: Array) -> Array:
    """Of normal noise (n, k), whatever spikes stand in it, (k,)."""
    return np.asarray((NORMAL * median(np.abs(values.T))) ** 2)


@lru_cache(maxsize=16)
def _mean_squares(period: float, cutoff: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """What is left of white noise behind the filter at `cutoff`, above `ABOVE` cutoffs, and just below; and of its
    derivative (`differentiate`) [1/s²] behind the filter, and just below."""
    frequency = np.linspace(0.0, 0.5 / period, 2000, endpoint=False)
    passed, wide, narrow = (gain(frequency, period, share * cutoff) for share in (1, ABOVE, ABOVE / 2))
    turn = 2 * np.pi * frequency * period
    slope = (8 * np.sin(turn) - np.sin(2 * turn)) / (6 * period)
    white = tuple(float(np.mean(each**2)) for each in (passed, 1 - wide, wide - narrow))
    return white, tuple(float(np.mean((slope * each) ** 2)) for each in (passed, wide - narrow))


def _unexplained(band: Array, whole: Mask, count: int) -> Array:
    """The first `count` columns of a band less what the other columns and their rates explain, the whole samples."""
    response = band[:, count:]
    joint = np.hstack([band, np.gradient(response, axis=0)])
    kept = whole & complete(joint)
    joint = joint if kept.all() else joint[kept]
    values, explaining = joint[:, :count], joint[:, count:]
    products = explaining.T @ joint
    return np.asarray(values - explaining @ solved(products[:, count:], products[:, :count]))


def attenuation(blocks: Sequence[Block], values: Array, *, shared_offset: bool) -> Array | None:
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


def slow_attenuation(blocks: Sequence[Block], slope: float, *, shared_offset: bool = False) -> Array:
    """What errors of the first column may have taken off the values (k,), which change slowly, as an attitude wanders:
    `slope` is the response's change with that column.

    Within a stance, or a second of standing, they are nearly a parabola in time. What a fit leaves of the response
    along such curves may be the response's own error, and takes nothing then, or all that column's.
    """
    size = blocks[0].regressor.shape[1]
    if blocks[0].stances is None or shared_offset:
        inverse = information_inverse(blocks, shared_offset=shared_offset)
        found = fit_blocks(blocks, shared_offset=shared_offset)
        squares, left = found.squares, [found.residuals[block.label] for block in blocks]
    else:
        solution = StanceProblem.drawn_together(blocks).solve()
        squares, inverse = solution.squares, solution.inverse
        left = [
            block.response - design(block, own.size - 1) @ np.concatenate([solution.values, own])
            for block, own in zip(blocks, solution.own, strict=True)
        ]
    along = squares - sum(
        _beside_parabolas(own, block.stances or _seconds(block))
        for block, own in zip(blocks, left, strict=True)
    )
    return np.asarray(inverse[:size, 0] * (along / slope if along > 0 else 0.0))


def mostly_error(blocks: Sequence[Block], value: float) -> bool:
    """Whether slow errors of the first column may have taken more of its `value` than the share DRAWN: then the blocks
    tell nothing that holds elsewhere."""
    return bool(slow_attenuation(blocks, value)[0] > DRAWN * abs(value))


def slow_share(block: Block, left: Array, slope: float) -> float:
    """By which share, at most 1, errors of the first column that change slowly may have drawn its value in one standing
    block to zero: all that a `slope` common to several blocks leaves of its response, `left` (n,), may be theirs. 0
    where the block's own value is no smaller, or so far past zero that errors do not do it.
    """
    change = float(fit_blocks([replace(block, response=left)]).values[0])
    if not -PAST_ZERO * slope < change < 0:
        return 0.0
    along = max(float(left @ left) - _beside_parabolas(left, _seconds(block)), 0.0)
    return min(along * float(information_inverse([block])[0, 0]) / slope**2, 1.0)


def _seconds(block: Block) -> StanceRows:
    """The rows of a block, second by second."""
    rows = np.arange(len(block.response))
    return StanceRows((rows * block.period / SECOND).astype(np.intp), np.ones(len(rows)))


def _beside_parabolas(left: Array, parts: StanceRows) -> float:
    """The weighted squares of what is left (n,) beside a parabola in time of each part."""
    rows = parts.split()
    lengths = np.array([len(own) for own in rows])
    firsts = np.cumsum(lengths) - lengths
    order = np.concatenate(rows)
    place = np.arange(len(order)) - np.repeat(firsts, lengths)
    time = 2.0 * place / np.repeat(np.maximum(lengths - 1, 1), lengths) - 1.0  # -1 to 1 in each part
    weight, missed = parts.weight[order], left[order]
    square = time * time
    powers = np.array([np.ones_like(time), time, square, square * time, square * square]) * weight
    sums = np.add.reduceat(powers, firsts, axis=1).T
    along = np.add.reduceat(powers[:3] * missed, firsts, axis=1).T[:, :, None]
    products = sums[:, np.add.outer(np.arange(3), np.arange(3))]
    curves = np.linalg.pinv(products, rcond=RANK_TOLERANCE, hermitian=True) @ along
    return float(weight @ missed**2 - np.sum(along * curves))


def offsets_moved(blocks: Sequence[Block], change: Array, *, shared_offset: bool) -> dict[str, float]:
    """How each block's offset follows values that move by `change` (k,): its mean response stays explained."""
    means = {one.label: one.regressor.mean(axis=0) for one in blocks}
    if shared_offset:
        means = dict.fromkeys(means, np.concatenate([one.regressor for one in blocks]).mean(axis=0))
    return {label: -float(mean @ change) for label, mean in means.items()}
