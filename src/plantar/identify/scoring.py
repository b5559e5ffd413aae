"""A law against every recording of one axis: direct where the fit has its offset, cross where it has not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.identify.recording import Recording
from plantar.identify.residual_table import Predictions
from plantar.models import KelvinVoigt
from plantar.result import ValidationRow
from plantar.validation import opening, score

FEWEST_SAMPLES = 50  # of one recording, for a score


def score_axis(
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    law: KelvinVoigt,
    values: Array,
    offsets: Mapping[str, float],
    predictions: Predictions,
) -> list[ValidationRow]:
    """Rows of tables 2 and 3 for one axis; what was predicted is added to `predictions`.

    `offsets` are the fit's own, by motion; a motion to validate takes its offset from its first second.
    """
    column, rows = ROTATIONAL_AXES.index(axis), []
    for recording in recordings:
        used, bush = recording.used(foot), recording.bushes[foot]
        torque = bush.torque[:, column]
        reconstructed = law.regressor(bush.deflection[:, column], bush.rate[:, column]) @ values
        if recording.role == "fit":
            if recording.name not in offsets:
                continue
            scored, offset, trivial = used, offsets[recording.name], float(np.mean(torque[used]))
        else:
            first = opening(recording.time, used)
            scored = used & ~first
            if scored.sum() < FEWEST_SAMPLES:
                continue
            offset, trivial = float(np.mean((torque - reconstructed)[first])), float(np.mean(torque[first]))
        predicted = reconstructed + offset
        predictions[recording.name, foot, axis] = predicted
        kind: Literal["direct", "cross"] = "direct" if recording.role == "fit" else "cross"
        rows.append(score(kind, recording.name, foot, axis, torque[scored], predicted[scored], trivial))
    return rows
