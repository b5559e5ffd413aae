"""When a foot's two fits say that its bush is turned about the vertical."""

from __future__ import annotations

import numpy as np
import pytest

from made_recording import FOOT, made_recording, swayed
from plantar.conventions import Axis
from plantar.feet.place.turned_bush import turned_bush_note
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt


def fit_of(axis: Axis, turned: float) -> AxisFit:
    return AxisFit(
        foot=FOOT, axis=axis, model=KelvinVoigt(), values=np.array([400.0, 10.0]), shape=np.zeros(0),
        covariance=np.eye(2), freedom=np.full(2, 10.0), white_std=np.ones(2), offset_std={}, equivalent=(400.0, 10.0),
        choice=None, reason="asked for", turned=turned, offsets={"sway": 0.0},
    )  # fmt: skip


@pytest.fixture
def standing() -> list[Recording]:
    deflection = swayed()
    return [made_recording("sway", deflection, 400.0 * deflection)]


@pytest.mark.parametrize(("pitch", "roll", "told"), [
    (0.06, 0.05, True),  # of one sign: the bush's own axes
    (0.06, -0.05, False),  # of opposite signs: a turned sensor
    (0.036, 0.036, True), (0.034, 0.034, False),
])  # fmt: skip
def test_a_foot_that_stands_tells_by_its_fits(
    standing: list[Recording], pitch: float, roll: float, told: bool
) -> None:
    note = turned_bush_note({"pitch": fit_of("pitch", pitch), "roll": fit_of("roll", roll)}, standing, False)
    assert (note is not None) is told
    assert note is None or note.code == "bush_turned"


def test_one_axis_alone_tells_nothing(standing: list[Recording]) -> None:
    fit = fit_of("pitch", 0.06)
    assert turned_bush_note({"pitch": fit}, standing, False) is None
