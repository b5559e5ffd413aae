"""A moment arm that no bush has is told, whatever the robot file allows for."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.feet.place.place_notes import FAR_ARM, far_arms
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt


@pytest.mark.parametrize(
    ("arms", "told"),
    [
        ((0.0, 0.0), ""),
        ((0.03, -0.03), ""),
        ((-0.055, 0.001), "left pitch 55 mm forward or backward, left pitch 55 mm"),
        ((0.0, 0.05), "50 mm above or below"),
    ],
)
def test_an_arm_beyond_what_drawings_get_wrong_is_told(arms: tuple[float, float], told: str) -> None:
    fit = AxisFit(
        foot="left", axis="pitch", model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0),
        covariance=np.eye(2), freedom=np.full(2, 30.0), white_std=np.ones(2), offset_std={}, equivalent=(400.0, 20.0),
        choice=None, reason="", moment_arms=arms,
    )  # fmt: skip
    notes = far_arms([fit, fit])
    assert [note.code for note in notes] == ([FAR_ARM] if told else [])
    assert all(told in note.text and note.text.count("feet.left.wrench") == 1 for note in notes)
