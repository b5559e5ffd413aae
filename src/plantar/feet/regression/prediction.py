"""What a fitted model says of a recording's torque, and the offsets that go with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import ROTATIONAL_AXES, Array, Mask
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.regression.load_torque import load_torque
from plantar.feet.regression.model_columns import model_columns, motion_of
from plantar.model_selection.initial_state import initial_states_of
from plantar.results.scores import first_second


@dataclass(frozen=True)
class Prediction:
    """The torque (N,) that a model predicts, of it that of the `bush` (N,) without offset and load, that of the offset
    alone (`trivial`, (N,)), and the samples to score."""

    torque: Array
    bush: Array
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
        bush = bush_torque(recording, fitted)
        model = bush + load_torque(recording, fitted)
        offset = _by_stance(torque - model, used, stances.number)
        return Prediction(model + offset, bush, _by_stance(torque, used, stances.number), used)
    if recording.role == "fit":
        bush = bush_torque(recording, fitted)
        seen = bush + load_torque(recording, fitted) + fitted.offsets[recording.name]
        return Prediction(seen, bush, np.full(len(torque), np.mean(torque[used])), used)
    first = first_second(recording.time, used)
    if not (used & ~first).any():
        return None
    states = unseen_initial_states(fitted, recording, first)
    bush = bush_torque(recording, fitted, states)
    model = bush + load_torque(recording, fitted)
    unseen = model + float(np.mean((torque - model)[first]))
    return Prediction(unseen, bush, np.full(len(torque), np.mean(torque[first])), used & ~first)


def bush_torque(recording: Recording, fitted: FittedModel, states: Array | None = None) -> Array:
    """The torque (N,) of the bush alone; `states` (runs,) as in `model_columns`."""
    return np.asarray(model_columns(recording, fitted.foot, fitted.axis, fitted, states) @ fitted.values)


def _by_stance(values: Array, used: Mask, number: NDArray[np.intp]) -> Array:
    """The mean of values (N,) over the used samples of each stance, at its samples; NaN elsewhere."""
    stances = int(number.max(initial=-1)) + 2  # the last, -1: in the air
    count = np.bincount(number[used], minlength=stances)
    sums = np.bincount(number[used], values[used], stances)
    return np.asarray((sums / np.where(count > 0, count, np.nan))[number])


def unseen_initial_states(fitted: FittedModel, recording: Recording, first: Mask) -> Array | None:
    """The state (runs,) at the start of each run of an unseen recording; None for models without memory.

    first: (N,), the samples that show the recording's offset.
    """
    foot, axis = fitted.foot, fitted.axis
    motion = motion_of(recording, foot, axis, fitted.imu_turned)
    if not fitted.model.remembers or not motion.runs or not first.any():
        return None
    measured = recording.bushes[foot].torque[:, ROTATIONAL_AXES.index(axis)]
    torque = measured - load_torque(recording, fitted)
    used = recording.used(foot)
    return initial_states_of(
        fitted.model, fitted.values, fitted.shape, motion, torque, used, first, recording.cutoff
    )
