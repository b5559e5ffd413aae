"""Which bush model: by cross-validation, the simpler one kept unless the gain is clear.

A gain is clear when the squared error on held-out pieces falls by more than one standard error of its fall
(pieces paired), and its root by at least `LEAST_GAIN`; what a model adds to the one that it elaborates must differ from
zero by `TOLD` deviations, and then must only not predict worse. Of all models that the best one does not clearly beat,
the one with the fewest parameters is chosen. If a rejected model predicts clearly better, plantar falls back to
Kelvin-Voigt and warns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array
from plantar.errors import DataError
from plantar.model_selection.cross_validation import FOLDS, Candidate, cross_validate, folds_of
from plantar.model_selection.data_sets import DataSet, prepare_data_sets
from plantar.model_selection.model_fit import ModelFit, refine, where_it_rested
from plantar.model_selection.variable_projection import Problem, best_candidate
from plantar.models import MODELS, BushModel, KelvinVoigt, StandardLinearSolid, reach
from plantar.models.standard_linear_solid import RELAXATION_TIME

LEAST_GAIN = 0.10  # of the held-out rms error
# Of the held-out rms error: a model that cannot be identified but is this much better is mentioned.
TELLING_GAIN = 0.3
TOLD = 4.0  # standard deviations from zero, of a term that a model adds to a simpler one
LEAST_CREEP = 0.08  # of the stiffness, that rubber which yields slowly takes off it
# Times the best model's squares, at its best candidate: such a model is not refined. Nor is one, where only a large
# gain is clear, whose best candidate gains less than is mentioned: candidates lack little of what such elements show.
HOPELESS = 6.0


@dataclass(frozen=True)
class ModelScore:
    """One model: error on held-out pieces [N·m rms], fit, and why it could not be chosen (None where it could)."""

    model: BushModel
    held_out_rms: float
    fit: ModelFit
    refused: str | None
    chosen: bool = False

    @property
    def parameters(self) -> int:
        """How many the bush has under this model."""
        return self.model.size


@dataclass(frozen=True)
class ModelChoice:
    """The chosen model's fit, the linear equivalent (K, C of Kelvin-Voigt over the same motions), and the ranking.

    What holds, holds for deflections up to `reach` [rad] from the middle: an element that none of these motions made
    slip counts as part of the spring. `caution` says so where the motions show that there is one, or that the rubber
    `creeps`.
    """

    fit: ModelFit
    equivalent: ModelFit
    ranking: tuple[ModelScore, ...]
    held_out: str
    reason: str
    reach: float
    caution: str | None
    creeps: bool = False

    @property
    def spring(self) -> ModelScore:
        """What spring and damper came to."""
        return next(score for score in self.ranking if isinstance(score.model, KelvinVoigt))


def choose_model(
    data_sets: Sequence[DataSet],
    models: Sequence[BushModel] = tuple(MODELS.values()),
    cutoff: float = 5.0,
    *,
    shared_offset: bool,
    least_gain: float = LEAST_GAIN,
    before: ModelChoice | None,
) -> ModelChoice:
    """Fit every model, hold pieces out in turn, and choose. Models must include Kelvin-Voigt.

    `before`: the choice for the same recordings with a few samples more; a fit goes on from there where no candidate is
    better. Whole recordings are held out where there are at least three and none has more than half of the motion;
    else contiguous fifths of every recording. Raises DataError where no sample can be used.
    """
    prepared = prepare_data_sets(data_sets, cutoff, drift=not shared_offset)
    if not prepared:
        raise DataError(
            "no recording has a sample that this fit can use (valid: at least one standing second)"
        )
    folds, whole = folds_of(prepared)
    rows = sum(len(fold) for fold in folds)
    motions = [each.motion for each in prepared]
    applicable = [model for model in models if model.applies(motions)]
    earlier = {} if before is None else {score.model.name: score.fit for score in before.ranking}
    simple = sorted(
        (
            Candidate.of(model, prepared, folds, shared_offset, earlier.get(model.name))
            for model in applicable
            if model.elaborates is None
        ),
        key=lambda each: each.squares,
    )
    linear = [candidate.model.name for candidate in simple].index(KelvinVoigt.name)
    scores: list[ModelScore] = []
    errors: list[Array] = []
    # Simple models first, the best one before the others; then what elaborates them, near their fits.
    order: list[Candidate | BushModel] = [
        *simple,
        *(each for each in applicable if each.elaborates is not None),
    ]
    for each in order:
        simpler = None
        if isinstance(each, Candidate):
            candidate = each
        else:
            place = next((k for k, score in enumerate(scores) if score.model.name == each.elaborates), None)
            if place is not None:
                simpler = scores[place].fit
                if not _clear(scores, errors, least_gain, simple=linear, rich=place):
                    continue
            candidate = Candidate.of(each, prepared, folds, shared_offset, simpler)
        most = HOPELESS * min((score.fit.rms for score in scores), default=np.inf) ** 2 * rows
        if least_gain > TELLING_GAIN:
            most = min(most, (1 - TELLING_GAIN) ** 2 * simple[linear].squares)
        refined = not candidate.squares > most
        problem = Problem(candidate.pieces.model, prepared, shared_offset)
        start, rested = best_candidate(problem, candidate.pieces, candidate.fits), False
        if refined and (known := earlier.get(problem.model.name)) is not None:
            again = where_it_rested(problem, known)
            rested = again.squares < start.squares
            start = again if rested else start
        fit = refine(problem, start, candidate.limits, refined=refined, rested=rested)
        if simpler is not None and not _adds(fit, simpler):
            continue
        pieces = candidate.pieces_about(fit, prepared, folds) if refined else candidate.pieces
        squares = cross_validate(pieces, whole=whole, shared_offset=shared_offset)
        scores.append(ModelScore(fit.model, float(np.sqrt(squares.sum() / rows)), fit, _refusal(fit)))
        errors.append(squares)
    scores = [_hardly_shown(score, scores[linear]) for score in scores]
    winner = _winner(scores, errors, linear, least_gain)
    chosen = replace(scores[winner], chosen=True)
    ranking = [chosen if place == winner else score for place, score in enumerate(scores)]
    held_out = "whole recordings" if whole else f"{FOLDS} contiguous parts of each recording"
    better = _clearly_better(scores, errors, winner, least_gain, whole=whole)
    return ModelChoice(
        fit=chosen.fit,
        equivalent=scores[linear].fit,
        ranking=tuple(sorted(ranking, key=lambda score: score.held_out_rms)),
        held_out=held_out,
        reason=_reason(chosen, scores[linear], held_out),
        reach=reach(motions),
        caution=_caution(scores, errors, winner, least_gain, whole=whole),
        creeps=whole and better is not None and _creeps(better.fit, chosen.fit),
    )


def _hardly_shown(score: ModelScore, linear: ModelScore) -> ModelScore:
    """The score, refused where few turns of the path show its nonlinear parameters and it gains less than a telling
    model does."""
    if score.refused or score.held_out_rms < (1 - TELLING_GAIN) * linear.held_out_rms:
        return score
    return replace(score, refused=score.model.hardly_shown(score.fit.shape, score.fit.limits))


def _refusal(fit: ModelFit) -> str | None:
    if isinstance(fit.model, KelvinVoigt):
        return None
    if not fit.model.possible(fit.values):
        return "is not passive"
    return "; ".join(fit.doubts) or None


def _adds(fit: ModelFit, simpler: ModelFit) -> bool:
    """Whether every term that a model adds to the one it elaborates is told from zero."""
    added = range(len(simpler.model.terms), len(fit.model.terms))
    return all(abs(fit.values[k]) > TOLD * np.sqrt(fit.covariance[k, k]) for k in added)


def _winner(scores: Sequence[ModelScore], errors: Sequence[Array], linear: int, least_gain: float) -> int:
    """The simplest model that the best one does not clearly beat.

    Where a rejected model, one that cannot be identified, clearly beats that one, fall back to Kelvin-Voigt.
    """
    allowed = [place for place, score in enumerate(scores) if score.refused is None]
    best = min(allowed, key=lambda place: scores[place].held_out_rms)
    simple_first = sorted(allowed, key=lambda place: (scores[place].parameters, scores[place].held_out_rms))
    winner = next(
        place
        for place in simple_first
        if place == best or not _clear(scores, errors, least_gain, simple=place, rich=best)
    )
    # A rejected model that predicts clearly better shows that the winner is wrong too: fall back to Kelvin-Voigt.
    refused = (place for place, score in enumerate(scores) if score.refused is not None)
    return (
        linear
        if any(_clear(scores, errors, least_gain, simple=winner, rich=place) for place in refused)
        else winner
    )


def _clear(
    scores: Sequence[ModelScore], errors: Sequence[Array], least_gain: float, *, simple: int, rich: int
) -> bool:
    """Whether the richer model's gain over the simpler one is clear.

    Terms that a model adds to the one that it elaborates have been told from zero before: it only must not predict
    worse. Of one that adds nothing but another shape, nothing has been told.
    """
    adds_terms = len(scores[rich].model.terms) > len(scores[simple].model.terms)
    if scores[rich].model.elaborates == scores[simple].model.name and adds_terms:
        return scores[rich].held_out_rms < scores[simple].held_out_rms
    fall = errors[simple] - errors[rich]
    standard_error = float(np.std(fall) * np.sqrt(len(fall)))
    enough = scores[rich].held_out_rms < (1 - least_gain) * scores[simple].held_out_rms
    return enough and float(fall.sum()) > standard_error


def _caution(
    scores: Sequence[ModelScore], errors: Sequence[Array], winner: int, least_gain: float, *, whole: bool
) -> str | None:
    """Whether a model that was not chosen predicts clearly better: then the bush is not as the chosen model says.

    It was refused, or in short stances, whose states are free, gains less than the `least_gain` asked for there.
    """
    best = _clearly_better(scores, errors, winner, least_gain, whole=whole)
    if best is None:
        return None
    if whole and _creeps(best.fit, scores[winner].fit):
        return (
            f"rubber that goes on yielding for {best.fit.value(RELAXATION_TIME):.2g} s or longer predicts held-out "
            f"motion better ({best.held_out_rms:.3g} against {scores[winner].held_out_rms:.3g} rms); under a load that "
            "stays the stiffness is smaller (record slow motions, each lean held for half a minute)"
        )
    why = best.refused or "by too little for steps as short as these"
    return (
        f"{best.model.name} predicts held-out motion better ({best.held_out_rms:.3g} against "
        f"{scores[winner].held_out_rms:.3g} rms) but {why}; stiffness and damping are those of these motions only "
        "(record larger motions)"
    )


def _clearly_better(
    scores: Sequence[ModelScore], errors: Sequence[Array], winner: int, least_gain: float, *, whole: bool
) -> ModelScore | None:
    """The best model of those that predict clearly better than the winner.

    Of one that was refused for its slowness alone a smaller gain tells, as of one that is chosen, where `whole`
    recordings are held out: within one the attitude's wander gains as much.
    """
    least = min(least_gain, TELLING_GAIN)
    better = [
        score
        for place, score in enumerate(scores)
        if score.held_out_rms
        < (1 - (least if whole and _creeps(score.fit, scores[winner].fit) else TELLING_GAIN))
        * scores[winner].held_out_rms
        and _clear(scores, errors, least, simple=winner, rich=place)
    ]
    return min(better, key=lambda score: score.held_out_rms, default=None)


def _creeps(fit: ModelFit, chosen: ModelFit) -> bool:
    """Whether a passive bush of `fit` relaxes more slowly than these motions can show, and by so much that its spring
    is softer than the chosen one by more than other errors make it.

    Of robots on rubber without creep such fits predict other recordings by 11 % better at most, and those that gain so
    much are 3 % softer, which is the attitude's wander.
    """
    return (
        isinstance(fit.model, StandardLinearSolid)
        and fit.model.possible(fit.values)
        and fit.at_upper_end(RELAXATION_TIME)
        and fit.values[0] < (1 - LEAST_CREEP) * chosen.values[0]
    )


def _reason(chosen: ModelScore, linear: ModelScore, held_out: str) -> str:
    if chosen.model.name == linear.model.name:
        return f"no richer model predicts {held_out} clearly better than spring and damper"
    gain = 100 * (1 - chosen.held_out_rms / linear.held_out_rms) if linear.held_out_rms > 0 else 0.0
    return (
        f"on held-out data ({held_out}) it misses by {chosen.held_out_rms:.3g} N·m rms, spring and damper by "
        f"{linear.held_out_rms:.3g} ({gain:.0f} % less)"
    )
