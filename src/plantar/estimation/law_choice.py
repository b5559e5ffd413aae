"""Which law of the bush: judged on what the fit has not seen, the simpler one kept unless the gain is clear.

A gain is clear when the squared error on held-out pieces falls by more than one standard error of its fall
(pieces paired), and its root by at least `LEAST_GAIN`. Of all laws that the best one does not clearly beat,
the one with the fewest parameters is chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array
from plantar.errors import DataError
from plantar.estimation.law_fit import LawFit, refine
from plantar.estimation.law_search import Numbers, Pieces, fit_pieces, held_out_squares
from plantar.estimation.law_trials import Prepared, Trial, prepare_trials
from plantar.models import LAWS, KelvinVoigt, Law, reach

LEAST_GAIN = 0.10  # of the held-out rms error
TELLING_GAIN = (
    0.3  # of the held-out rms error: so much better, a law that cannot be identified is still told of
)
FOLDS = 5  # contiguous parts that recordings are cut into where they cannot stand for one another
SEED_REACH = 2.2  # ratio of shapes to those of a simpler law, within which a richer one is looked for
TOLD = 4.0  # deviations from zero of a term that a law adds to a simpler one
HOPELESS = 6.0  # times the best law's squares, at its best candidate shape: such a law's shape is not refined
DOMINANT = 0.5  # share of all motion in one recording, above which the others cannot stand for it
FEWEST_RECORDINGS = 3  # for whole recordings to be held out


@dataclass(frozen=True)
class LawScore:
    """One law: error on held-out pieces [N·m rms], fit, and why it could not be chosen (None where it could)."""

    law: Law
    held_out_rms: float
    fit: LawFit
    refused: str | None
    chosen: bool = False

    @property
    def parameters(self) -> int:
        """How many the bush has under this law."""
        return self.law.size


@dataclass(frozen=True)
class LawChoice:
    """The chosen law's fit, the linear equivalent (K, C of Kelvin-Voigt over the same motions), and the ranking.

    `untried` are laws that elaborate one which gained nothing, add nothing to it, or need what the motions lack. What
    holds, holds for deflections up to `reach` [rad] from the middle: an element that none of these motions
    made slip counts as part of the spring. `caution` says so where the motions show that there is one.
    """

    fit: LawFit
    equivalent: LawFit
    ranking: tuple[LawScore, ...]
    held_out: str
    reason: str
    untried: tuple[str, ...]
    reach: float
    caution: str | None


def choose_law(
    trials: Sequence[Trial],
    laws: Sequence[Law] = tuple(LAWS.values()),
    cutoff: float = 5.0,
    *,
    shared_offset: bool = False,
) -> LawChoice:
    """Fit every law, hold pieces out in turn, and choose. Laws must include Kelvin-Voigt.

    Whole recordings are held out where there are at least three and none has more than half of the motion;
    else contiguous fifths of every recording. Raises DataError where no sample serves.
    """
    prepared = prepare_trials(trials, cutoff)
    if not prepared:
        raise DataError(
            "no recording has a sample that serves this fit (valid: at least one standing second)"
        )
    folds, whole = _folds(prepared)
    rows = sum(len(fold) for fold in folds)
    scores: list[LawScore] = []
    errors: list[Array] = []
    untried: list[str] = []
    motions = [each.motion for each in prepared]

    def judge(contender: _Contender) -> None:
        least = min((score.fit.rms for score in scores), default=np.inf) ** 2 * rows
        hopeless = contender.squares > HOPELESS * least
        fit, squares = _judge(contender, prepared, folds, whole, shared_offset, refined=not hopeless)
        scores.append(LawScore(contender.law, float(np.sqrt(squares.sum() / rows)), fit, _refusal(fit)))
        errors.append(squares)

    untried += [law.name for law in laws if not law.applies(motions)]
    simple = [
        _Contender.of(law, prepared, folds, shared_offset)
        for law in laws
        if law.elaborates is None and law.name not in untried
    ]
    for contender in sorted(simple, key=lambda each: each.squares):
        judge(contender)
    names = [score.law.name for score in scores]
    linear = names.index(KelvinVoigt.name)
    for law in (each for each in laws if each.elaborates is not None and each.name not in untried):
        seed = None
        if law.elaborates in names:
            place = names.index(law.elaborates)
            seed = scores[place].fit
            if not _clear(scores, errors, simple=linear, rich=place):
                untried.append(law.name)
                continue
        judge(_Contender.of(law, prepared, folds, shared_offset, seed))
        if seed is not None and not _adds(scores[-1].fit, seed):
            untried.append(scores.pop().law.name)
            errors.pop()
    winner = _winner(scores, errors)
    chosen = replace(scores[winner], chosen=True)
    ranking = [chosen if place == winner else score for place, score in enumerate(scores)]
    held_out = "whole recordings" if whole else f"{FOLDS} contiguous parts of each recording"
    return LawChoice(
        fit=chosen.fit,
        equivalent=scores[linear].fit,
        ranking=tuple(sorted(ranking, key=lambda score: score.held_out_rms)),
        held_out=held_out,
        reason=_reason(chosen, scores[linear], held_out),
        untried=tuple(untried),
        reach=reach(motions),
        caution=_caution(scores, errors, winner),
    )


def _folds(prepared: Sequence[Prepared]) -> tuple[list[Numbers], bool]:
    """Number of the fold of every sample that serves, and whether folds are whole recordings."""
    moved = np.array([np.sum((e.base[:, 0] - e.base[:, 0].mean()) ** 2) for e in prepared])
    if len(prepared) >= FEWEST_RECORDINGS and moved.max() <= DOMINANT * moved.sum():
        return [np.full(int(e.used.sum()), place, dtype=np.intp) for place, e in enumerate(prepared)], True
    counts = [int(e.used.sum()) for e in prepared]
    return [np.arange(count, dtype=np.intp) * FOLDS // max(count, 1) for count in counts], False


@dataclass(frozen=True)
class _Contender:
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
    ) -> _Contender:
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


def _judge(
    contender: _Contender,
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


def _refusal(fit: LawFit) -> str | None:
    if isinstance(fit.law, KelvinVoigt):
        return None
    if not fit.law.possible(fit.values):
        return "would make energy of its own"
    return "; ".join(fit.doubts) or None


def _adds(fit: LawFit, simpler: LawFit) -> bool:
    """Whether every term that a law adds to the one it elaborates is told from zero."""
    added = range(len(simpler.law.terms), len(fit.law.terms))
    return all(abs(fit.values[k]) > TOLD * np.sqrt(fit.covariance[k, k]) for k in added)


def _winner(scores: Sequence[LawScore], errors: Sequence[Array]) -> int:
    allowed = [place for place, score in enumerate(scores) if score.refused is None]
    best = min(allowed, key=lambda place: scores[place].held_out_rms)
    simple_first = sorted(allowed, key=lambda place: (scores[place].parameters, scores[place].held_out_rms))
    return next(
        place
        for place in simple_first
        if place == best or not _clear(scores, errors, simple=place, rich=best)
    )


def _clear(scores: Sequence[LawScore], errors: Sequence[Array], *, simple: int, rich: int) -> bool:
    """Whether the richer law's gain over the simpler one is clear.

    What a law adds to the one that it elaborates has been told from zero before: it only must not predict worse.
    """
    if scores[rich].law.elaborates == scores[simple].law.name:
        return scores[rich].held_out_rms < scores[simple].held_out_rms
    fall = errors[simple] - errors[rich]
    standard_error = float(np.std(fall) * np.sqrt(len(fall)))
    enough = scores[rich].held_out_rms < (1 - LEAST_GAIN) * scores[simple].held_out_rms
    return enough and float(fall.sum()) > standard_error


def _caution(scores: Sequence[LawScore], errors: Sequence[Array], winner: int) -> str | None:
    """Whether a law that was refused predicts clearly better: then the bush is not as the chosen law says."""
    better = [
        place
        for place, score in enumerate(scores)
        if score.refused is not None
        and score.held_out_rms < (1 - TELLING_GAIN) * scores[winner].held_out_rms
        and _clear(scores, errors, simple=winner, rich=place)
    ]
    if not better:
        return None
    best = scores[min(better, key=lambda place: scores[place].held_out_rms)]
    return (
        f"{best.law.name} predicts held-out motion better ({best.held_out_rms:.3g} against "
        f"{scores[winner].held_out_rms:.3g} rms) but cannot be identified: {best.refused}; stiffness and damping "
        "are those of these motions only (record larger motions)"
    )


def _reason(chosen: LawScore, linear: LawScore, held_out: str) -> str:
    if chosen.law.name == linear.law.name:
        return f"no richer law predicts {held_out} clearly better than spring and damper"
    gain = 100 * (1 - chosen.held_out_rms / linear.held_out_rms) if linear.held_out_rms > 0 else 0.0
    return (
        f"held-out {held_out}: {chosen.law.name} misses by {chosen.held_out_rms:.3g} rms, spring and damper by "
        f"{linear.held_out_rms:.3g} ({gain:.0f} % less)"
    )
