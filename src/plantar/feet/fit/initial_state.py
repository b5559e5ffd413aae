"""Where an unseen recording begins under a model with memory: the bush's inner state at its first sample."""

from __future__ import annotations

from plantar.conventions import ROTATIONAL_AXES, Array, Mask
from plantar.feet.fit.axis import FittedModel
from plantar.feet.fit.load_torque import load_torque
from plantar.feet.fit.regression_data import motion_of
from plantar.feet.recording import Recording
from plantar.model_selection.initial_state import initial_states_of


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
