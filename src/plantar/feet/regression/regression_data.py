"""Eq. 6 of one axis of one foot, recording by recording: the columns of its model beside the torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.estimation import Block
from plantar.estimation.blocks import StanceRows
from plantar.estimation.errors_in_variables import FEWEST
from plantar.estimation.orthonormal import orthonormal
from plantar.estimation.slow_drift import drift_beside
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AngleDrift, AxisFit
from plantar.feet.regression.load_torque import (
    across_force,
    along_force,
    load_of,
    load_torque,
    step_columns,
    yaw_torque,
)
from plantar.feet.regression.model_columns import (
    UNTURNED,
    Turn,
    model_columns,
    motion_of,
    path_of,
)
from plantar.model_selection.data_sets import DataSet, StepColumns

# Before any data, of where steps find the centre [m], how far the force sensor is turned about the vertical [rad], and
# of its crosstalk [N.m/N]: aside anything (the torque of the load is its own), in height some millimetres of the robot
# file's and of the slide under load, turned or leaning by a degree, as a mount that nobody measured, and crosstalk as
# the robot file has it unless told.
PLACE_SPREAD = np.array([np.inf, 0.006, 0.02, 0.02, 0.004])


def blocks_of(
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    *,
    drift: bool = True,
    fit: AxisFit | None = None,
) -> list[Block]:
    """Eq. 6 for each recording in which the foot has enough used samples, in the columns of a fit's model.

    `drift` adds slow columns to each recording's offset: the IMU's attitude drifts. A model whose shape
    depends on the deflection's zero gets the square of the deflection too, which is what an error of that zero adds to
    a cube. Where the foot steps in any of the recordings, rows have stances, and the torque that grows with the load
    alone, of a bush or a sensor beside its place, is a nuisance of all; of a foot that stands, the torque is without
    what a fit that is given has found of it.
    """
    column = ROTATIONAL_AXES.index(axis)
    steps = any(recording.stances[foot] is not None for recording in recordings)
    blocks = []
    for recording in recordings:
        rows, bush = recording.rows(foot), recording.bushes[foot]
        few = recording.every * recording.used(foot).sum() < FEWEST
        if few or (fit is not None and recording.name not in fit.offsets):
            continue
        regressor = model_columns(recording, foot, axis, fit)[rows]
        noise = np.zeros(regressor.shape[1])
        noise[:2] = recording.noise[foot][:, column]
        blocks.append(
            Block(
                label=recording.name,
                regressor=regressor,
                response=(bush.torque[:, column] - _taken_off(recording, fit))[rows],
                period=recording.period * recording.stride(foot),
                thinned=recording.every * recording.stride(foot),
                nuisance=_nuisance(recording, foot, column, fit) if drift else None,
                noise=noise,
                stances=_stance_rows(recording, foot) if steps else None,
                common_nuisance=_step_columns(recording, foot, axis) if steps else None,
                common_spread=PLACE_SPREAD if steps else None,
            )
        )
    return blocks


def recordings_of(blocks: Sequence[Block], recordings: Sequence[Recording]) -> list[Recording]:
    """The recording that each block is of."""
    by_name = {recording.name: recording for recording in recordings}
    return [by_name[block.label] for block in blocks]


def all_beside(blocks: Sequence[Block], columns: Sequence[Array]) -> list[Block]:
    """The blocks, each `beside` columns of its own."""
    return [beside(block, own) for block, own in zip(blocks, columns, strict=True)]


def beside(block: Block, columns: Array) -> Block:
    """The block with more columns (n, m) in its regressor, without noise."""
    noise = None if block.noise is None else np.append(block.noise, np.zeros(columns.shape[1]))
    return replace(block, regressor=np.column_stack([block.regressor, columns]), noise=noise)


def _taken_off(recording: Recording, fit: AxisFit | None) -> Array | float:
    """The torque (N,) that a fit of a standing foot found not to be the bush's."""
    return 0.0 if fit is None or recording.stances[fit.foot] is not None else load_torque(recording, fit)


def _nuisance(recording: Recording, foot: str, column: int, fit: AxisFit | None) -> Array | None:
    """Orthonormal columns (n, m) of one recording alone; None where a foot steps: its offsets follow any drift."""
    if recording.stances[foot] is not None:
        return None
    deflection = recording.bushes[foot].deflection[recording.rows(foot), column]
    drift = drift_beside(deflection, recording.drift(foot))
    if fit is None or not fit.model.zero_matters:
        return drift
    square = deflection**2
    return np.hstack([drift, orthonormal((square - square.mean())[:, None], drift)])


def _stance_rows(recording: Recording, foot: str) -> StanceRows:
    """The stance and the weight of each used sample; a foot that stands has one stance in all."""
    key = ("stance rows", foot)  # every fit asks
    if key not in recording.kept:
        stances, used = recording.stances[foot], recording.rows(foot)
        number, weight = np.zeros(int(used.sum()), dtype=np.intp), np.ones(int(used.sum()))
        if stances is not None:
            number, weight = stances.number[used], stances.weight[used]
        recording.kept[key] = StanceRows(number, weight)
    return cast(StanceRows, recording.kept[key])


def _step_columns(recording: Recording, foot: str, axis: Axis) -> Array:
    """`step_columns` of the used samples, (n, 5)."""
    key = ("step columns", foot, axis)  # every fit asks
    if key not in recording.kept:
        recording.kept[key] = step_columns(recording, foot, axis, recording.rows(foot))
    return cast(Array, recording.kept[key])


def data_set_of(
    recording: Recording,
    foot: str,
    axis: Axis,
    own_share: float = 0.0,
    above: float = 0.0,
    turned: float = 0.0,
    leans: float = 0.0,
    crosstalk: float = 0.0,
    imu_turned: Turn = UNTURNED,
    drift: AngleDrift | None = None,
) -> DataSet:
    """One recording of one axis, as the models take it.

    `imu_turned`: as in `motion_of`; of a foot that stands: the `drift` of its angle. Of a foot that steps: `own_share`
    of the offsets of stances is their own; the bush's centre is `above` its place in the robot file [m], the force
    sensor `turned` about the vertical, and `leans` about the other axis [rad], with its `crosstalk` [N.m/N].
    """
    column, stances = ROTATIONAL_AXES.index(axis), recording.stances[foot]
    torque, used = recording.bushes[foot].torque[:, column], recording.used(foot)
    if stances is None:
        drifted = None if drift is None else drift.at(recording.time)
        motion = motion_of(recording, foot, axis, imu_turned)
        return DataSet(recording.name, motion, torque, used, drift=drifted)
    steps = StepColumns(stances.number, load_of(recording, foot)[:, None], own_share)
    raw = recording.raw[foot].torque
    measured = raw[:, column] - above * across_force(recording, foot, column) - turned * raw[:, 1 - column]
    measured -= leans * yaw_torque(recording, foot) + crosstalk * along_force(recording, foot, column)
    return DataSet(recording.name, path_of(recording, foot, axis), measured, used, steps)
