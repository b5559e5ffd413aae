"""One foot: both axes fitted, widened by what no residual shows, scored, judged and diagnosed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from plantar.contact.reasons import Reason
from plantar.conventions import ROTATIONAL_AXES, Axis, Mask
from plantar.feet.assess.diagnosis import advised, diagnose_axis
from plantar.feet.assess.parameter_rows import axis_rows, missing_rows
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.assess.scores import score_axis
from plantar.feet.exclusion.outliers import outlier_masks
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.systematic import inflated, systematic_causes
from plantar.feet.prepare import PreparedLogs
from plantar.feet.recording import Recording
from plantar.models import BushModel
from plantar.results.feet import Parameter, ValidationRow

ROUNDS = 3  # of leaving outliers out: a large one hides smaller ones


@dataclass(frozen=True)
class FootFit:
    """What a result holds of one foot: of each axis that could be fitted, and rows that say why one could not."""

    fits: list[AxisFit] = field(default_factory=list)
    parameters: list[Parameter] = field(default_factory=list)
    validation: list[ValidationRow] = field(default_factory=list)
    diagnosis: list[dict[str, Any]] = field(default_factory=list)
    predictions: Predictions = field(default_factory=dict)


def fit_foot(ready: PreparedLogs, foot: str, progress: Callable[[str], None]) -> tuple[FootFit, PreparedLogs]:
    """Pitch and roll of one foot, and the logs without the samples that leave either model by far.

    What is left out is decided for both axes before either is scored.
    """
    progress(f"fit {foot}")
    fits, ready = _fits_without_outliers(ready, foot)
    found, shared = FootFit(), ready.settings.offset == "shared"
    for axis in ROTATIONAL_AXES:
        fit = fits.get(axis)
        if fit is None:
            found.parameters.extend(missing_rows(foot, axis))
            continue
        causes = systematic_causes(fit, ready.fitted, ready.sensor_delay, ready.vertical, shared)
        wide = inflated(fit, causes)
        scores, predictions = score_axis(ready.recordings, wide)
        rows = axis_rows(wide, ready.fitted, predictions, scores)
        limits = diagnose_axis(fit, wide, causes, rows)
        found.fits.append(wide)
        found.predictions.update(predictions)
        found.validation.extend(scores)
        found.diagnosis.extend(limits)
        found.parameters.extend(advised(rows, limits))
    return found, ready


def _fits_without_outliers(ready: PreparedLogs, foot: str) -> tuple[dict[Axis, AxisFit], PreparedLogs]:
    """The fit of each axis that has samples. Clean recordings are fitted once; others again without what leaves a model
    by far, under the models first chosen, and at last with the choice made anew."""
    fits, several = _fits(ready, foot, {}), False
    for _ in range(ROUNDS):
        masks = {axis: outlier_masks(ready.fitted, fit) for axis, fit in fits.items()}
        if not any(masks.values()):
            break
        several = True
        ready = replace(ready, fitted=tuple(_without(one, foot, masks) for one in ready.fitted))
        fits = _fits(ready, foot, {axis: fit.model for axis, fit in fits.items()})
    return (_fits(ready, foot, {}) if several else fits), ready


def _fits(ready: PreparedLogs, foot: str, models: Mapping[Axis, BushModel]) -> dict[Axis, AxisFit]:
    found = {
        axis: fit_axis(ready.fitted, foot, axis, ready.settings, models.get(axis)) for axis in ROTATIONAL_AXES
    }
    return {axis: fit for axis, fit in found.items() if fit is not None}


def _without(recording: Recording, foot: str, masks: Mapping[Axis, Mapping[str, Mask]]) -> Recording:
    for axis, found in masks.items():
        if recording.name in found:
            recording = recording.without(foot, found[recording.name], Reason.OUTLIER, axis)
    return recording
