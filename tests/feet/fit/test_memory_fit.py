"""What a richer model is fitted to: torques and angles as the place and the drift that were found leave them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.fit import memory_fit
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.memory_fit import about_its_centre, data_sets_about, placed_as
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AngleDrift, AxisFit
from plantar.feet.regression.load_torque import load_torque
from plantar.feet.settings import FeetSettings

RUBBER = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)


@pytest.fixture(scope="module")
def recording() -> Recording:
    angle = swayed(3000, seed=1)
    return made_recording("sway", angle, RUBBER.torque(angle, np.gradient(angle, PERIOD)))


@pytest.fixture(scope="module")
def fit(recording: Recording) -> AxisFit:
    found = fit_axis([recording], FOOT, "pitch", FeetSettings(model="elastoplastic"))
    assert found is not None
    return found


def test_a_fit_is_made_about_the_place_that_another_one_found(fit: AxisFit) -> None:
    other = replace(fit, moment_arms=(0.001, 0.002), turned=0.03, imu_turned=(0.01, 0.02, 0.03), leans=0.5)
    placed = placed_as(fit, other)
    assert (placed.moment_arms, placed.turned, placed.imu_turned) == (
        (0.001, 0.002),
        0.03,
        (0.01, 0.02, 0.03),
    )
    assert placed.leans == fit.leans
    assert placed.values is fit.values


def test_what_was_found_is_taken_off_torque_and_path(recording: Recording, fit: AxisFit) -> None:
    drift = AngleDrift(recording.time, 1e-3 * np.sin(recording.time))
    about = replace(fit, moment_arms=(0.01, 0.0), drifts={"sway": drift})
    (as_read,) = data_sets_about([recording], fit)
    (found,) = data_sets_about([recording], about)
    load = load_torque(recording, about)
    assert np.nanmax(np.abs(load)) > 0.1
    np.testing.assert_allclose(found.torque, as_read.torque - load)
    np.testing.assert_array_equal(found.drift, drift.angle)
    assert as_read.drift is None
    np.testing.assert_array_equal(found.motion.deflection, as_read.motion.deflection)


def test_a_memory_is_found_about_the_centre_that_the_round_before_left(
    recording: Recording, fit: AxisFit, monkeypatch: pytest.MonkeyPatch
) -> None:
    """How far aside it is stances find by themselves; other slip angles are tried once."""
    searched = list[bool]()
    asked: list[tuple[float, ...]] = []
    rounds = iter((1.0, 2.0, 3.0))

    def over_stances(*_: object) -> SimpleNamespace:
        at = next(rounds)
        return SimpleNamespace(place=(at, 10 * at, 100 * at))

    def data_set_of(one: object, foot: str, axis: str, share: float, *place: float) -> str:
        assert (one, foot, axis, share) == (recording, fit.foot, fit.axis, 0.3)
        asked.append(place)
        return "data"

    monkeypatch.setattr(memory_fit, "over_stances", over_stances)
    monkeypatch.setattr(memory_fit, "data_set_of", data_set_of)
    monkeypatch.setattr(memory_fit, "with_model", lambda *given: given)

    def fit_again(before: object, sets: object, *, elsewhere: bool) -> tuple[object, object]:
        searched.append(elsewhere)
        return before, sets

    monkeypatch.setattr(memory_fit, "fit_again", fit_again)
    found = about_its_centre(fit, "first", [recording], 0.3)  # type: ignore[arg-type]
    assert asked == [(10.0, 100.0), (20.0, 200.0)]
    assert searched == [True, False]
    assert found.place == (3.0, 30.0, 300.0)  # type: ignore[comparison-overlap]
