"""The rows of one axis: what of a recording is its own beside its offset."""

from __future__ import annotations

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.fit.regression_data import blocks_of

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
