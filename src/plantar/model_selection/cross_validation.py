"""One law of the bush among others: its candidate shapes, its fit, and its error on what the fit has not seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.model_selection.data_sets import Prepared
from plantar.model_selection.grid import Numbers, Pieces, fit_pieces, held_out_squares
from plantar.model_selection.model_fit import LawFit, refine
from plantar.models import Law

FOLDS = 5  # contiguous parts that recordings are cut into where they cannot stand for one another
SEED_REACH = 2.2  # ratio of shapes to those of a simpler law, within which a richer one is looked for
DOMINANT = 0.5  # share of all motion in one recording, above which the others cannot stand for it
FEWEST_RECORDINGS = 3  # for whole recordings to be held out


def folds_of(prepared: Sequence[Prepared]) -> tuple[list[Numbers], bool]:
    """Number of the fold of every sample that serves, and whether folds are whole recordings."""
    moved = np.array([np.sum((e.base[:, 0] - e.base[:, 0].mean()) ** 2) for e in prepared])
    if len(prepared) >= FEWEST_RECORDINGS and moved.max() <= DOMINANT * moved.sum():
        return [np.full(int(e.used.sum()), place, dtype=np.intp) for place, e in enumerate(prepared)], True
    counts = [int(e.used.sum()) for e in prepared]
    return [np.arange(count, dtype=np.intp) * FOLDS // max(count, 1) for count in counts], False


@dataclass(frozen=True)
class Contender:
    """A law with its candidate shapes, their limits (2, s), and the squares that the best candidate leaves."""

    law: Law
    pieces: Pieces
    limits: Array
    squares: float

    @classmethod
    def of(
        cls,
        law: Law,
        prepared: Sequence[Prepared],
        folds: Sequence[Numbers],
        shared_offset: bool,
        seed: LawFit | None = None,
    ) -> Contender:
        """`seed` is the fit of a simpler law, near whose first shape term and starts this one's are looked for."""
        shapes = law.candidates([each.motion for each in prepared])
        limits = np.array([shapes.min(axis=0), shapes.max(axis=0)])
        starts = None
        if seed is not None:
            ratio = np.abs(np.log(shapes[:, 0] / seed.shape[0]))
            shapes = shapes[ratio <= max(np.log(SEED_REACH), ratio.min())]
            starts = list(seed.starts.values())
        pieces = Pieces.of(law, prepared, folds, shapes, starts)
        everything = np.ones(len(pieces.grams), dtype=bool)
        squares = fit_pieces(pieces, everything, shared_offset=shared_offset).squares
        return cls(law, pieces, limits, float(squares.min()))


def judge(
    contender: Contender,
    prepared: Sequence[Prepared],
    folds: Sequence[Numbers],
    whole: bool,
    shared_offset: bool,
    *,
    refined: bool,
) -> tuple[LawFit, Array]:
    """The law's fit to everything, and its squared error on each piece from fits that have not seen it."""
    pieces = contender.pieces
    fit = refine(pieces, prepared, contender.limits, shared_offset=shared_offset, refined=refined)
    if pieces.shapes.shape[1] and refined:
        pieces = pieces.with_shape(fit.shape, list(fit.starts.values()), prepared, folds)
    squares = np.zeros(len(pieces.grams))
    for fold in np.unique(pieces.fold):
        held = pieces.fold == fold
        rest = fit_pieces(pieces, ~held, shared_offset=shared_offset)
        best = int(np.argmin(rest.squares))
        squares[held] = held_out_squares(pieces, rest, held, best, whole=whole)
    return fit, np.maximum(squares, 0.0)
