"""Torque that is not the bush's, beside its hand-made value."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_recording import LOAD, made_recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.regression.load_torque import ALL, load_of, load_torque, moment_columns, place_columns
from plantar.models import KelvinVoigt

TIME = 0.01 * np.arange(1000)
TORQUE = 5.0 * np.sin(TIME)
MODEL = FittedModel(
    foot="left", axis="roll", model=KelvinVoigt(), values=np.array([300.0, 5.0]), shape=np.zeros(0)
)


def test_a_centre_aside_carries_the_load() -> None:
    recording = made_recording("sway", 0.01 * np.sin(TIME), TORQUE)
    assert load_of(recording, "left") == pytest.approx(np.full(1000, LOAD))
    moved = load_torque(recording, replace(MODEL, moment_arms=(0.01, 0.0)))
    assert moved == pytest.approx(np.full(1000, 0.01 * LOAD))


def test_a_higher_centre_turns_the_horizontal_force_with_opposite_signs() -> None:
    recording = made_recording("sway", 0.01 * np.sin(TIME), TORQUE)
    bush = recording.bushes["left"]
    wrench = bush.wrench.copy()
    wrench[:, 0], wrench[:, 1] = 20.0, 30.0
    recording = replace(recording, bushes={"left": replace(bush, wrench=wrench)})
    assert moment_columns(recording, "left", "pitch", rows=ALL)[:, 1] == pytest.approx(np.full(1000, 20.0))
    assert moment_columns(recording, "left", "roll", rows=ALL)[:, 1] == pytest.approx(np.full(1000, -30.0))


def test_a_turned_sensor_shows_the_other_axis() -> None:
    recording = made_recording("sway", 0.01 * np.sin(TIME), TORQUE)
    assert place_columns(recording, "left", "roll")[:, 2] == pytest.approx(TORQUE)
    assert load_torque(recording, replace(MODEL, turned=0.1)) == pytest.approx(0.1 * TORQUE)
    assert not load_torque(recording, MODEL).any()
