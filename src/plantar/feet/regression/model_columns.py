"""The columns of a fit's model along a recording, and the motions of the foot that they follow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis, Mask
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import FittedModel
from plantar.model_selection.data_sets import PATH_BAND
from plantar.models import BESIDE, BushMotion, KelvinVoigt
from plantar.signals.filters import SHORTEST_FITTED_RUN, differentiate, low_pass

Turn = tuple[float, float, float]
UNTURNED: Turn = (0.0, 0.0, 0.0)


def model_columns(
    recording: Recording, foot: str, axis: Axis, fit: FittedModel | None, initial_states: Array | None = None
) -> Array:
    """Regressor (N, k) of a fit's model along a recording, Kelvin-Voigt's without one; NaN in the air."""
    motion = motion_of(recording, foot, axis, UNTURNED if fit is None else fit.imu_turned)
    linear = [motion.deflection, motion.rate]
    if fit is None or isinstance(fit.model, KelvinVoigt):
        return np.column_stack(linear)
    path = memory_path(recording, fit)
    own = _own_columns(recording, fit, [path], fit.shape[None, :], initial_states)
    return np.column_stack([*linear, own[:, :, 0]])


def own_torque(recording: Recording, fit: FittedModel, paths: Sequence[BushMotion], shapes: Array) -> Array:
    """What a model's own columns add to spring and damper, (N, p·b), along p paths for b `shapes` (b, s) each."""
    own = _own_columns(recording, fit, paths, shapes)
    return np.asarray(np.einsum("neb,e->nb", own, fit.values[len(BESIDE) :]))


def _own_columns(
    recording: Recording,
    fit: FittedModel,
    paths: Sequence[BushMotion],
    shapes: Array,
    initial_states: Array | None = None,
) -> Array:
    """A model's columns beside the linear two, through the fit's filter, (N, e, p·b): see `own_torque`."""
    if initial_states is None:
        initial_states = fit.initial_states.get(recording.name)
    each = []
    for path in paths:
        known = initial_states is not None and len(initial_states) == len(path.runs)
        starts = [initial_states if known else fit.model.initial_states(path, shape) for shape in shapes]
        each.append(fit.model.basis_columns(path, shapes, np.array(starts)))
    columns = np.concatenate(each, axis=2)
    columns[~np.isfinite(paths[0].deflection + paths[0].rate)] = np.nan
    return low_pass(columns, recording.period, recording.cutoff, SHORTEST_FITTED_RUN)


def memory_path(recording: Recording, fit: FittedModel) -> BushMotion:
    """The path that a fit's memory follows."""
    path = path_of(recording, fit.foot, fit.axis, fit.imu_turned)
    if (drift := fit.drifts.get(recording.name)) is None:
        return path
    return replace(path, deflection=path.deflection - drift.at(recording.time))


def motion_of(recording: Recording, foot: str, axis: Axis, imu_turned: Turn) -> BushMotion:
    """Deflection and rate of one axis, NaN where the foot does not stand: a bush in the air forgets.

    imu_turned: about each of the IMU's axes, by how much it is turned beside the robot file's mount [rad]: angles
    and rates are put right.
    """
    key = ("motion", foot, axis, imu_turned)
    if key not in recording.kept:
        column, bush = ROTATIONAL_AXES.index(axis), recording.bushes[foot]
        stances = recording.stances[foot]
        away = ~recording.contacts[foot].loaded if stances is None else stances.number < 0
        read = np.column_stack([bush.deflection[:, column], bush.rate[:, column]])
        recording.kept[key] = _turned(recording, foot, axis, imu_turned, read, away)
    return cast(BushMotion, recording.kept[key])


def turn_effects(recording: Recording, foot: str, axis: Axis) -> Array:
    """What each radian of a turn of the IMU about its axes adds to a foot's angle and rate, (N, 2, 3)."""
    key = ("turn", foot, axis)
    if key not in recording.kept:
        angles = recording.imu_turns[foot][:, ROTATIONAL_AXES.index(axis)]
        rates = np.nan_to_num(differentiate(angles, recording.period))
        recording.kept[key] = np.stack([angles, rates], axis=1)
    return cast(Array, recording.kept[key])


def path_of(recording: Recording, foot: str, axis: Axis, imu_turned: Turn = UNTURNED) -> BushMotion:
    """The motion that a model's memory follows: of a foot that steps with a wider band, since it turns quickly."""
    slow, stances = motion_of(recording, foot, axis, imu_turned), recording.stances[foot]
    if stances is None:
        return slow
    key = ("path", foot, axis, imu_turned)
    if key not in recording.kept:
        column, raw = ROTATIONAL_AXES.index(axis), recording.raw[foot]
        both = np.column_stack([raw.deflection[:, column], raw.rate[:, column]])
        both[stances.number < 0] = np.nan
        quick = low_pass(both, recording.period, PATH_BAND * recording.cutoff, SHORTEST_FITTED_RUN)
        away = ~np.isfinite(slow.deflection)
        recording.kept[key] = _turned(recording, foot, axis, imu_turned, quick, away)
    return cast(BushMotion, recording.kept[key])


def _turned(
    recording: Recording, foot: str, axis: Axis, imu_turned: Turn, read: Array, away: Mask
) -> BushMotion:
    """Angle and rate (N, 2) as read, put right for a turn of the IMU; NaN where the foot is `away` (N,)."""
    if any(imu_turned):
        read = read + turn_effects(recording, foot, axis) @ np.array(imu_turned)
    read[away] = np.nan
    angle, rate = np.ascontiguousarray(read.T)
    return BushMotion(angle, rate, recording.period)
