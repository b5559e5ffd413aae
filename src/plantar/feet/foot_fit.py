"""One foot: both axes fitted, without outliers, and with no richer model of the bush than the logs ask for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from plantar.contact.reasons import Reason
from plantar.conventions import ROTATIONAL_AXES, Axis, Mask
from plantar.cores import over_cores
from plantar.feet.assess.zero_jumps import zero_jumps
from plantar.feet.exclusion.outliers import outlier_masks
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.worth import hardly_matters, in_place_of, tells_no_more, too_sure
from plantar.feet.internal_error import gives_up
from plantar.feet.interval_width.between_recordings import (
    Apart,
    AxisDifferences,
    axis_differences,
    recordings_apart,
)
from plantar.feet.interval_width.cause import inflated
from plantar.feet.interval_width.systematic import robot_causes, systematic_causes
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.place.told_exact import as_measured, shown_elsewhere
from plantar.feet.place.turned_bush import turned_bush_note
from plantar.feet.prepare import PreparedLogs
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.models import MODELS, KelvinVoigt
from plantar.notes import Note

ROUNDS = 3  # of leaving outliers out: a large one hides smaller ones


@dataclass(frozen=True)
class FittedFoot:
    """Both axes of one foot as fitted about its `place`: `fits` by axis, `given_up` with the reasons; the logs without
    outliers, `ready`, and `thin`, with no more samples than the fit needs; warnings of `jumps` of a zero, and that the
    place is `elsewhere` though the robot file calls it exact."""

    foot: str
    place: PlaceSpread
    fits: Mapping[Axis, AxisFit]
    given_up: dict[Axis, str]
    ready: PreparedLogs
    thin: PreparedLogs
    jumps: Sequence[Note]
    elsewhere: Note | None

    def told(self, note: Note) -> FittedFoot:
        """The foot with a note more on each axis."""
        return replace(
            self, fits={axis: replace(fit, notes=(*fit.notes, note)) for axis, fit in self.fits.items()}
        )


def fit_foot(ready: PreparedLogs, foot: str, place: PlaceSpread) -> FittedFoot:
    """Pitch and roll of one foot, and the logs without the samples that leave either model by far.

    What is left out is decided for both axes before either is scored. Clean recordings are fitted once; others again
    without their outliers, with the choice of models made anew.
    """
    given_up: dict[Axis, str] = {}
    thin = _thin(ready, foot)
    fits = _fits(thin, foot, place, {}, given_up)
    for _ in range(ROUNDS):
        masks = _outliers(ready, fits, given_up)
        if not any(masks.values()):
            break
        ready = replace(ready, fitted=tuple(_without(one, foot, masks) for one in ready.fitted))
        thin = _thin(ready, foot)
        fits = _fits(thin, foot, place, fits, given_up)
    shared = ready.settings.shared
    with gives_up("pitch", given_up):
        if (turned := turned_bush_note(fits, thin.fitted, shared)) is not None:
            fits = {axis: replace(fit, notes=(*fit.notes, turned)) for axis, fit in fits.items()}
    fits = {axis: fit for axis, fit in fits.items() if axis not in given_up}
    jumps: list[Note] = []
    for axis, fit in fits.items():
        with gives_up(axis, given_up):
            jumps.extend(zero_jumps(thin.fitted, fit, shared))
    elsewhere = None
    with gives_up("pitch", given_up):
        usual = as_measured(ready.robot, foot)
        elsewhere = shown_elsewhere([*fits.values()], thin.fitted, place, usual, shared)
    return FittedFoot(foot, place, fits, given_up, ready, thin, jumps, elsewhere)


def between_all(feet: Sequence[FittedFoot]) -> Apart:
    """By how much recordings differ as the axes of all feet show it together, whichever one is left out; at least what
    the robot file allows."""
    told = list[AxisDifferences]()
    for one in feet:
        for axis, fit in one.fits.items():
            with gives_up(axis, one.given_up):
                own = axis_differences(Tangent.of(fit, one.thin.fitted, one.ready.settings.shared))
                told += [] if own is None else [own]
    unsure = [one.ready.robot.uncertainty for one in feet]
    prior, exact = max(each.between_recordings for each in unsure), all(each.exact for each in unsure)
    apart = recordings_apart(told, prior, exact=exact)
    # What warms up is the rubber of all axes. One axis that differs alone has that in its own interval.
    rests = ([*told[:place], *told[place + 1 :]] for place in range(len(told)))
    others = [recordings_apart(each, prior, exact=exact) for each in rests]
    least = min((each.share for each in others), default=prior)
    return apart._replace(share=least, shown=apart.shown if all(each.shown for each in others) else None)


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
    ready = fitted.ready
    tangent = Tangent.of(fit, fitted.thin.fitted, ready.settings.shared)
    causes = systematic_causes(tangent, ready.sensor_delay, ready.vertical)
    return inflated(fit, causes + robot_causes(tangent, ready.robot.uncertainty.wrench_gain, between))


def _thin(ready: PreparedLogs, foot: str) -> PreparedLogs:
    """The logs with no more samples to fit than the filter has left."""
    return replace(ready, fitted=tuple(recording.decimated(foot) for recording in ready.fitted))


def _fits(
    ready: PreparedLogs,
    foot: str,
    place: PlaceSpread,
    before: Mapping[Axis, AxisFit],
    given_up: dict[Axis, str],
) -> dict[Axis, AxisFit]:
    """Both axes' fits, from where those `before` came to rest."""
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
                    lambda: fit_axis(
                        ready.fitted,
                        foot,
                        axis,
                        ready.settings,
                        None,
                        own,
                        timed,
                        found.get(axis, before.get(axis)),
                    )
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
