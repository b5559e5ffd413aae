"""One foot: both axes fitted, widened by what no residual shows, scored, judged and diagnosed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from plantar.conventions import ROTATIONAL_AXES
from plantar.feet.assess.diagnosis import advised, diagnose_axis
from plantar.feet.assess.parameter_rows import axis_rows, missing_rows
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.assess.scores import score_axis
from plantar.feet.exclusion.outliers import fit_without_outliers
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.systematic import inflated, systematic_causes
from plantar.feet.prepare import PreparedLogs
from plantar.feet.settings import FeetSettings
from plantar.results.feet import Parameter, ValidationRow


@dataclass(frozen=True)
class FootFit:
    """What a result holds of one foot: of each axis that could be fitted, and rows that say why one could not."""

    fits: list[AxisFit] = field(default_factory=list)
    parameters: list[Parameter] = field(default_factory=list)
    validation: list[ValidationRow] = field(default_factory=list)
    diagnosis: list[dict[str, Any]] = field(default_factory=list)
    predictions: Predictions = field(default_factory=dict)


def fit_foot(
    ready: PreparedLogs, foot: str, settings: FeetSettings, progress: Callable[[str], None]
) -> FootFit:
    """Pitch, then roll. Samples of this foot that leave a law by far are left out of its contacts."""
    found, shared = FootFit(), settings.offset == "shared"
    for axis in ROTATIONAL_AXES:
        progress(f"fit {foot} {axis}")
        fit = fit_without_outliers(
            ready.fitted, foot, axis, partial(fit_axis, ready.fitted, foot, axis, settings)
        )
        if fit is None:
            found.parameters.extend(missing_rows(foot, axis))
            continue
        causes = systematic_causes(fit, ready.fitted, ready.sensor_delay, ready.vertical, shared)
        wide = inflated(fit, causes)
        found.fits.append(wide)
        scores = score_axis(ready.recordings, foot, axis, wide, found.predictions)
        found.validation.extend(scores)
        rows = axis_rows(wide, ready.fitted, found.predictions, scores)
        limits = diagnose_axis(fit, wide, causes, rows)
        found.diagnosis.extend(limits)
        found.parameters.extend(advised(rows, limits))
    return found
