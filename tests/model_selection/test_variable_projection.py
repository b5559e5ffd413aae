"""The refinement: its derivatives and deviations against one dense linearised problem, and its runs."""

from __future__ import annotations

import numpy as np
import pytest

from bush_data_sets import PERIOD, Rubber, campaign, sway
from plantar.conventions import Array
from plantar.model_selection.data_sets import DataSet, FilteredDataSet, filtered_columns, prepare_data_sets
from plantar.model_selection.model_fit import ModelFit, fit_model
from plantar.model_selection.variable_projection import Problem
from plantar.models import MODELS, BushMotion, Elastoplastic

ITERATIONS = 16

JENKINS = Rubber(slip_torque=5.0, slip_angle=0.01)
MODEL = Elastoplastic()


def element(fit: ModelFit, prepared: list[FilteredDataSet], angle: float, moved: float = 0.0) -> list[Array]:
    """The slipping element's filtered torque, (n,) of each recording, at a slip angle and with states moved."""
    states = [fit.initial_states[each.label][None, :] + moved for each in prepared]
    columns = filtered_columns(MODEL, prepared, np.array([[angle]]), states)
    ends = np.cumsum([len(each.response) for each in prepared])
    return np.split(fit.values[2] * columns[:, 0, 0], ends[:-1])


def test_white_deviations_are_those_of_the_dense_problem() -> None:
    """Columns: K, C, the element's torque and its derivative by the slip angle, an offset and a state a recording."""
    data_sets = campaign(2, JENKINS)
    fit = fit_model(MODEL, data_sets, shared_offset=False)
    prepared = prepare_data_sets(data_sets, fit.cutoff, drift=True)
    angle, step = float(fit.shape[0]), 1e-3 * float(fit.shape[0])
    wider, narrower = (element(fit, prepared, angle + sign * step) for sign in (1, -1))
    later, earlier = (element(fit, prepared, angle, sign * 1e-3) for sign in (1, -1))
    rows = []
    for place, each in enumerate(prepared):
        own = np.zeros((len(each.base), 2 * len(prepared)))
        own[:, place] = 1.0
        own[:, len(prepared) + place] = (later[place] - earlier[place]) / 2e-3
        slope = (wider[place] - narrower[place]) / (2 * step)
        plain = element(fit, prepared, angle)[place] / fit.values[2]
        rows.append(np.column_stack([each.base, plain, slope, own]))
    dense = np.vstack(rows)
    residual = np.concatenate(list(fit.residuals.values()))
    every = prepared[0].every  # white are the samples that rows were taken of
    spread = residual @ residual / (every * len(residual) - dense.shape[1])
    expected = np.sqrt(spread * np.diag(np.linalg.pinv(dense.T @ dense))[:4])
    np.testing.assert_allclose(fit.white_std, expected, rtol=0.1)  # corners of the law make derivatives rough
    assert (fit.std > expected).all(), "coloured residuals, and what had to be estimated beside"


@pytest.mark.parametrize(("truth", "guess"), [(-0.7, -0.5), (0.2, 0.5)])
def test_a_step_moves_the_initial_state_towards_the_truth(truth: float, guess: float) -> None:
    path = sway(np.random.default_rng(4), 0.08, 0.5)
    motion = BushMotion(path, np.gradient(path, PERIOD), PERIOD)
    torque = MODEL.columns(motion, [0.01], np.array([truth])) @ [434.0, 15.89, 5.0] + 1.5
    used = np.ones(len(path), dtype=bool)
    prepared = prepare_data_sets([DataSet("strained", motion, torque, used)], 5.0, drift=True)
    problem = Problem(MODEL, prepared, shared_offset=False)
    point = problem.at(np.array([0.01]), np.array([guess]))
    linear = problem.linearised(point)
    (moved,) = linear.initial_states(linear.solve())
    assert moved == pytest.approx(truth - guess, rel=0.3)


def test_drift_is_taken_off_and_means_stay() -> None:
    (each,) = prepare_data_sets(campaign(1, Rubber())[:1], 5.0, drift=True)
    time = np.flatnonzero(each.used).astype(float)
    rows = np.column_stack([3.0 + 0.01 * time, np.sin(0.05 * time) - 2.0])
    clear = each.without_nuisance(rows)
    np.testing.assert_allclose(clear.mean(axis=0), rows.mean(axis=0), atol=1e-9)
    np.testing.assert_allclose(clear[:, 0], rows[:, 0].mean(), atol=1e-9)
    assert (time - time.mean()) @ clear[:, 1] == pytest.approx(0.0, abs=1e-6)


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
    fit = fit_model(model, [DataSet("sway", motion, torque, used)], shared_offset=False)
    assert ITERATIONS > 0
    assert len(fit.initial_states["sway"]) == 3
    np.testing.assert_allclose(fit.value("stiffness"), 400.0, rtol=0.01)
