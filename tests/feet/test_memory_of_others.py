"""A memory that other axes of a robot show is taken where one axis shows it less clearly, and nowhere else."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.memory_of_others import with_memory_of_others
from plantar.feet.recording import Recording
from plantar.feet.settings import FeetSettings
from plantar.models import KelvinVoigt

RUBBER = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)
NEARER = "elastoplastic predicts held-out motion better"


@pytest.fixture(scope="module")
def recordings() -> list[Recording]:
    angle = swayed(4000, seed=1)
    return [made_recording("sway", angle, RUBBER.torque(angle, np.gradient(angle, PERIOD)))]


@pytest.fixture(scope="module")
def clear(recordings: list[Recording]) -> AxisFit:
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings())
    assert fit is not None
    assert fit.model.name == "elastoplastic"
    return fit


@pytest.fixture(scope="module")
def spring(recordings: list[Recording], clear: AxisFit) -> AxisFit:
    """As of short stances: the memory is nearer, and gains too little."""
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(), KelvinVoigt())
    assert fit is not None
    assert clear.choice is not None
    return replace(fit, choice=replace(clear.choice, caution=NEARER))


def foot(fit: AxisFit, recordings: list[Recording]) -> FittedFoot:
    ready: Any = SimpleNamespace(fitted=recordings, settings=FeetSettings())
    return FittedFoot(FOOT, None, {"pitch": fit}, {}, ready, ready, ())  # type: ignore[arg-type]


def test_a_memory_that_another_axis_shows_is_taken(
    recordings: list[Recording], clear: AxisFit, spring: AxisFit
) -> None:
    feet = {"one": foot(spring, recordings), "other": foot(clear, recordings)}
    found = with_memory_of_others(feet)["one"].fits["pitch"]
    assert found.model.name == "elastoplastic"
    assert found.values[0] == pytest.approx(RUBBER.stiffness, rel=0.02)
    assert spring.values[0] > 1.1 * RUBBER.stiffness
    assert found.choice is not None
    assert found.choice.caution is None
    assert [score.model.name for score in found.choice.ranking if score.chosen] == ["elastoplastic"]
    assert "other axes" in found.reason


def test_no_memory_is_made_up(recordings: list[Recording], clear: AxisFit, spring: AxisFit) -> None:
    assert spring.choice is not None
    sure = replace(spring, choice=replace(spring.choice, caution=None))
    refused = replace(
        spring,
        choice=replace(
            spring.choice,
            ranking=tuple(replace(score, refused="is not passive") for score in spring.choice.ranking),
        ),
    )
    for one, other in ((spring, spring), (sure, clear), (refused, clear)):
        feet = {"one": foot(one, recordings), "other": foot(other, recordings)}
        assert with_memory_of_others(feet)["one"].fits["pitch"] is one
