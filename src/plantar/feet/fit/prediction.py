"""What a fitted model says of a recording's torque, and the offsets that go with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import ROTATIONAL_AXES, Array, Mask
from plantar.feet.fit.axis import FittedModel
from plantar.feet.fit.initial_state import unseen_initial_states
from plantar.feet.fit.regression_data import model_columns, moment_columns
from plantar.feet.recording import Recording
from plantar.results.scores import first_second


@dataclass(frozen=True)
class Prediction:
    """The torque (N,) that a model predicts, that of its offset alone (`trivial`, (N,)), and the samples to score."""

    torque: Array
    trivial: Array
    scored: Mask


def predict(recording: Recording, fitted: FittedModel) -> Prediction | None:
    """One axis of a recording; None where the recording has no sample to find its offset from.

    A motion that the fit has not seen takes its offset from its first second, which is not scored; a model with memory
    also finds its state there. Where the foot steps, each stance has the offset that fits it best, of a seen and of an
    unseen walk alike, and the trivial predictor has the same.
    """
    foot, column = fitted.foot, ROTATIONAL_AXES.index(fitted.axis)
    used, torque = recording.used(foot), recording.bushes[foot].torque[:, column]
    if recording.role == "fit" and recording.name not in fitted.offsets:
        return None
    stances = recording.stances[foot]
    if stances is not None:
        model = reconstructed(recording, fitted)
        offset = _by_stance(torque - model, used, stances.number)
        return Prediction(model + offset, _by_stance(torque, used, stances.number), used)
    if recording.role == "fit":
        seen = reconstructed(recording, fitted) + fitted.offsets[recording.name]
        return Prediction(seen, np.full(len(torque), np.mean(torque[used])), used)
    first = first_second(recording.time, used)
    if not (used & ~first).any():
        return None
    states = unseen_initial_states(fitted, recording, first)
    model = reconstructed(recording, fitted, states)
    unseen = model + float(np.mean((torque - model)[first]))
    return Prediction(unseen, np.full(len(torque), np.mean(torque[first])), used & ~first)


def reconstructed(recording: Recording, fitted: FittedModel, states: Array | None = None) -> Array:
    """The torque (N,) of the bush and of the load, without an offset; `states` (runs,) as in `model_columns`."""
    torque = model_columns(recording, fitted.foot, fitted.axis, fitted, states) @ fitted.values
    if not any(fitted.moment_arms):
        return np.asarray(torque)
    arms = np.array(fitted.moment_arms)
    return np.asarray(torque + moment_columns(recording, fitted.foot, fitted.axis) @ arms)


def _by_stance(values: Array, used: Mask, number: NDArray[np.intp]) -> Array:
    """The mean of values (N,) over the used samples of each stance, at its samples; NaN elsewhere."""
    means = np.full(len(values), np.nan)
    for stance in np.unique(number[used]):
        own = number == stance
        means[own] = np.mean(values[own & used])
    return means
