"""One foot: both axes fitted, widened by what no residual shows, scored, judged and diagnosed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from plantar.contact.reasons import Reason
from plantar.conventions import ROTATIONAL_AXES, Axis, Mask
from plantar.cores import over_cores
from plantar.feet.assess.contradiction import contradiction
from plantar.feet.assess.data_faults import OF_MOMENTS, data_faults, doubted
from plantar.feet.assess.diagnosis import advised, diagnose_axis, mend_first
from plantar.feet.assess.left_out import ON_AN_EDGE, mostly_on_an_edge
from plantar.feet.assess.parameter_rows import axis_rows, missing_rows, unseen_rows
from plantar.feet.assess.play import play_notes
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.assess.scores import score_axis
from plantar.feet.assess.stance_stiffness import stance_stiffness, walk_stiffness
from plantar.feet.assess.zero_jumps import zero_jumps
from plantar.feet.exclusion.outliers import outlier_masks
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.worth import hardly_matters, in_place_of, tells_no_more, too_sure
from plantar.feet.internal_error import gives_up, internal_errors
from plantar.feet.interval_width.between_recordings import (
    Apart,
    AxisDifferences,
    axis_differences,
    recordings_apart,
)
from plantar.feet.interval_width.encoder_delay import encoder_delay_causes
from plantar.feet.interval_width.force_gain import force_gain_causes, force_gain_notes, torque_gain_causes
from plantar.feet.interval_width.imu_turn import imu_turn_causes
from plantar.feet.interval_width.robot_causes import robot_causes
from plantar.feet.interval_width.slip_angle import slip_angle_causes
from plantar.feet.interval_width.systematic import inflated, systematic_causes
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.place.turned_bush import turned_bush_note
from plantar.feet.prepare import PreparedLogs
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import tangent_blocks
from plantar.models import MODELS, BushModel, KelvinVoigt
from plantar.notes import Note
from plantar.results.feet import Diagnosis, Parameter, ValidationRow
from plantar.results.walk_rows import StanceStiffness, WalkStiffness
from plantar.robot.guesses import naming_notes
from plantar.sensors.attitude_scale import ATTITUDE_SCALE
from plantar.sensors.moment_balance import torque_gain_notes

ROUNDS = 3  # of leaving outliers out: a large one hides smaller ones


@dataclass(frozen=True)
class FootFit:
    """What a result holds of one foot: of each axis that could be fitted, and rows that say why one could not."""

    fits: list[AxisFit] = field(default_factory=list)
    parameters: list[Parameter] = field(default_factory=list)
    validation: list[ValidationRow] = field(default_factory=list)
    diagnosis: list[Diagnosis] = field(default_factory=list)
    predictions: Predictions = field(default_factory=dict)
    stances: list[StanceStiffness] = field(default_factory=list)
    walks: list[WalkStiffness] = field(default_factory=list)
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
class FittedFoot:
    """Both axes of one foot as fitted about its `place`: `fits` by axis, `given_up` with the reasons; the logs without
    outliers, `ready`, and `thin`, with no more samples than the fit needs; warnings of `jumps` of a zero."""

    foot: str
    place: PlaceSpread
    fits: Mapping[Axis, AxisFit]
    given_up: dict[Axis, str]
    ready: PreparedLogs
    thin: PreparedLogs
    jumps: Sequence[Note]


def fit_foot(ready: PreparedLogs, foot: str, place: PlaceSpread) -> FittedFoot:
    """Pitch and roll of one foot, and the logs without the samples that leave either model by far.

    What is left out is decided for both axes before either is scored. Clean recordings are fitted once; others again
    without their outliers, under the models first chosen, and at last with the choice made anew.
    """
    given_up: dict[Axis, str] = {}
    thin, several = _thin(ready, foot), False
    fits = _fits(thin, foot, place, {}, given_up)
    for _ in range(ROUNDS):
        masks = _outliers(ready, fits, given_up)
        if not any(masks.values()):
            break
        several = True
        ready = replace(ready, fitted=tuple(_without(one, foot, masks) for one in ready.fitted))
        thin = _thin(ready, foot)
        fits = _fits(thin, foot, place, {axis: fit.model for axis, fit in fits.items()}, given_up)
    fits = _fits(thin, foot, place, {}, given_up) if several else fits
    shared = ready.settings.offset == "shared"
    with gives_up("pitch", given_up):
        if (turned := turned_bush_note(fits, thin.fitted, shared)) is not None:
            fits = {axis: replace(fit, notes=(*fit.notes, turned)) for axis, fit in fits.items()}
    fits = {axis: fit for axis, fit in fits.items() if axis not in given_up}
    jumps: list[Note] = []
    for axis, fit in fits.items():
        with gives_up(axis, given_up):
            jumps.extend(zero_jumps(thin.fitted, fit, shared))
    return FittedFoot(foot, place, fits, given_up, ready, thin, jumps)


def between_all(feet: Sequence[FittedFoot]) -> Apart:
    """By how much recordings differ, where all axes of all feet show it together, also without any one of them; else
    what the robot file allows."""
    told = list[AxisDifferences]()
    for one in feet:
        for axis, fit in one.fits.items():
            with gives_up(axis, one.given_up):
                own = axis_differences(fit, one.thin.fitted, one.ready.settings.offset == "shared")
                told += [] if own is None else [own]
    prior = max(one.ready.robot.uncertainty.between_recordings for one in feet)
    apart = recordings_apart(told, prior)
    # What warms up is the rubber of all axes. One axis that differs alone has that in its own interval.
    others = ([*told[:place], *told[place + 1 :]] for place in range(len(told)))
    if all(recordings_apart(each, prior).shown for each in others):
        return apart
    return apart._replace(share=prior, shown=None)


def without_needless(fitted: FittedFoot, between: Apart) -> FittedFoot:
    """The foot with simpler models where richer ones hardly matter. between: as in `assess_foot`."""
    ready, recordings = fitted.ready, fitted.thin.fitted
    fits = dict(fitted.fits)
    for axis, fit in fitted.fits.items():
        if fit.choice is None or isinstance(fit.model, KelvinVoigt) or axis in fitted.given_up:
            continue
        with gives_up(axis, fitted.given_up):
            unsure = _with_causes(fit, fitted, between)
            if fit.model.elaborates is not None:
                simpler = MODELS[fit.model.elaborates]
                plain = fit_axis(recordings, fit.foot, axis, ready.settings, simpler, fitted.place)
                if plain is not None and tells_no_more(unsure, plain):
                    fit = fits[axis] = in_place_of(fit, plain)
                    unsure = _with_causes(fit, fitted, between)
            spring = fit_axis(recordings, fit.foot, axis, ready.settings, KelvinVoigt(), fitted.place)
            if spring is None or not hardly_matters(unsure, spring):
                continue
            if not too_sure(unsure, _with_causes(spring, fitted, between)):
                fits[axis] = in_place_of(fit, spring)
    return replace(fitted, fits=fits)


def _with_causes(fit: AxisFit, fitted: FittedFoot, between: Apart) -> AxisFit:
    """The fit with the deviations of what is unsure, but for gains and mounts that other logs and feet tell of."""
    ready, recordings = fitted.ready, fitted.thin.fitted
    shared = ready.settings.offset == "shared"
    blocks = tangent_blocks(recordings, fit, drift=not shared)
    causes = systematic_causes(fit, blocks, recordings, ready.sensor_delay, ready.vertical, shared)
    return inflated(
        fit, causes + robot_causes(fit, blocks, ready.robot.uncertainty.wrench_gain, between, shared)
    )


def assess_foot(fitted: FittedFoot, between: Apart) -> FootFit:
    """Each axis of a fitted foot widened, scored, judged and diagnosed, or why it is given up. between: what all axes
    show recordings to differ by."""
    edges = mostly_on_an_edge(fitted.foot, fitted.ready.robot.feet[fitted.foot], fitted.ready.fitted)
    found = FootFit(notes=(*edges, *fitted.jumps))
    for axis in ROTATIONAL_AXES:
        if axis in fitted.fits and axis not in fitted.given_up:
            with gives_up(axis, fitted.given_up):
                found = _with_axis(found, fitted, fitted.fits[axis], between)
        if axis in fitted.given_up:
            found.parameters.extend(missing_rows(fitted.foot, axis, fitted.given_up[axis]))
        elif axis not in fitted.fits:
            found.parameters.extend(unseen_rows(fitted.foot, axis, fitted.ready.fitted))
    return replace(found, notes=(*found.notes, *internal_errors(fitted.foot, fitted.given_up)))


def _thin(ready: PreparedLogs, foot: str) -> PreparedLogs:
    """The logs with no more samples to fit than the filter has left."""
    return replace(ready, fitted=tuple(recording.decimated(foot) for recording in ready.fitted))


def _with_axis(found: FootFit, fitted: FittedFoot, fit: AxisFit, between: Apart) -> FootFit:
    """What was found, and one axis: its fit widened, scored, judged and diagnosed."""
    ready, thin = fitted.ready, fitted.thin
    shared = ready.settings.offset == "shared"
    blocks = tangent_blocks(thin.fitted, fit, drift=not shared)
    causes = systematic_causes(fit, blocks, thin.fitted, ready.sensor_delay, ready.vertical, shared)
    causes += robot_causes(fit, blocks, ready.robot.uncertainty.wrench_gain, between, shared)
    causes += slip_angle_causes(fit, thin.fitted, shared)
    causes += encoder_delay_causes(fit, blocks, thin.fitted, shared)
    causes += imu_turn_causes(fit, thin.fitted, ready.imu_turn)
    causes += force_gain_causes(fit, ready.gain_errors)
    causes += torque_gain_causes(fit, ready.torque_gains)
    wide = inflated(fit, causes)
    scores, predictions = score_axis(ready.recordings, wide)
    contradicted = contradiction(
        scores, wide, ready.recordings, predictions, ready.robot.uncertainty.imu_mount
    )
    rows = axis_rows(wide, ready.fitted, predictions, contradicted)
    limits = diagnose_axis(fit, wide, causes, rows)
    gain = {foot: error for foot, error in ready.gain_errors.items() if foot == fit.foot}
    play = play_notes(thin.fitted, fit, blocks, shared)
    faults = [
        *data_faults(ready.fitted, fit),
        *fitted.jumps,  # of both axes: an encoder that slips about one tilts the other as well
        *play,
        *force_gain_notes(ready.robot, gain),
        # Torque channels that are wrong about one axis are trusted about neither.
        *(note for note in torque_gain_notes(ready.torque_gains).values() if note.severity == "warning"),
        *naming_notes(ready.robot.path.name, ready.robot.guesses),
        *(note for foot, note in ready.turned.items() if foot == fit.foot),
        *(note for note in ready.notes if note.code in (*OF_MOMENTS, ATTITUDE_SCALE)),
    ]
    # What is left of a foot on its edge is flat, and no number is doubted; what most of it could tell comes first.
    first = [*(note for note in found.notes if note.code == ON_AN_EDGE), *faults]
    return FootFit(
        fits=[*found.fits, wide],
        parameters=[*found.parameters, *mend_first(doubted(advised(rows, limits), faults), first)],
        validation=[*found.validation, *scores],
        diagnosis=[*found.diagnosis, *limits],
        predictions={**found.predictions, **predictions},
        stances=[*found.stances, *stance_stiffness(ready.recordings, wide)],
        walks=[*found.walks, *walk_stiffness(ready.recordings, wide)],
        notes=(*found.notes, *play),
    )


def _fits(
    ready: PreparedLogs,
    foot: str,
    place: PlaceSpread,
    models: Mapping[Axis, BushModel],
    given_up: dict[Axis, str],
) -> dict[Axis, AxisFit]:
    found: dict[Axis, AxisFit] = {}
    timed = not ready.sensor_delay.doubtful
    steps = any(recording.stances[foot] is not None for recording in ready.fitted)
    asked: dict[Axis, PlaceSpread] = dict.fromkeys(ROTATIONAL_AXES, place)
    for _ in range(2):  # about the robot file's place, then about the height that the other axis shows
        left = {axis: own for axis, own in asked.items() if axis not in given_up}
        fits = over_cores(
            lambda axis, own: (
                why := dict[Axis, str](),
                gives_up(axis, why)(
                    lambda: fit_axis(ready.fitted, foot, axis, ready.settings, models.get(axis), own, timed)
                )(),
            ),
            left,
            left.values(),
        )
        for axis, (why, fit) in zip(left, fits, strict=True):
            given_up |= why
            if fit is not None:
                found[axis] = fit
        both = set(ROTATIONAL_AXES) <= set(found) and not steps
        heights = {axis: place.known_from(found, axis) for axis in ROTATIONAL_AXES if both}
        asked = {axis: known for axis, known in heights.items() if known is not None}
    return found


def _outliers(
    ready: PreparedLogs, fits: Mapping[Axis, AxisFit], given_up: dict[Axis, str]
) -> dict[Axis, Mapping[str, Mask]]:
    """Of each axis, the samples (N,) of each recording that leave its model by far."""
    masks: dict[Axis, Mapping[str, Mask]] = {}
    for axis, fit in fits.items():
        with gives_up(axis, given_up):
            masks[axis] = outlier_masks(ready.fitted, fit)
    return masks


def _without(recording: Recording, foot: str, masks: Mapping[Axis, Mapping[str, Mask]]) -> Recording:
    for axis, found in masks.items():
        if recording.name in found:
            recording = recording.without(foot, found[recording.name], Reason.OUTLIER, axis)
    return recording
