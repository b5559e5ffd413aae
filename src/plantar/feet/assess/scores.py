"""A model against every recording of one axis: direct where the fit has its offset, cross where it has not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from plantar.conventions import ROTATIONAL_AXES
from plantar.estimation.errors_in_variables import FEWEST
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.regression.prediction import predict
from plantar.results.feet import ValidationRow
from plantar.results.scores import score


def score_axis(
    recordings: Sequence[Recording], fitted: FittedModel
) -> tuple[list[ValidationRow], Predictions]:
    """Rows of tables 2 and 3 for one axis, and the torques predicted."""
    foot, axis = fitted.foot, fitted.axis
    rows, predictions = [], Predictions()
    for recording in recordings:
        prediction = predict(recording, fitted)
        if prediction is None or prediction.scored.sum() < FEWEST:
            continue
        predictions[recording.name, foot, axis] = prediction
        scored = prediction.scored
        measured = recording.bushes[foot].torque[scored, ROTATIONAL_AXES.index(axis)]
        kind: Literal["direct", "cross"] = "direct" if recording.role == "fit" else "cross"
        predicted, trivial = prediction.torque[scored], prediction.trivial[scored]
        rows.append(score(kind, recording.name, foot, axis, measured, predicted, trivial))
    return rows, predictions
