"""Least squares over many short stances, with deviations that hold where errors hang together.

Errors within a stance hang together, and so may those within a recording: deviations come from refits without one
stance and without one recording, the larger of the two (delete-group jackknife; B. Efron and C. Stein, Annals of
Statistics 9, 1981).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.estimation.blocks import Block, LinearFit
from plantar.estimation.stance_problem import Solution, StanceProblem, common_columns, design

# Whose scatter gives a deviation of its own: of fewer, Student's t is too wide to be of use.
FEWEST_RECORDINGS = 5


def fit_stances(blocks: Sequence[Block]) -> LinearFit:
    """Values common to all blocks, an offset for each recording and one drawn to it for each stance.

    Of `LinearFit.covariance` the part of the offsets is diagonal.
    """
    problem, size = StanceProblem.drawn_together(blocks), blocks[0].regressor.shape[1]
    solution = problem.solve()
    towards = _Prior.of(problem, solution, blocks[0].common_spread)
    values = towards.drawn(solution.values)
    covariance, freedom = _deviations(problem, values, towards)
    common, covariance, freedom = values[size:], covariance[:size, :size], freedom[:size]
    # Each recording's offset follows the values: what they no longer explain of its mean is its own.
    moved = values - solution.values
    own_values = [
        np.append(own[:-1], own[-1] - _weighted_mean(block) @ moved)
        for block, own in zip(blocks, solution.own, strict=True)
    ]
    labels = [block.label for block in blocks]
    residuals = [
        block.response - design(block, own.size - 1) @ np.concatenate([values, own])
        for block, own in zip(blocks, own_values, strict=True)
    ]
    offsets = [_offset_variance(*each, covariance) for each in zip(blocks, residuals, strict=True)]
    rows = sum(block.rows * block.thinned for block in blocks)
    noise = solution.squares / max(rows - len(problem.products) - problem.common, 1.0)
    stances = np.bincount(problem.recording)
    return LinearFit(
        values=values[:size],
        offsets={label: float(own[-1]) for label, own in zip(labels, own_values, strict=True)},
        covariance=_beside(covariance, np.diag(offsets)),
        white_covariance=_beside(
            noise * solution.inverse[:size, :size], np.zeros((len(blocks), len(blocks)))
        ),
        freedom=np.concatenate([freedom, np.maximum(stances - 1.0, 1.0)]),
        residuals=dict(zip(labels, residuals, strict=True)),
        rank=int(np.linalg.matrix_rank(solution.inverse)),
        condition_number=float(np.sqrt(np.linalg.cond(solution.inverse))),
        shared_offset=False,
        common_nuisance=common,
    )


@dataclass(frozen=True)
class _Prior:
    """What was known of common columns before: each coefficient at `places` is zero, give or take its spread.

    `keeps` is the share of a coefficient that the data's own deviation lets stand, `follows` (k, j) how the other
    values follow it in the least squares, `unsure` (k, k) the covariance that the prior leaves.
    """

    places: tuple[int, ...]
    keeps: tuple[float, ...]
    follows: Array
    unsure: Array

    @classmethod
    def of(cls, problem: StanceProblem, solution: Solution, spread: Array | None) -> _Prior:
        size = len(solution.values)
        first = size - (0 if spread is None else len(spread))
        known = (
            [] if spread is None else [first + int(place) for place in np.flatnonzero(np.isfinite(spread))]
        )
        if not known or len(problem.products) == 1:
            return cls((), (), np.zeros((size, 0)), np.zeros((size, size)))
        variance = np.diag(jackknife(problem.without_each_stance)[0])
        keeps, follows, unsure = [], [], np.zeros((size, size))
        for place in known:
            prior = float(spread[place - first]) ** 2 if spread is not None else 0.0
            keep = prior / (prior + variance[place])
            own = float(solution.inverse[place, place])
            # A column without anything in it, as vertical force cells leave, is followed by nothing.
            along = solution.inverse[:, place] / own if own > 0 else np.zeros(size)
            keeps.append(keep)
            follows.append(along)
            unsure += keep * (1 - keep) * variance[place] * np.outer(along, along)
        return cls(tuple(known), tuple(keeps), np.column_stack(follows), unsure)

    def drawn(self, values: Array) -> Array:
        """Values (..., k) with these coefficients drawn to zero and the others following."""
        moved = values.copy()
        for column, (place, keep) in enumerate(zip(self.places, self.keeps, strict=True)):
            moved = moved + ((keep - 1) * moved[..., place])[..., None] * self.follows[:, column]
        return moved


def _deviations(problem: StanceProblem, values: Array, towards: _Prior) -> tuple[Array, Array]:
    """Covariance (k, k) of `values` (k,) and its degrees of freedom (k,)."""
    size = len(values)
    if len(problem.products) == 1:  # nothing to compare with: anything is possible
        return np.diag(values**2), np.ones(size)
    covariance, freedom = jackknife(towards.drawn(problem.without_each_stance))
    if problem.recordings >= FEWEST_RECORDINGS:
        between, of_between = jackknife(towards.drawn(problem.without_each_recording()))
        least = np.maximum(np.diag(covariance), np.finfo(float).tiny)
        growth = np.sqrt(np.maximum(np.diag(between) / least, 1.0))
        covariance = covariance * np.outer(growth, growth)
        freedom = np.where(growth > 1, of_between, freedom)
    return covariance + towards.unsure, freedom


def _weighted_mean(block: Block) -> Array:
    """Mean of the common columns (k + j,), by the weights of the rows."""
    assert block.stances is not None, "a block of a foot that steps"
    return np.asarray(np.average(common_columns(block), axis=0, weights=block.stances.weight))


def jackknife(refits: Array) -> tuple[Array, Array]:
    """Covariance (k, k) from refits (G, k) that lack one group each, and its degrees of freedom (k,)."""
    groups, away = len(refits), refits - refits.mean(axis=0)
    covariance = (groups - 1) / groups * away.T @ away
    return covariance, np.full(refits.shape[1], groups - 1.0)


def _offset_variance(block: Block, residual: Array, covariance: Array) -> float:
    """Of a recording's offset: the scatter of its stances' means, and what the values' uncertainty adds."""
    assert block.stances is not None, "a block of a foot that steps"
    means = [float(np.mean(residual[rows])) for rows in block.stances.split()]
    middle = block.regressor.mean(axis=0)
    own = float(np.var(means, ddof=1)) / len(means) if len(means) > 1 else float(np.var(residual))
    return own + float(middle @ covariance @ middle)


def _beside(first: Array, second: Array) -> Array:
    """Both matrices on the diagonal of a larger one."""
    whole = np.zeros((len(first) + len(second), len(first) + len(second)))
    whole[: len(first), : len(first)] = first
    whole[len(first) :, len(first) :] = second
    return whole
