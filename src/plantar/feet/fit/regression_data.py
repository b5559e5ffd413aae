"""Eq. 6 of one axis of one foot, recording by recording: the columns of its law beside the torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.estimation import Block
from plantar.feet.fit.axis import AxisFit
from plantar.feet.recording import Recording
from plantar.model_selection.data_sets import DataSet
from plantar.models import BushMotion, KelvinVoigt
from plantar.signals.filters import low_pass

FEWEST_SAMPLES = 50  # of one recording, for it to take part in a fit


def blocks_of(
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    *,
    drift: bool = True,
    fit: AxisFit | None = None,
) -> list[Block]:
    """Eq. 6 for each recording in which the foot has enough samples that serve, in the columns of a fit's law.

    `drift` adds a line in time to each recording's offset: the IMU's attitude drifts slowly. A law whose shape depends
    on the deflection's zero gets the square of the deflection too, which is what an error of that zero adds to a cube.
    """
    column = ROTATIONAL_AXES.index(axis)
    blocks = []
    for recording in recordings:
        used, bush = recording.used(foot), recording.bushes[foot]
        if used.sum() < FEWEST_SAMPLES or (fit is not None and recording.name not in fit.offsets):
            continue
        time = recording.time[used]
        nuisance = (time - time.mean())[:, None] if drift else None
        if nuisance is not None and fit is not None and fit.model.zero_matters:
            square = bush.deflection[used, column] ** 2
            nuisance = np.column_stack([nuisance, square - square.mean()])
        regressor = model_columns(recording, foot, axis, fit)[used]
        noise = np.zeros(regressor.shape[1])
        noise[:2] = recording.noise[foot][:, column]
        torque = bush.torque[used, column]
        blocks.append(Block(recording.name, regressor, torque, recording.period, nuisance, noise))
    return blocks


def model_columns(
    recording: Recording, foot: str, axis: Axis, fit: AxisFit | None, initial_states: Array | None = None
) -> Array:
    """Regressor (N, k) of a fit's law along a recording, Kelvin-Voigt's without one; NaN in the air."""
    motion = motion_of(recording, foot, axis)
    if fit is None or isinstance(fit.model, KelvinVoigt):
        return np.column_stack([motion.deflection, motion.rate])
    initial_states = fit.initial_states.get(recording.name) if initial_states is None else initial_states
    if initial_states is None or len(initial_states) != len(motion.runs):
        initial_states = fit.model.initial_states(motion, fit.shape)
    columns = fit.model.columns(motion, fit.shape, initial_states)
    columns[:, 2:] = low_pass(columns[:, 2:], recording.period, recording.cutoff)
    return columns


def motion_of(recording: Recording, foot: str, axis: Axis) -> BushMotion:
    """Deflection and rate of one axis, NaN where the foot does not stand: a bush in the air forgets."""
    column, bush = ROTATIONAL_AXES.index(axis), recording.bushes[foot]
    away = ~recording.contacts[foot].loaded
    deflection, rate = bush.deflection[:, column].copy(), bush.rate[:, column].copy()
    deflection[away] = rate[away] = np.nan
    return BushMotion(deflection, rate, recording.period)


def data_set_of(recording: Recording, foot: str, axis: Axis) -> DataSet:
    """One recording of one axis, as the laws take it."""
    torque = recording.bushes[foot].torque[:, ROTATIONAL_AXES.index(axis)]
    return DataSet(recording.name, motion_of(recording, foot, axis), torque, recording.used(foot))
