"""Where an unseen recording begins under a law with memory: the bush's inner state at its first sample."""

from __future__ import annotations

from plantar.conventions import ROTATIONAL_AXES, Array, Axis, Mask
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.regression_data import motion_of
from plantar.feet.recording import Recording
from plantar.model_selection.initial_state import initial_states_of


def unseen_initial_states(
    fit: AxisFit, recording: Recording, foot: str, axis: Axis, first: Mask
) -> Array | None:
    """The state (runs,) at the start of each run of an unseen recording; None for laws without memory."""
    motion = motion_of(recording, foot, axis)
    if not fit.model.remembers or not motion.runs or not first.any():
        return None
    torque, used = recording.bushes[foot].torque[:, ROTATIONAL_AXES.index(axis)], recording.used(foot)
    return initial_states_of(fit.model, fit.values, fit.shape, motion, torque, used, first, recording.cutoff)
