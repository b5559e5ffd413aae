"""Measured against reconstructed torque, on the fit's own motions (direct) and on unseen ones (cross)."""

from __future__ import annotations

from typing import Literal, TypedDict

import numpy as np

from plantar.conventions import Array, Axis, Mask
from plantar.results.feet import ValidationRow

FIRST_SECOND = 1.0  # s of an unseen motion that give its offset and are left out of its score


def first_second(time: Array, used: Mask) -> Mask:
    """The first second of the used samples: an unseen motion's offset comes from these alone."""
    if not used.any():
        return np.zeros_like(used)
    return np.asarray(used & (time < time[used][0] + FIRST_SECOND))


class ErrorMeasures(TypedDict):
    """How far a prediction is from the measurement, in its unit; the keys are those of the results' rows."""

    mean_abs_error: float
    rms_error: float
    max_abs: float
    percent_of_max: float | None
    zero_mean_abs: float


def error_measures(measured: Array, predicted: Array, trivial: Array | float) -> ErrorMeasures:
    """Errors of `predicted` against `measured`, of any one shape; `trivial` is the trivial predictor's."""
    error = measured - predicted
    largest, mean_abs = float(np.max(np.abs(measured))), float(np.mean(np.abs(error)))
    return ErrorMeasures(
        mean_abs_error=mean_abs,
        rms_error=float(np.sqrt(np.mean(error**2))),
        max_abs=largest,
        percent_of_max=100 * mean_abs / largest if largest > 0 else None,
        zero_mean_abs=float(np.mean(np.abs(measured - trivial))),
    )


def score(
    kind: Literal["direct", "cross"],
    motion: str,
    foot: str,
    axis: Axis,
    measured: Array,
    predicted: Array,
    trivial: Array,
) -> ValidationRow:
    """Errors of `predicted` (n,) against `measured` (n,) [N·m or N], over samples that the caller chose.

    `trivial` (n,) is what the offset alone gives.
    """
    measures = error_measures(measured, predicted, trivial)
    return ValidationRow(kind=kind, motion=motion, foot=foot, axis=axis, samples=len(measured), **measures)
