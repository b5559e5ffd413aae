"""The refinement of shapes and initial states."""

from __future__ import annotations

import numpy as np

from plantar.model_selection.data_sets import DataSet
from plantar.model_selection.model_fit import fit_model
from plantar.model_selection.variable_projection import ITERATIONS
from plantar.models import MODELS, BushMotion


def test_a_run_without_a_used_sample_keeps_its_place() -> None:
    """Recordings end in stances of which nothing is used: their initial states are still counted."""
    period, random = 0.02, np.random.default_rng(0)
    time = period * np.arange(1500)
    angle = 0.05 * np.sin(2 * np.pi * 0.4 * time) + 0.02 * np.sin(2 * np.pi * 1.1 * time)
    rate = np.gradient(angle, period)
    angle[700:740] = angle[1200:1240] = np.nan
    motion = BushMotion(angle, np.where(np.isfinite(angle), rate, np.nan), period)
    model = MODELS["elastoplastic"]
    columns = model.columns(motion, [0.02])
    torque = np.nan_to_num(columns @ np.array([400.0, 15.0, 5.0])) + 0.01 * random.normal(size=time.size)
    used = np.isfinite(angle) & (time < 24.0)  # the third run is not used at all
    fit = fit_model(model, [DataSet("sway", motion, torque, used)])
    assert ITERATIONS > 0
    assert len(fit.initial_states["sway"]) == 3
    np.testing.assert_allclose(fit.value("stiffness"), 400.0, rtol=0.01)
