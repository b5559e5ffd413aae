"""An attitude that drifts is taken off the path of a memory, which slips by the angle itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import Array
from plantar.feet.fit.angle_drift import beside_drift
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AngleDrift, AxisFit
from plantar.feet.regression.model_columns import model_columns
from plantar.feet.settings import FeetSettings

COUNT = 6000
RUBBER = Rubber(stiffness=150.0, damping=6.0, slip_torque=2.4, slip_angle=0.01)
REACH = 0.0118  # rad
DRIFT = 1e-3 * np.linspace(-1.0, 1.0, COUNT)  # rad: a tenth of the slip angle to either side


def drifting(seed: int, drift: Array) -> list[Recording]:
    """Sways of which the widest just make the element slip, read by an attitude that drifts."""
    angle = swayed(COUNT, seed=seed)
    angle *= REACH / np.abs(angle).max()
    torque = RUBBER.torque(angle, np.gradient(angle, PERIOD))
    torque += 0.02 * np.random.default_rng(seed).standard_normal(COUNT)
    return [made_recording("sway", angle + drift, torque)]


def fitted(recordings: list[Recording]) -> AxisFit:
    fit = fit_axis(recordings, FOOT, "pitch", FeetSettings(model="elastoplastic"))
    assert fit is not None
    return fit


@pytest.mark.parametrize("seed", [2, 3, 5])
def test_a_drift_moves_nothing_from_the_spring_to_the_element(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    still, drifted = drifting(seed, 0 * DRIFT), drifting(seed, DRIFT)
    beside = fitted(drifted)
    moved = beside.values[0] - fitted(still).values[0]
    found = beside.drifts["sway"].at(drifted[0].time)
    np.testing.assert_allclose(np.ptp(found), np.ptp(DRIFT), rtol=0.3)
    assert np.corrcoef(found, DRIFT)[0, 1] > 0.98
    monkeypatch.setattr("plantar.feet.fit.angle_drift.ROUNDS", 0)
    without = fitted(drifted).values[0] - fitted(still).values[0]
    assert abs(without) > 1e-3 * RUBBER.stiffness
    assert abs(moved) < 0.5 * abs(without)


def test_an_attitude_that_does_not_drift_is_left_alone() -> None:
    still = fitted(drifting(1, np.zeros(COUNT)))
    assert still.values[0] == pytest.approx(RUBBER.stiffness, rel=0.01)
    assert all(np.ptp(drift.angle) < 0.05 * np.ptp(DRIFT) for drift in still.drifts.values())


def test_only_the_memory_s_path_is_without_the_drift() -> None:
    (recording,) = recordings = drifting(1, DRIFT)
    fit = fitted(recordings)
    time = recording.time
    moved = AngleDrift(time, 1e-3 * np.sin(time))
    before, after = (
        model_columns(recording, FOOT, "pitch", replace(fit, drifts=drifts))
        for drifts in ({}, {"sway": moved})
    )
    np.testing.assert_array_equal(before[:, :2], after[:, :2])
    assert np.abs(before[:, 2] - after[:, 2]).max() > 0.01


def test_drifts_that_do_not_matter_are_not_fitted_again() -> None:
    """A memory that slips far in every sway hardly feels them."""
    recordings = drifting(2, DRIFT)
    wide = [made_recording("sway", *_wide_sway())]
    calls = list[AxisFit]()

    def again(fit: AxisFit) -> AxisFit:
        calls.append(fit)
        return fit

    with_wide = fitted(wide)
    assert beside_drift(with_wide, wide, again) is with_wide
    assert calls == []
    assert beside_drift(replace(fitted(recordings), drifts={}), recordings, again) is not with_wide
    assert calls


def _wide_sway() -> tuple[Array, Array]:
    angle = 5 * REACH * np.sin(2 * np.pi * 0.3 * PERIOD * np.arange(COUNT))
    return angle + DRIFT, RUBBER.torque(angle, np.gradient(angle, PERIOD))
