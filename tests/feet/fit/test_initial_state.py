"""The state in which an unseen recording begins: asked of models with memory alone."""

from __future__ import annotations

import numpy as np
import pytest

from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.regression.prediction import unseen_initial_states
from plantar.models import BushMotion, Elastoplastic, KelvinVoigt

VALUES, SHAPE = np.array([400.0, 15.0, 5.0]), np.array([0.006])
FIRST = np.arange(3000) < 100
MODEL = FittedModel(foot=FOOT, axis="roll", model=Elastoplastic(), values=VALUES, shape=SHAPE)


def unseen(state: float) -> Recording:
    """A recording that begins in this state, with an offset that must not be taken for it."""
    angle = swayed(3000)
    motion = BushMotion(angle, np.gradient(angle, PERIOD), PERIOD)
    torque = Elastoplastic().columns(motion, SHAPE, np.array([state])) @ VALUES + 2.0
    return made_recording("unseen", angle, torque, role="validate", cutoff=20.0)


@pytest.mark.parametrize("state", [-0.8, 0.0, 0.6])
def test_it_is_the_state_that_the_torque_shows(state: float) -> None:
    found = unseen_initial_states(MODEL, unseen(state), FIRST)
    assert found == pytest.approx([state], abs=0.15)


def test_without_memory_or_without_first_samples_there_is_none() -> None:
    plain = FittedModel(foot=FOOT, axis="roll", model=KelvinVoigt(), values=VALUES[:2], shape=np.zeros(0))
    assert unseen_initial_states(plain, unseen(0.5), FIRST) is None
    assert unseen_initial_states(MODEL, unseen(0.5), np.zeros(3000, dtype=bool)) is None
