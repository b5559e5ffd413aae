"""The rows of one axis: what of a recording is its own beside its offset."""

from __future__ import annotations

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import blocks_of
from plantar.feet.regression.tangent import Tangent
from plantar.models import MODELS

STIFFNESS, COUNT = 400.0, 4000
TIME = PERIOD * np.arange(COUNT)


def test_an_attitude_that_wanders_draws_no_stiffness_to_zero() -> None:
    """A bow of 5 mrad beside a sway of 10 mrad: with a line alone the stiffness would be 19 % too small."""
    bend = swayed(COUNT, amplitude=0.01)
    wander = 0.005 * np.cos(2 * np.pi * TIME / TIME[-1])
    fit = fit_axis([made_recording("sway", bend + wander, STIFFNESS * bend)], FOOT, "pitch", LINEAR)
    assert fit is not None
    assert fit.values[0] == pytest.approx(STIFFNESS, rel=0.002)


def test_a_slow_lean_keeps_its_own_information() -> None:
    lean = 0.03 * np.sin(2 * np.pi * TIME / 35.0)
    (block,) = blocks_of([made_recording("lean", lean, STIFFNESS * lean)], FOOT, "pitch")
    assert block.nuisance is not None
    assert block.nuisance.shape[1] == 1
    (quick,) = blocks_of([made_recording("sway", swayed(COUNT), STIFFNESS * swayed(COUNT))], FOOT, "pitch")
    assert quick.nuisance is not None
    assert quick.nuisance.shape[1] == 4


def test_a_tangent_is_the_torques_slope_with_the_nonlinear_parameter() -> None:
    """Of friction·tanh(rate / r) it is -friction·rate / r² / cosh²(rate / r)."""
    friction, slip_rate, angle = 5.0, 0.1, swayed(COUNT)
    rate = np.gradient(angle, PERIOD)
    fit = AxisFit(
        foot=FOOT, axis="pitch", model=MODELS["coulomb"], values=np.array([400.0, 20.0, friction]),
        shape=np.array([slip_rate]), offsets={"sway": 0.0}, covariance=np.eye(4), freedom=np.ones(4),
        white_std=np.ones(4), offset_std={"sway": 0.0}, equivalent=(400.0, 20.0), choice=None, reason="",
    )  # fmt: skip
    recording = made_recording("sway", angle, 400.0 * angle, rate=rate)
    (block,) = Tangent.of(fit, [recording], False).blocks
    slope = -friction * rate / slip_rate**2 / np.cosh(rate / slip_rate) ** 2
    inner = slice(20, -20)  # ends of the filter
    expected = slope[recording.rows(FOOT)][inner]
    np.testing.assert_allclose(block.regressor[inner, 3], expected, atol=0.05 * np.abs(expected).max())
