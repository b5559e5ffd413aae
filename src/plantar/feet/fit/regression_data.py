"""Eq. 6 of one axis of one foot, recording by recording: the columns of its law beside the torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.estimation import Block
from plantar.estimation.blocks import StanceRows
from plantar.feet.fit.axis import AxisFit, FittedModel
from plantar.feet.recording import SHORTEST_STANCE_RUN, Recording, within_stances
from plantar.model_selection.data_sets import DataSet, StepColumns
from plantar.models import BushMotion, KelvinVoigt
from plantar.signals.filters import SHORTEST_RUN, low_pass

PATH_BAND = 4.0  # times the fit's cutoff, of the path that a memory follows through short stances
# m, before any data, of the centre's place: aside anything (the torque of the load is its own), in height some
# millimetres of the robot file's and of the slide under load.
MOMENT_SPREAD = np.array([np.inf, 0.006])
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
    Where the foot steps in any of the recordings, rows have stances, and the torque that grows with the load alone, of
    a bush or a sensor beside its place, is a nuisance of all.
    """
    column = ROTATIONAL_AXES.index(axis)
    steps = any(recording.stances[foot] is not None for recording in recordings)
    blocks = []
    for recording in recordings:
        used, bush = recording.used(foot), recording.bushes[foot]
        if used.sum() < FEWEST_SAMPLES or (fit is not None and recording.name not in fit.offsets):
            continue
        regressor = model_columns(recording, foot, axis, fit)[used]
        noise = np.zeros(regressor.shape[1])
        noise[:2] = recording.noise[foot][:, column]
        blocks.append(
            Block(
                label=recording.name,
                regressor=regressor,
                response=bush.torque[used, column],
                period=recording.period,
                nuisance=_nuisance(recording, foot, column, fit) if drift else None,
                noise=noise,
                stances=_stance_rows(recording, foot) if steps else None,
                common_nuisance=moment_columns(recording, foot, axis)[used] if steps else None,
                common_spread=MOMENT_SPREAD if steps else None,
            )
        )
    return blocks


def _nuisance(recording: Recording, foot: str, column: int, fit: AxisFit | None) -> Array | None:
    """Columns (n, m) of one recording alone; None where a foot steps: the offsets of its stances follow any drift."""
    if recording.stances[foot] is not None:
        return None
    used = recording.used(foot)
    time = recording.time[used]
    line = (time - time.mean())[:, None]
    if fit is None or not fit.model.zero_matters:
        return np.asarray(line)
    square = recording.bushes[foot].deflection[used, column] ** 2
    return np.column_stack([line, square - square.mean()])


def _stance_rows(recording: Recording, foot: str) -> StanceRows:
    """The stance and the weight of each used sample; a foot that stands has one stance in all."""
    stances, used = recording.stances[foot], recording.used(foot)
    if stances is None:
        return StanceRows(np.zeros(int(used.sum()), dtype=np.intp), np.ones(int(used.sum())))
    return StanceRows(stances.number[used], stances.weight[used])


def load_of(recording: Recording, foot: str) -> Array:
    """The vertical force through the fit's filter, (N,) [N], 0 where it is not known: where nothing is used."""
    return _filtered_as_torque(recording, foot, recording.bushes[foot].force_z)


def _filtered_as_torque(recording: Recording, foot: str, values: Array) -> Array:
    """Values (N,) through the filter that the torque went through, 0 where they are not known."""
    smooth = within_stances(values[:, None], recording.period, recording.cutoff, recording.stances[foot])
    return np.nan_to_num(smooth[:, 0])


def moment_columns(recording: Recording, foot: str, axis: Axis) -> Array:
    """Torque (N, 2) for each metre by which the bush's centre is beside and above its place in the robot file.

    A centre that is dz higher takes dz·F_x off the pitch torque and adds dz·F_y to the roll torque; the compressed z
    slide is such a height. One that is aside adds a torque as large as the load.
    """
    column = ROTATIONAL_AXES.index(axis)
    across = _across(recording, foot, column)
    return np.column_stack([load_of(recording, foot), _filtered_as_torque(recording, foot, across)])


def place_columns(recording: Recording, foot: str, axis: Axis, stiffness: float) -> Array:
    """Torque (N, 6) for each metre or radian by which bush, force sensor and IMU are not where the robot file says.

    `moment_columns`; the other axis' torque, which shows in this one where a force sensor is turned about the vertical;
    and what a turn of the IMU about each of its axes adds to the angle, taken by a spring of this stiffness [N·m/rad].
    """
    column = ROTATIONAL_AXES.index(axis)
    other = np.nan_to_num(recording.bushes[foot].torque[:, 1 - column])
    turns = recording.imu_turns.get(foot, np.zeros((len(recording.time), 2, 3)))[:, column]
    angles = [_filtered_as_torque(recording, foot, turn) for turn in turns.T]
    return np.column_stack(
        [moment_columns(recording, foot, axis), other, *(stiffness * angle for angle in angles)]
    )


def load_torque(recording: Recording, fitted: FittedModel) -> Array:
    """The torque (N,) that is not the bush's: of the load on a centre beside its place, of sensors that are turned."""
    place = np.array([*fitted.moment_arms, fitted.turned, *fitted.imu_turned])
    if not place.any():
        return np.zeros(len(recording.time))
    stiffness = float(fitted.values[0])
    return np.asarray(place_columns(recording, fitted.foot, fitted.axis, stiffness) @ place)


def _across(recording: Recording, foot: str, column: int) -> Array:
    """The horizontal force that a higher centre turns into torque, (N,) [N], unfiltered."""
    return np.asarray((1.0, -1.0)[column] * recording.bushes[foot].wrench[:, column])


def model_columns(
    recording: Recording, foot: str, axis: Axis, fit: FittedModel | None, initial_states: Array | None = None
) -> Array:
    """Regressor (N, k) of a fit's law along a recording, Kelvin-Voigt's without one; NaN in the air."""
    motion = motion_of(recording, foot, axis)
    linear = np.column_stack([motion.deflection, motion.rate])
    if fit is None or isinstance(fit.model, KelvinVoigt):
        return linear
    path = path_of(recording, foot, axis)
    initial_states = fit.initial_states.get(recording.name) if initial_states is None else initial_states
    if initial_states is None or len(initial_states) != len(path.runs):
        initial_states = fit.model.initial_states(path, fit.shape)
    columns = fit.model.columns(path, fit.shape, initial_states)
    columns[:, :2] = linear
    shortest = _shortest_run(recording, foot)
    columns[:, 2:] = low_pass(columns[:, 2:], recording.period, recording.cutoff, shortest)
    return columns


def _shortest_run(recording: Recording, foot: str) -> int:
    """Samples that the fit's filter needs in one run."""
    return SHORTEST_RUN if recording.stances[foot] is None else SHORTEST_STANCE_RUN


def motion_of(recording: Recording, foot: str, axis: Axis) -> BushMotion:
    """Deflection and rate of one axis, NaN where the foot does not stand: a bush in the air forgets."""
    column, bush = ROTATIONAL_AXES.index(axis), recording.bushes[foot]
    stances = recording.stances[foot]
    away = ~recording.contacts[foot].loaded if stances is None else stances.number < 0
    deflection, rate = bush.deflection[:, column].copy(), bush.rate[:, column].copy()
    deflection[away] = rate[away] = np.nan
    return BushMotion(deflection, rate, recording.period)


def path_of(recording: Recording, foot: str, axis: Axis) -> BushMotion:
    """The motion that a model's memory follows: of a foot that steps with a wider band, since it turns quickly."""
    slow, stances = motion_of(recording, foot, axis), recording.stances[foot]
    if stances is None:
        return slow
    column, raw = ROTATIONAL_AXES.index(axis), recording.raw[foot]
    both = np.column_stack([raw.deflection[:, column], raw.rate[:, column]])
    both[stances.number < 0] = np.nan
    quick = low_pass(both, recording.period, PATH_BAND * recording.cutoff, SHORTEST_STANCE_RUN)
    quick[~np.isfinite(slow.deflection)] = np.nan
    return BushMotion(quick[:, 0], quick[:, 1], recording.period)


def data_set_of(
    recording: Recording, foot: str, axis: Axis, own_share: float = 0.0, above: float = 0.0
) -> DataSet:
    """One recording of one axis, as the models take it.

    Of a foot that steps: `own_share` of the offsets of stances is their own; the bush's centre is `above` its place in
    the robot file [m].
    """
    column, stances = ROTATIONAL_AXES.index(axis), recording.stances[foot]
    torque, used = recording.bushes[foot].torque[:, column], recording.used(foot)
    if stances is None:
        return DataSet(recording.name, motion_of(recording, foot, axis), torque, used)
    steps = StepColumns(stances.number, load_of(recording, foot)[:, None], own_share)
    measured = recording.raw[foot].torque[:, column] - above * _across(recording, foot, column)
    return DataSet(recording.name, path_of(recording, foot, axis), measured, used, steps)
