"""Grid search over a model's nonlinear parameters, and its error on held-out pieces, from Gram matrices alone.

Every piece of every recording has one Gram matrix for each candidate of the nonlinear parameters (`shapes`) and of the
initial state. Fits without some pieces are then sums of small matrices: cross-validation costs one pass over the data.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import ROUNDING, Array, Mask
from plantar.model_selection.data_sets import FilteredDataSet, filtered_columns
from plantar.models import BushModel

Numbers = NDArray[np.intp]

NEARBY = 0.2  # how much closer initial states are tried about one that is known already
# Numbers of one column of all candidates that are held at a time: all of a long log's take gigabytes.
TOGETHER = 2**20
ROUNDS = 6  # of fitting parameters and initial states in turn
# Of a column's square about zero: what is left about its mean is rounding, the column is constant.
STILL = 1e-14


@dataclass(frozen=True)
class Pieces:
    """Grams (pieces, g, c, k + 2, k + 2) of [columns, 1, response], for g candidates of the nonlinear parameters and c
    initial states (c, runs) of each data set.

    `data_set`, `run` and `fold` (pieces,) say what each piece is part of; runs are numbered through all data sets, and
    pieces stand in their order.
    `rows` (pieces,) are the samples in each.
    """

    model: BushModel
    shapes: Array
    initial_states: list[Array]
    grams: Array
    data_set: Numbers
    run: Numbers
    fold: Numbers
    rows: Numbers

    @classmethod
    def of(
        cls,
        model: BushModel,
        prepared: Sequence[FilteredDataSet],
        folds: Sequence[Numbers],
        shapes: Array,
        around: Sequence[Array] | None = None,
    ) -> Pieces:
        """Products of every piece: `folds` gives each data set's used samples (n,) the number of their fold.

        Initial states are tried over all their range, or `around` known ones (runs,) of each data set.
        """
        tried = np.array(model.tried_states) * (1.0 if around is None else NEARBY)
        count = len(tried)
        begin: list[Array] = []
        for place, each in enumerate(prepared):
            middle = np.zeros(len(each.motion.runs)) if around is None else around[place]
            begin.append(np.clip(tried[:, None] + middle[None, :], -1.0, 1.0))
        firsts = np.cumsum([0, *(len(each.motion.runs) for each in prepared)])
        run = np.concatenate([first + each.run_of for first, each in zip(firsts, prepared, strict=False)])
        fold, common = np.concatenate(folds), np.concatenate([_common(each) for each in prepared])
        first = np.flatnonzero(np.append(True, (np.diff(run) != 0) | (np.diff(fold) != 0)))
        samples = sum(len(each.motion) for each in prepared)
        together = max(1, TOGETHER // max(1, count * samples))
        grams = []
        for some in np.split(shapes, range(together, len(shapes), together)):
            variants, tiled = np.repeat(some, count, axis=0), [np.tile(own, (len(some), 1)) for own in begin]
            extras = filtered_columns(model, prepared, variants, tiled)
            own = grams_of(common, extras, first)
            grams.append(own.reshape(len(first), len(some), count, *own.shape[2:]))
        data_set = np.searchsorted(firsts, run[first], side="right") - 1
        rows = np.diff(np.append(first, len(run)))
        products = np.concatenate(grams, axis=1)
        return cls(model, shapes, begin, products, data_set, run[first], fold[first], rows)

    @property
    def size(self) -> int:
        """Number of linear parameters k."""
        return int(self.grams.shape[-1]) - 2

    def with_shape(
        self,
        shape: Array,
        initial_states: Sequence[Array],
        prepared: Sequence[FilteredDataSet],
        folds: Sequence[Numbers],
    ) -> Pieces:
        """The pieces with one more candidate `shape` (s,), its initial states tried around the given ones (runs,)."""
        more = Pieces.of(self.model, prepared, folds, shape[None, :], initial_states)
        shapes, grams = (
            np.vstack([self.shapes, more.shapes]),
            np.concatenate([self.grams, more.grams], axis=1),
        )
        return replace(self, shapes=shapes, grams=grams)


@dataclass(frozen=True)
class Fits:
    """For every candidate: parameters (g, k), offsets (g, data sets), the initial state chosen for each piece
    (pieces, g), squares (g,)."""

    values: Array
    offsets: Array
    initial_states: Numbers
    squares: Array


def fit_pieces(pieces: Pieces, chosen: Mask, *, shared_offset: bool, begin: Numbers | None = None) -> Fits:
    """Least squares for every candidate over the `chosen` pieces (pieces,), with the best initial state of each run.

    begin: the states (pieces, g) that the search begins from; those in the middle if left out.
    """
    shapes, count = pieces.grams.shape[1:3]
    if begin is None:
        begin = np.full((len(pieces.grams), shapes), count // 2, dtype=np.intp)
    runs, first = np.unique(pieces.run[chosen], return_index=True)
    grams, data_set = pieces.grams[chosen], pieces.data_set[chosen][first]
    if len(first) < len(grams):
        grams = np.add.reduceat(grams, first)
    begins = np.flatnonzero(np.diff(data_set, prepend=-1))
    states, sets = begin[chosen][first], int(pieces.data_set.max()) + 1
    values, offsets, squares = np.empty((shapes, pieces.size)), np.empty((shapes, sets)), np.empty(shapes)
    moving = np.arange(shapes)  # candidates whose states have not come to rest
    for _ in range(ROUNDS if count > 1 else 1):
        own = grams if len(moving) == shapes else grams[:, moving]
        current = own[np.arange(len(runs))[:, None], np.arange(len(moving)), states[:, moving]]
        totals = np.zeros((sets, *current.shape[1:]))
        totals[data_set[begins]] = np.add.reduceat(current, begins)
        values[moving], offsets[moving], squares[moving] = solve(totals, shared_offset)
        if count == 1:
            break
        better = _best_states(own, totals[data_set] - current, values[moving])
        changed = np.any(better != states[:, moving], axis=0)
        states[:, moving] = better
        moving = moving[changed]
        if not len(moving):
            break
    initial_states = np.full((len(pieces.grams), shapes), count // 2, dtype=np.intp)
    known = np.isin(pieces.run, runs)
    initial_states[known] = states[np.searchsorted(runs, pieces.run[known])]
    return Fits(values, offsets, initial_states, squares)


def fit_all(pieces: Pieces, shared_offset: bool) -> Fits:
    """Least squares for every candidate over all pieces."""
    return fit_pieces(pieces, np.ones(len(pieces.grams), dtype=bool), shared_offset=shared_offset)


def held_out_squares(pieces: Pieces, fits: Fits, held: Mask, shape: int, *, whole: bool) -> Array:
    """Squared error (held pieces,) of one candidate's fit on pieces that it has not seen.

    `whole`: the pieces are recordings that the fit has not seen, with an offset and an initial state of their own; else
    the offset comes from the rest of the same recording, and so does an initial state that does not fade.
    """
    grams, values = pieces.grams[held, shape], fits.values[shape]
    if whole:
        vectors, grams = np.append(values, -1.0)[None, :], _without_offset(grams)
    else:
        offsets = fits.offsets[shape, pieces.data_set[held], None]
        one = np.ones_like(offsets)
        vectors = np.hstack([one * values, offsets, -one])
        if not pieces.model.fading_memory:
            grams = grams[np.arange(len(grams)), fits.initial_states[held, shape], None]
    return np.asarray(np.einsum("pi,pcij,pj->pc", vectors, grams, vectors).min(axis=1))


def _common(each: FilteredDataSet) -> Array:
    return np.column_stack([each.base, np.ones(len(each.response)), each.response])


def grams_of(common: Array, extra: Array, first: Numbers) -> Array:
    """Products (pieces, b, k + 2, k + 2), in the order deflection, rate, extra..., 1, response, of every piece.

    common: deflection, rate, 1 and response, (n, 4); extra: the model's own columns (n, e, b); first (pieces,): the
    first row of each piece.
    """
    samples, own, variants = extra.shape
    flat, ends = extra.reshape(samples, -1), np.append(first[1:], samples)
    across = np.empty((len(first), 4, own, variants))
    inner = np.empty((len(first), own, own, variants))
    outer = np.empty((len(first), 4, 4))
    for place, piece in enumerate(map(slice, first, ends)):
        outer[place] = common[piece].T @ common[piece]
        across[place] = (common[piece].T @ flat[piece]).reshape(4, own, variants)
        np.einsum("neb,nfb->efb", extra[piece], extra[piece], out=inner[place])
    gram = np.empty((len(first), variants, own + 4, own + 4))
    others, mine = np.array([0, 1, own + 2, own + 3]), np.arange(2, own + 2)
    gram[:, :, others[:, None], others] = outer[:, None]
    gram[:, :, others[:, None], mine] = np.moveaxis(across, 3, 1)
    gram[:, :, mine[:, None], others] = np.moveaxis(across, 3, 1).swapaxes(2, 3)
    gram[:, :, mine[:, None], mine] = np.moveaxis(inner, 3, 1)
    return gram


def _without_offset(gram: Array) -> Array:
    """Products (..., k + 1, k + 1) of columns and response about their means."""
    ones = gram[..., -2, :]
    count = np.maximum(ones[..., -2], 1e-300)[..., None, None]
    centred = gram - ones[..., :, None] * ones[..., None, :] / count
    keep = [*range(gram.shape[-1] - 2), gram.shape[-1] - 1]
    return np.asarray(centred[..., keep, :][..., keep])


def solve(totals: Array, shared_offset: bool) -> tuple[Array, Array, Array]:
    """Values (g, k), offsets (g, data sets) and squares (g,) of products (data sets, g, k + 2, k + 2)."""
    centred = _without_offset(totals.sum(axis=0)) if shared_offset else _without_offset(totals).sum(axis=0)
    inner, right = centred[:, :-1, :-1], centred[:, :-1, -1]
    square = np.einsum("gii->gi", inner)
    about_zero = np.einsum("tgii->gi", totals[:, :, :-2, :-2])
    moving = square > STILL * about_zero
    scale = np.where(moving, np.sqrt(np.where(moving, square, 1.0)), np.inf)
    scaled = inner / (scale[:, :, None] * scale[:, None, :]) + ROUNDING * np.eye(inner.shape[1])
    values = np.linalg.solve(scaled, (right / scale)[:, :, None])[:, :, 0] / scale
    squares = centred[:, -1, -1] - np.einsum("gk,gk->g", values, right)
    sums = totals.sum(axis=0, keepdims=True) if shared_offset else totals
    ones = sums[..., -2, :]
    offsets = (ones[..., -1] - np.einsum("tgk,gk->tg", ones[..., :-2], values)) / np.maximum(
        ones[..., -2], 1e-300
    )
    return values, np.repeat(offsets.T, len(totals) // len(sums), axis=1), squares


def _best_states(own: Array, rest: Array, values: Array) -> Numbers:
    """For each of r runs and every candidate the initial state that fits best, with the data set's best offset, (r, g).

    own (r, g, c, k + 2, k + 2): the run's Grams for each state; rest (r, g, k + 2, k + 2): of the rest of its data set.
    """
    vector = np.column_stack([values, np.zeros(len(values)), -np.ones(len(values))])
    both = (vector[:, :, None] * vector[:, None, :]).reshape(len(vector), -1)
    missed = np.einsum("rgcx,gx->rgc", own.reshape(*own.shape[:3], -1), both)
    sums = np.einsum("rgci,gi->rgc", own[..., -2, :], vector)
    sums += np.einsum("rgi,gi->rg", rest[..., -2, :], vector)[:, :, None]
    # Beside what the rest of the data set misses, which is alike for all states.
    squares = missed - sums**2 / np.maximum(rest[:, :, None, -2, -2] + own[..., -2, -2], 1e-300)
    return np.asarray(np.argmin(squares, axis=2))
