"""One axis of one foot: the model that its motions ask for, fitted to all of them (eq. 4 to 7)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plantar.contact.stances import LONGEST_STANCE
from plantar.conventions import Axis
from plantar.estimation import Block, LinearFit, fit_blocks
from plantar.estimation.least_squares import factor_of
from plantar.estimation.stance_problem import StanceProblem
from plantar.feet.fit.corrections import about_true_zero, unattenuated, with_best_offsets
from plantar.feet.fit.hidden_memory import cautioned, may_hide_a_memory
from plantar.feet.fit.memory_fit import about_its_centre, data_sets_about, placed_as, standing
from plantar.feet.place.bush_place import about_its_place
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import blocks_of, data_set_of
from plantar.feet.settings import AUTOMATIC, FeetSettings
from plantar.model_selection.data_sets import DataSet
from plantar.model_selection.model_fit import ModelFit, fit_model
from plantar.model_selection.selection import LEAST_GAIN, ModelChoice, choose_model
from plantar.models import MODELS, BushModel, KelvinVoigt

# Of the torque's variance by spring and damper: below it no model of the bush will help.
LEAST_EXPLAINED = 0.5
FULLY_EXPLAINED = 0.99995  # above it what is left is the sensors' noise
# A short stance begins with an unknown state and offset and ends before it has gone far: of memories
# it tells the simplest, and only where that one explains much.
CANDIDATES_IN_STANCES = ("kelvin_voigt", "elastoplastic")
# Of the held-out rms error: states that are free in every stance take up much by themselves.
LEAST_GAIN_IN_STANCES = 0.5
PLACE_EXPLAINS = 0.5  # of the squares that spring and damper miss: what is left of them about another place
CANDIDATES = (
    "kelvin_voigt", "hardening", "coulomb", "elastoplastic", "hardening_elastoplastic", "bouc_wen",
    "standard_linear_solid",
)  # fmt: skip


def fit_axis(
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    settings: FeetSettings,
    model: BushModel | None = None,
    place: PlaceSpread | None = None,
    timed: bool = True,
    before: AxisFit | None = None,
) -> AxisFit | None:
    """The model given or asked for, or the one that predicts held-out motions; None where no recording has samples.

    What errors of the angles do to its values is taken off, where that matters. `place`: what the robot file's place of
    the bush may be off by; not `timed`: sensors may be late by any time, which looks like a memory: none is chosen.
    `before`: the fit of the same recordings, with a few samples more or about another place, to go on from.
    """
    shared = settings.shared
    if model is None and settings.model != AUTOMATIC:
        model = MODELS[settings.model]
    choice = None if before is None else before.choice
    found = _chosen(recordings, foot, axis, settings, model, place, timed, choice)
    if found is None:
        return None
    fit = found.spring
    if found.richer is not None and found.share is not None:
        fit = about_its_centre(fit, found.richer, found.recordings, found.share)
    elif found.richer is not None:
        fit = standing(fit, found.richer, found.recordings, place, shared)
    fit = about_true_zero(fit, recordings, shared)
    fit = fit if place is None else about_its_place(fit, recordings, place, shared)
    return with_best_offsets(unattenuated(fit, recordings, shared), recordings, shared)


class _Chosen(NamedTuple):
    """A spring and damper, and the richer model that is to take its place, if any, on the recordings that have samples;
    where the foot steps, the `share` of each stance's offset that is its own."""

    spring: AxisFit
    richer: ModelFit | None = None
    recordings: Sequence[Recording] = ()
    share: float | None = None


def _chosen(
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    settings: FeetSettings,
    asked: BushModel | None,
    place: PlaceSpread | None,
    timed: bool,
    before: ModelChoice | None,
) -> _Chosen | None:
    shared = settings.shared
    blocks = blocks_of(recordings, foot, axis, drift=not shared)
    if not blocks:
        return None
    linear = fit_blocks(blocks, shared_offset=shared)
    if isinstance(asked, KelvinVoigt):
        return _Chosen(_of_linear(foot, axis, linear, None, "asked for"))
    steps = blocks[0].stances is not None and not shared
    share = StanceProblem.drawn_together(blocks).own_share if steps else None
    fitted = [recording for recording in recordings if recording.name in linear.offsets]
    data_sets = [data_set_of(each, foot, axis, share or 0.0) for each in fitted]
    if asked is None:
        explained = _explained(linear, blocks)
        small = not steps and may_hide_a_memory([data_set.motion for data_set in data_sets])
        if explained <= LEAST_EXPLAINED or (explained >= FULLY_EXPLAINED and not small):
            return _Chosen(_of_linear(foot, axis, linear, None, _untried(explained)))
    placed = _of_linear(foot, axis, linear, None, "")
    if place is not None and not steps:
        placed = _where_a_spring_turns(placed, fitted, place, shared)
        data_sets = data_sets_about(fitted, placed)
    cutoff = fitted[0].cutoff
    if asked is not None:
        fit = fit_model(asked, data_sets, cutoff, shared_offset=shared)
        spring = _of_linear(foot, axis, linear, None, "asked for")
    else:
        names = CANDIDATES_IN_STANCES if steps else CANDIDATES
        # In short stances a late sensor always looks like one: there it would tell nothing of what it may hide.
        memory = timed if steps else _remembers(data_sets)
        models = [MODELS[name] for name in names if memory or not MODELS[name].remembers]
        gain = LEAST_GAIN_IN_STANCES if steps else LEAST_GAIN
        choice = choose_model(data_sets, models, cutoff, shared_offset=shared, least_gain=gain, before=before)
        choice = cautioned(choice, timed=timed, steps=steps, torn=not (steps or memory))
        fit, spring = choice.fit, _of_linear(foot, axis, linear, choice, choice.reason)
        if fit.model.name == KelvinVoigt.name:
            return _Chosen(spring)
    return _Chosen(spring if steps else placed_as(spring, placed), fit, fitted, share)


def _where_a_spring_turns(
    spring: AxisFit, recordings: Sequence[Recording], place: PlaceSpread, shared: bool
) -> AxisFit:
    """A spring and damper about another place of the bush, where that explains most of what they miss; else as it was.

    What a wrong place adds to the torque must not look like another model. Nor the reverse: beside the memory of
    rubber, a spring finds its place centimetres off.
    """
    moved = about_its_place(spring, recordings, place, shared)
    missed = [
        factor_of(
            blocks_of(recordings, spring.foot, spring.axis, drift=not shared, fit=fit), shared
        ).residual_norm
        for fit in (spring, moved)
    ]
    return moved if missed[1] ** 2 < PLACE_EXPLAINS * missed[0] ** 2 else spring


def _explained(fit: LinearFit, blocks: Sequence[Block]) -> float:
    """Share of the torque's variance, within recordings or stances, that spring and damper explain."""
    varied = missed = 0.0
    for block in blocks:
        parts = [slice(None)] if block.stances is None else block.stances.split()
        residual = fit.residuals[block.label]
        for rows in parts:
            varied += float(np.sum((block.response[rows] - block.response[rows].mean()) ** 2))
            own = 0.0 if block.stances is None else residual[rows].mean()
            missed += float(np.sum((residual[rows] - own) ** 2))
    return 1 - missed / varied if varied > 0 else 0.0


def _untried(explained: float) -> str:
    share = f"spring and damper explain {100 * explained:.4g} % of the torque's variance"
    if explained >= FULLY_EXPLAINED:
        return f"{share}: no richer model is needed"
    return f"{share}: something else than the bush makes this torque, and no richer model was tried"


def _remembers(data_sets: Sequence[DataSet]) -> bool:
    """Whether runs without a gap last long enough for a model with memory: each begins with an unknown state."""
    stances = [run for data_set in data_sets for run in data_set.motion.runs]
    seconds = sum(
        (run.stop - run.start) * data_set.motion.period
        for data_set in data_sets
        for run in data_set.motion.runs
    )
    return bool(stances) and seconds / len(stances) > LONGEST_STANCE


def _of_linear(foot: str, axis: Axis, fit: LinearFit, choice: ModelChoice | None, reason: str) -> AxisFit:
    size = len(fit.values)
    spring = AxisFit(
        foot=foot,
        axis=axis,
        model=KelvinVoigt(),
        values=fit.values,
        shape=np.zeros(0),
        offsets=fit.offsets,
        covariance=fit.covariance[:size, :size],
        freedom=fit.freedom[:size],
        white_std=fit.white_std,
        offset_std={label: fit.offset_std(label) for label in fit.offsets},
        equivalent=(float(fit.values[0]), float(fit.values[1])),
        choice=choice,
        reason=reason,
    )
    return spring.at_place(fit.common_nuisance) if fit.common_nuisance.size else spring
