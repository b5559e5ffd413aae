"""Causes of error that no residual shows: each widens the intervals by how far it would move the fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Axis
from plantar.estimation import Block, LinearFit, effect_of
from plantar.identify.height import Height
from plantar.identify.recording import Recording, lever_effect
from plantar.identify.settings import FeetSettings


def with_systematic_errors(
    fit: LinearFit,
    blocks: Sequence[Block],
    recordings: Sequence[Recording],
    foot: str,
    axis: Axis,
    settings: FeetSettings,
    vertical: Height,
) -> LinearFit:
    """The fit with its covariance widened by the lever of the vertical slide and by the zero of the yaw torque."""
    shared, column = settings.offset == "shared", ROTATIONAL_AXES.index(axis)
    served = {recording.name: recording for recording in recordings}
    levers = [
        lever_effect(served[block.label].bushes[foot], block.period, settings.cutoff)[served[block.label].used(foot), column]
        for block in blocks
    ]
    lever = effect_of(blocks, levers, shared_offset=shared)
    fit = fit.widened(lever, vertical.compliance_std[foot], vertical.freedom)
    if axis == "roll":
        # Roll's torque is cos(pitch)·τ_x - sin(pitch)·τ_z: the zero of τ_z, as large as the others', does not stay a
        # constant. Each recording has its own.
        usual = float(np.sqrt(np.mean(np.square(list(fit.offsets.values())))))
        for place, block in enumerate(blocks):
            changes = [np.zeros(len(other.response)) for other in blocks]
            recording = served[block.label]
            changes[place] = np.sin(recording.bushes[foot].deflection[recording.used(foot), 0])
            fit = fit.widened(effect_of(blocks, changes, shared_offset=shared), usual)
    return fit
