"""Stiffness stance by stance and walk by walk: do single steps and single recordings say what all say together?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.contact.stances import FEWEST_STANCES
from plantar.conventions import Array
from plantar.estimation import Block, fit_blocks, interval95
from plantar.estimation.errors_in_variables import attenuation
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import blocks_of, recordings_of
from plantar.results.walk_rows import StanceStiffness, WalkStiffness
from plantar.signals.filters import SHORTEST_FITTED_RUN


def stance_stiffness(recordings: Sequence[Recording], fit: AxisFit) -> list[StanceStiffness]:
    """Of every stance with enough samples, of fitted and unseen recordings; none where the foot does not step.

    A stance alone is too short to tell a spring from a damper and from the load, or to tell how well it does: damping,
    memory, the load's moment arms and the sensor's turn are those of `fit`, the offset is the stance's own, and there
    is no interval.
    """
    found: list[tuple[StanceStiffness, float]] = []
    for recording, block in _walks(recordings, fit):
        assert block.stances is not None, "blocks of a foot that steps"
        time = recording.time[recording.rows(fit.foot)]
        for rows in block.stances.split():
            if len(rows) < SHORTEST_FITTED_RUN:
                continue
            value, information = _slope(block, rows, fit)
            if information > 0:
                start, end = float(time[rows[0]]), float(time[rows[-1]])
                where = (recording.name, recording.role, fit.foot, fit.axis)
                found.append((StanceStiffness(*where, start, end, value, 0.0), information))
    fitted = sum(information for row, information in found if row.role == "fit")
    return [replace(row, share=information / fitted) for row, information in found] if fitted > 0 else []


def walk_stiffness(recordings: Sequence[Recording], fit: AxisFit) -> list[WalkStiffness]:
    """Of every recording with enough stances, fitted or unseen, by the same least squares as of all together."""
    found = []
    for recording, block in _walks(recordings, fit):
        assert block.stances is not None, "blocks of a foot that steps"
        stances = len(block.stances.split())
        if stances < FEWEST_STANCES:
            continue
        alone = fit_blocks([block])
        noise = attenuation([block], alone.values, shared_offset=False)
        if noise is None:  # angles that are mostly noise give no slope
            continue
        value = float(alone.values[0] + noise[0])
        interval = interval95(value, float(alone.std[0]), float(alone.freedom[0]))
        where = (recording.name, recording.role, fit.foot, fit.axis)
        found.append(WalkStiffness(*where, stances, value, interval))
    return found


def _walks(recordings: Sequence[Recording], fit: AxisFit) -> list[tuple[Recording, Block]]:
    """The recordings in which the foot steps, with the rows of the fit's model; the unseen ones too."""
    walks = [recording for recording in recordings if recording.stances[fit.foot] is not None]
    known = replace(fit, offsets={recording.name: 0.0 for recording in walks})
    blocks = blocks_of(walks, fit.foot, fit.axis, fit=known)
    return list(zip(recordings_of(blocks, walks), blocks, strict=True))


def _slope(block: Block, rows: NDArray[np.intp], fit: AxisFit) -> tuple[float, float]:
    """Stiffness by the rows of one stance, and how much they say: load and angle, weighted and squared."""
    assert block.stances is not None, "a block of a foot that steps"
    assert block.common_nuisance is not None, "a block of a foot that steps"
    weight, regressor = block.stances.weight[rows], block.regressor[rows]
    if not weight.sum() > 0:
        return 0.0, 0.0
    others = regressor[:, 1:] @ fit.values[1:] + block.common_nuisance[rows] @ fit.place
    angle = _centred(regressor[:, 0], weight)
    torque = _centred(block.response[rows] - others, weight)
    information = float(np.sum(weight * angle**2))
    return float(np.sum(weight * angle * torque)) / max(information, np.finfo(float).tiny), information


def _centred(values: Array, weight: Array) -> Array:
    return np.asarray(values - np.average(values, weights=weight))
