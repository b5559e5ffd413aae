"""Cross-validation of one bush model: its candidate parameters, and its error on what the fit has not seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.model_selection.data_sets import FilteredDataSet
from plantar.model_selection.grid import Fits, Numbers, Pieces, fit_all, fit_pieces, held_out_squares
from plantar.model_selection.model_fit import ModelFit
from plantar.models import BushModel

FOLDS = 5  # contiguous parts that recordings are cut into where they cannot stand for one another
# Ratio to the nonlinear parameters of a simpler model, within which a richer one's are looked for.
SEED_REACH = 2.2
DOMINANT = 0.5  # share of all motion in one recording, above which the others cannot stand for it
FEWEST_RECORDINGS = 3  # for whole recordings to be held out


def folds_of(prepared: Sequence[FilteredDataSet]) -> tuple[list[Numbers], bool]:
    """Number of the fold of every used sample, and whether folds are whole recordings."""
    moved = np.array([np.sum((e.base[:, 0] - e.base[:, 0].mean()) ** 2) for e in prepared])
    if len(prepared) >= FEWEST_RECORDINGS and moved.max() <= DOMINANT * moved.sum():
        return [np.full(int(e.used.sum()), place, dtype=np.intp) for place, e in enumerate(prepared)], True
    counts = [int(e.used.sum()) for e in prepared]
    return [np.arange(count, dtype=np.intp) * FOLDS // max(count, 1) for count in counts], False


@dataclass(frozen=True)
class Candidate:
    """A model, its candidate nonlinear parameters, their limits (2, s), and the fits of all of them."""

    model: BushModel
    pieces: Pieces
    limits: Array
    fits: Fits

    @property
    def squares(self) -> float:
        """What the best candidate leaves."""
        return float(self.fits.squares.min())

    @classmethod
    def of(
        cls,
        model: BushModel,
        prepared: Sequence[FilteredDataSet],
        folds: Sequence[Numbers],
        shared_offset: bool,
        seed: ModelFit | None = None,
    ) -> Candidate:
        """`seed`: an earlier fit, or that of a simpler model; this one's first nonlinear parameter and initial states
        are near its."""
        shapes = model.candidates([each.motion for each in prepared])
        limits = np.array([shapes.min(axis=0), shapes.max(axis=0)])
        initial_states = None
        if seed is not None and len(seed.shape):
            ratio = np.abs(np.log(shapes[:, 0] / seed.shape[0]))
            shapes = shapes[ratio <= max(np.log(SEED_REACH), ratio.min())]
            initial_states = list(seed.initial_states.values())
        pieces = Pieces.of(model, prepared, folds, shapes, initial_states)
        return cls(model, pieces, limits, fit_all(pieces, shared_offset))

    def pieces_about(
        self, fit: ModelFit, prepared: Sequence[FilteredDataSet], folds: Sequence[Numbers]
    ) -> Pieces:
        """The pieces with the fit's nonlinear parameters and initial states among the candidates."""
        if not self.pieces.shapes.shape[1]:
            return self.pieces
        return self.pieces.with_shape(fit.shape, list(fit.initial_states.values()), prepared, folds)


def cross_validate(pieces: Pieces, *, whole: bool, shared_offset: bool) -> Array:
    """A model's squared error on each piece (pieces,) from fits that have not seen it."""
    squares = np.zeros(len(pieces.grams))
    begin = fit_all(pieces, shared_offset).initial_states
    for fold in np.unique(pieces.fold):
        held = pieces.fold == fold
        rest = fit_pieces(pieces, ~held, shared_offset=shared_offset, begin=begin)
        best = int(np.argmin(rest.squares))
        squares[held] = held_out_squares(pieces, rest, held, best, whole=whole)
    return np.maximum(squares, 0.0)
