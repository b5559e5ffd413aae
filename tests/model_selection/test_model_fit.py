"""Fits of the laws of the bush to recordings whose rubber is known."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bush_data_sets import (
    PERIOD,
    Rubber,
    campaign,
    error_percent,
    filtered,
    opened,
    reconstructed,
    sway,
    tilt,
)
from plantar.errors import DataError
from plantar.estimation.slow_drift import drift_basis
from plantar.model_selection.data_sets import DataSet, prepare_data_sets
from plantar.model_selection.grid import Pieces, fit_all
from plantar.model_selection.model_fit import ModelFit, _onward, fit_model, refine
from plantar.model_selection.partialled_out import Linearised, Memory
from plantar.model_selection.selection import choose_model
from plantar.model_selection.variable_projection import Problem, best_candidate
from plantar.models import MODELS, BoucWen, BushMotion, Elastoplastic, Hardening, KelvinVoigt
from plantar.signals.filters import low_pass

JENKINS = Rubber(slip_torque=5.0, slip_angle=0.01)


SHAPES = {
    "coulomb": [0.02],
    "elastoplastic": [0.011],
    "hardening_elastoplastic": [0.011],
    "iwan": [0.009],
    "bouc_wen": [0.01, 1.8],
    "standard_linear_solid": [0.6],
}


OWN = {
    "hardening": [6000.0],
    "coulomb": [3.0],
    "elastoplastic": [5.0],
    "hardening_elastoplastic": [5.0, 6000.0],
    "iwan": [5.0],
    "bouc_wen": [5.0],
    "standard_linear_solid": [150.0],
    "coupled": [30.0, -2.0],
}


@pytest.mark.parametrize("name", sorted(MODELS))
def test_a_law_recovers_its_own_parameters(name: str) -> None:
    model = MODELS[name]
    rng = np.random.default_rng(5)
    values, shape = np.array([434.0, 15.9, *OWN.get(name, [])]), np.array(SHAPES.get(name, []))
    data_sets = []
    for label, start in (("a", 0.0), ("b", 0.3)):
        moved, other = sway(rng, 0.08, 0.5), sway(rng, 0.03, 0.7)
        motion = BushMotion(
            moved,
            np.gradient(moved, PERIOD),
            PERIOD,
            other[:, None],
            np.gradient(other, PERIOD)[:, None],
        )
        initial_states = np.array([start if model.remembers else 0.0])
        torque = model.columns(motion, shape, initial_states) @ values + rng.standard_normal()
        used = np.ones(len(moved), dtype=bool)
        used[:60] = used[-60:] = False
        data_sets.append(DataSet(label, motion, torque, used))
    fit = fit_model(model, data_sets, shared_offset=False)
    np.testing.assert_allclose(fit.values[:2], values[:2], rtol=5e-3)  # paths are thinned out
    np.testing.assert_allclose(fit.values[2:], values[2:], rtol=0.01)
    np.testing.assert_allclose(fit.shape, shape, rtol=0.02)
    assert fit.doubts == ()


@pytest.mark.parametrize(
    ("together", "apart", "told"),
    [
        (0.9, 0.02, True),  # slips one way alone: torque and angle any, but one over the other
        (0.9, 0.6, False),  # does not slip: how stiff it is, beside the spring, does not show either
        (0.02, 0.6, True),  # the torque by itself
    ],
)
def test_an_element_is_told_by_its_torque_or_by_how_stiff_it_is_before_it_slips(
    together: float, apart: float, told: bool
) -> None:
    """Of logarithms: the torque is as unsure as `together`, the angle by `apart` more."""
    log = np.diag([0.01, 0.01, 0.0, 0.0]) ** 2
    log[2:, 2:] = together**2 + np.diag([0.0, apart**2])
    values, shape = np.array([150.0, 6.0, 1.05]), np.array([0.0101])
    size = np.append(values, shape)
    fit = ModelFit(
        Elastoplastic(), values, shape, log * np.outer(size, size), np.full(4, 12.0), 0.01 * size,
        {}, {}, {}, {"sway": np.zeros(9)}, np.array([[1e-4], [0.013]]), 5.0, False,
    )  # fmt: skip
    assert bool(fit.doubts) != told
    assert all("cannot be told from zero: slip_torque 1.05" in line for line in fit.doubts)


def test_kelvin_voigt_is_plain_least_squares() -> None:
    data_sets = campaign(1, Rubber())
    fit = fit_model(KelvinVoigt(), data_sets, shared_offset=False)
    rows, right, places = [], [], []
    for place, data_set in enumerate(data_sets):
        filtered = low_pass(
            np.column_stack([data_set.motion.deflection, data_set.motion.rate, data_set.torque]), PERIOD, 5.0
        )
        ones = np.zeros((int(data_set.used.sum()), len(data_sets)))
        ones[:, place] = 1
        rows.append(np.column_stack([filtered[data_set.used, :2], ones]))
        right.append(filtered[data_set.used, 2])
        places.append(data_set.label)
    expected = np.linalg.lstsq(np.vstack(rows), np.concatenate(right), rcond=None)[0]
    np.testing.assert_allclose(fit.values, expected[:2], rtol=5e-4)  # the fit thins the samples out
    np.testing.assert_allclose([fit.offsets[label] for label in places], expected[2:], atol=0.01)


@pytest.mark.parametrize("shared", [False, True])
def test_nuisances_projected_out_are_the_same_as_fitted(shared: bool) -> None:
    """Against one dense least-squares problem with a column for every offset and every start."""
    rng = np.random.default_rng(2)
    sizes, run_counts, width = (90, 140), (2, 3), 4
    designs = [rng.standard_normal((n, width)) for n in sizes]
    responses = [rng.standard_normal(n) + 2 for n in sizes]
    runs = [np.sort(rng.integers(0, count, n)) for n, count in zip(sizes, run_counts, strict=True)]
    memories = [np.exp(-0.05 * np.arange(n)) + 0.2 * rng.random(n) for n in sizes]
    run = np.concatenate([runs[0], run_counts[0] + runs[1]])
    memory = Memory(np.concatenate(memories), run, run_counts)
    found = Linearised(np.vstack(designs), np.concatenate(responses), sizes, shared, memory)
    rows = sum(sizes)
    offsets = np.zeros((rows, 1 if shared else 2))
    initial_states = np.zeros((rows, sum(run_counts)))
    begin, first = 0, 0
    for place, (n, count) in enumerate(zip(sizes, run_counts, strict=True)):
        offsets[begin : begin + n, 0 if shared else place] = 1
        for run in range(count):
            mine = np.flatnonzero(runs[place] == run)
            initial_states[begin + mine, first + run] = memories[place][mine]
        begin, first = begin + n, first + count
    dense = np.column_stack([np.vstack(designs), offsets, initial_states])
    expected = np.linalg.lstsq(dense, np.concatenate(responses), rcond=None)[0]
    np.testing.assert_allclose(found.solve(), expected[:width], atol=1e-10)
    influence = np.vstack(found.influences())
    pseudo = np.linalg.pinv(dense)[: width + offsets.shape[1]].T
    np.testing.assert_allclose(influence[:, :width], pseudo[:, :width], atol=1e-10)
    np.testing.assert_allclose(influence[:, width:][:, : offsets.shape[1]], pseudo[:, width:], atol=1e-10)
    if not shared:
        change = found.initial_states(expected[:width])
        np.testing.assert_allclose(change, expected[width + 2 :], atol=1e-9)


@pytest.mark.parametrize(
    ("model", "rubber"),
    [
        (Elastoplastic(), JENKINS),
        (BoucWen(), replace(JENKINS, sharpness=2.0)),
        (Hardening(), Rubber(hardening=8000.0)),
    ],
    ids=lambda each: getattr(each, "name", ""),
)
def test_intervals_hold_the_truth(model: MODELS, rubber: Rubber) -> None:  # type: ignore[valid-type]
    inside, seeds = np.zeros(2), 4 if model.name == "bouc_wen" else 12
    for seed in range(seeds):
        fit = fit_model(model, campaign(seed, rubber), shared_offset=False)
        for place, truth in enumerate((rubber.stiffness, rubber.damping)):
            low, high = fit.interval95(fit.names[place])
            inside[place] += low <= truth <= high
            assert high - low < 0.2 * truth
    assert np.all(inside >= 0.75 * seeds)


def test_gaps_and_unused_samples_change_little() -> None:
    data_sets = campaign(2, JENKINS)
    holed = []
    for place, data_set in enumerate(data_sets):
        deflection, torque, used = (
            data_set.motion.deflection.copy(),
            data_set.torque.copy(),
            data_set.used.copy(),
        )
        deflection[1500 + 100 * place : 1560 + 100 * place] = np.nan
        torque[2500:2510] = np.nan
        used[3000:3300] = False
        used[1300 + 100 * place : 1760 + 100 * place] = False
        used[2300:2710] = False
        holed.append(DataSet(data_set.label, replace(data_set.motion, deflection=deflection), torque, used))
    whole, parted = (
        fit_model(Elastoplastic(), data_sets, shared_offset=False),
        fit_model(Elastoplastic(), holed, shared_offset=False),
    )
    assert all(len(initial_states) == 3 for initial_states in parted.initial_states.values())
    assert all(np.isfinite(residual).all() for residual in parted.residuals.values())
    assert error_percent(parted, JENKINS)[0] < 0.5
    assert error_percent(parted, JENKINS)[1] < 2
    np.testing.assert_allclose(parted.values, whole.values, rtol=0.02)


def test_a_start_that_is_not_virgin_is_found() -> None:
    rng = np.random.default_rng(4)
    data_sets = campaign(4, JENKINS)
    model, path = Elastoplastic(), sway(rng, 0.08, 0.5)
    motion = BushMotion(path, np.gradient(path, PERIOD), PERIOD)
    torque = model.columns(motion, [0.01], np.array([-0.7])) @ [434.0, 15.89, 5.0] + 1.5
    strained = DataSet("strained", motion, torque, np.ones(len(path), dtype=bool))
    fit = fit_model(model, [*data_sets, strained], shared_offset=False)
    assert fit.initial_states["strained"] == pytest.approx([-0.7], abs=0.05)
    assert fit.offsets["strained"] == pytest.approx(1.5, abs=0.2)
    first = np.arange(len(path)) < 200
    predicted, offset, initial_states = opened(
        fit_model(model, data_sets, shared_offset=False), strained, first
    )
    assert initial_states == pytest.approx([-0.7], abs=0.1)
    assert offset == pytest.approx(1.5, abs=0.5)
    assert np.abs(predicted - torque)[200:-200].mean() < 0.2


def test_a_shared_offset_is_one_number() -> None:
    data_sets = campaign(5, JENKINS, noise=0.0)
    fit = fit_model(Elastoplastic(), data_sets, shared_offset=True)
    assert len(set(fit.offsets.values())) == 1
    assert error_percent(fit, JENKINS)[0] < 0.2
    choice = choose_model(data_sets, shared_offset=True, before=None)
    assert choice.fit.model.name == "elastoplastic"


def test_reconstruction_is_the_fit_plus_its_residual() -> None:
    data_sets = campaign(6, JENKINS)
    fit = fit_model(Elastoplastic(), data_sets, shared_offset=False)
    for data_set in data_sets:
        motion, torque = filtered(data_set, fit.cutoff)
        missed = (torque - reconstructed(fit, motion, fit.initial_states[data_set.label]))[data_set.used]
        missed -= fit.offsets[data_set.label]
        slow = drift_basis(motion.period * np.flatnonzero(data_set.used))  # the attitude's drift is free
        missed -= slow @ (slow.T @ missed)
        assert np.std(missed) == pytest.approx(np.std(fit.residuals[data_set.label]), rel=0.05)


def test_nothing_to_fit_is_one_line() -> None:
    data_set = campaign(0, Rubber())[0]
    unused = replace(data_set, used=np.zeros_like(data_set.used))
    with pytest.raises(
        DataError,
        match=r"^no recording has a sample that this fit can use \(valid: at least one standing "
        r"second\)$",
    ):
        fit_model(KelvinVoigt(), [unused], shared_offset=False)
    with pytest.raises(
        DataError,
        match=r"^no recording has a sample that this fit can use \(valid: at least one standing "
        r"second\)$",
    ):
        choose_model([unused], shared_offset=False, before=None)


def test_wrong_starts_do_not_trap_the_refinement() -> None:
    """Four recordings, each from its own strained state, refined from starts that are all at the upper end."""
    rng = np.random.default_rng(9)
    model, data_sets, truth = Elastoplastic(), [], rng.uniform(-0.9, 0.9, 4)
    for place, start in enumerate(truth):
        path = tilt(rng, 0.012) if place else sway(rng, 0.08, 0.5)
        motion = BushMotion(path, np.gradient(path, PERIOD), PERIOD)
        torque = (
            model.columns(motion, [0.01], np.array([start])) @ [434.0, 15.89, 5.0] + rng.standard_normal()
        )
        used = np.ones(len(path), dtype=bool)
        used[:60] = used[-60:] = False
        data_sets.append(DataSet(f"trial_{place}", motion, torque, used))
    prepared = prepare_data_sets(data_sets, 5.0, drift=True)
    folds = [np.zeros(int(each.used.sum()), dtype=np.intp) for each in prepared]
    pieces = Pieces.of(model, prepared, folds, np.array([[0.009], [0.0125]]), [np.ones(1)] * 4)
    problem = Problem(model, prepared, False)
    fit = refine(
        problem,
        best_candidate(problem, pieces, fit_all(pieces, shared_offset=False)),
        np.array([[0.002], [0.05]]),
    )
    assert fit.rms < 0.02
    np.testing.assert_allclose(fit.values, [434.0, 15.89, 5.0], rtol=0.01)


def test_a_bush_that_never_moves_says_nothing() -> None:
    still = BushMotion(np.zeros(2000), np.zeros(2000), PERIOD)
    noise = np.random.default_rng(0).standard_normal(2000)
    choice = choose_model(
        [DataSet("still", still, noise, np.ones(2000, dtype=bool))], shared_offset=False, before=None
    )
    assert choice.fit.model.name == "kelvin_voigt"
    assert choice.reach == 0
    assert choice.caution is None


def test_many_short_runs_each_have_their_own_start() -> None:
    """As in walking: the foot leaves the ground every 0.9 s, and nobody knows how it comes back."""
    data_sets = []
    for data_set in campaign(0, JENKINS)[:2]:
        phase = np.arange(len(data_set.torque)) % 180
        deflection = np.where(phase < 20, np.nan, data_set.motion.deflection)
        used = data_set.used & (phase > 45) & (phase < 155)
        data_sets.append(
            DataSet(data_set.label, replace(data_set.motion, deflection=deflection), data_set.torque, used)
        )
    fit = fit_model(Elastoplastic(), data_sets, shared_offset=False)
    # The last run, of a third of a second, is filtered like any other.
    assert all(len(initial_states) == 27 for initial_states in fit.initial_states.values())
    assert error_percent(fit, JENKINS)[0] < 1
    assert error_percent(fit, JENKINS)[1] < 3


@pytest.mark.parametrize(("squares", "chosen"), [(1.005, 0), (0.995, 0), (0.985, 1)])
def test_landings_that_the_air_has_led_to_are_kept_where_they_gain_a_hundredth(
    squares: float, chosen: int
) -> None:
    rests: Any = [SimpleNamespace(squares=1.0), SimpleNamespace(squares=squares)]
    problem: Any = None
    assert _onward(problem, rests) is rests[chosen]
