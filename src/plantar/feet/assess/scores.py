"""A law against every recording of one axis: direct where the fit has its offset, cross where it has not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.feet.assess.residual_table import Predictions
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.initial_state import unseen_initial_states
from plantar.feet.fit.regression_data import model_columns
from plantar.feet.recording import Recording
from plantar.results.feet import ValidationRow
from plantar.results.scores import first_second, score

FEWEST_SAMPLES = 50  # of one recording, for a score


def score_axis(
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    fit: AxisFit,
    predictions: Predictions,
) -> list[ValidationRow]:
    """Rows of tables 2 and 3 for one axis; what was predicted is added to `predictions`.

    A motion that the fit has not seen takes its offset from its first second; a law with memory also finds its state
    at the motion's start there and as long as that state matters.
    """
    column, rows = ROTATIONAL_AXES.index(axis), []
    for recording in recordings:
        used = recording.used(foot)
        torque = recording.bushes[foot].torque[:, column]
        first = first_second(recording.time, used)
        initial_states = (
            None if recording.role == "fit" else unseen_initial_states(fit, recording, foot, axis, first)
        )
        reconstructed = model_columns(recording, foot, axis, fit, initial_states) @ fit.values
        if recording.role == "fit":
            if recording.name not in fit.offsets:
                continue
            scored, offset, trivial = used, fit.offsets[recording.name], float(np.mean(torque[used]))
        else:
            scored = used & ~first
            if scored.sum() < FEWEST_SAMPLES:
                continue
            offset, trivial = float(np.mean((torque - reconstructed)[first])), float(np.mean(torque[first]))
        predicted = reconstructed + offset
        predictions[recording.name, foot, axis] = predicted
        kind: Literal["direct", "cross"] = "direct" if recording.role == "fit" else "cross"
        rows.append(score(kind, recording.name, foot, axis, torque[scored], predicted[scored], trivial))
    return rows
