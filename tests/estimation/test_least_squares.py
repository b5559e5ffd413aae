"""Least squares over recordings, held to closed formulas, to published slopes and to simulated coverage."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.estimation.least_squares import Block, fit_linear, sureness_of_own, values_without_each


def beside(one: Block, column: Array) -> Block:
    return replace(one, regressor=np.hstack([one.regressor, column]))


def block(label: str, seed: int, offset: float = 0.0, rows: int = 300, noise: float = 0.5) -> Block:
    random = np.random.default_rng(seed)
    regressor = random.normal(size=(rows, 2)) * [0.02, 0.1] + [0.03, 0.0]
    response = regressor @ [400.0, 20.0] + offset + noise * random.normal(size=rows)
    return Block(label, regressor, response, 0.01)


@pytest.mark.parametrize(
    ("name", "slope"),
    [
        ("kt-1-10-46-5-09032023-141035", 2524.518),
        ("kt-2-5-17-2-27022023-172319", 2622.688),
        ("kt-5-3-27-2-27022023-173634", 1085.026),
        ("kt-9-1-70-5-09032023-143520", 1297.869),
    ],
)
def test_published_slopes_of_real_springs(shared_data: Path, name: str, slope: float) -> None:
    _, angle, torque = np.loadtxt(shared_data / "springs" / f"{name}.csv", delimiter=",", skiprows=1).T
    fit = fit_linear([Block(name, angle[:, None], torque, 0.01)])
    assert fit.values[0] == pytest.approx(slope, rel=1e-6)


def test_one_recording_is_ordinary_least_squares() -> None:
    """The white deviation is the textbook's sqrt(s²·diag((XᵀX)⁻¹))."""
    one = block("a", 1, offset=3.0)
    design = np.column_stack([one.regressor, np.ones(len(one.response))])
    expected, residual = np.linalg.lstsq(design, one.response, rcond=None)[:2]
    covariance = residual[0] / (len(design) - 3) * np.linalg.inv(design.T @ design)
    fit = fit_linear([one])
    np.testing.assert_allclose(fit.values, expected[:2], rtol=1e-10)
    assert fit.offsets["a"] == pytest.approx(expected[2])
    np.testing.assert_allclose(fit.white_covariance, covariance, rtol=1e-8)
    np.testing.assert_allclose(fit.white_std, np.sqrt(np.diag(covariance))[:2], rtol=1e-8)
    np.testing.assert_allclose(fit.residuals["a"], one.response - design @ expected, atol=1e-9)
    np.testing.assert_allclose(fit.predict(one.regressor, fit.offsets["a"]), design @ expected, rtol=1e-9)


@pytest.mark.parametrize("column", [0, 1])
def test_a_coefficient_of_its_own_is_as_sure_as_in_a_fit_with_one(column: int) -> None:
    """Of recordings of unlike lengths, one with a drift beside it, one without any motion in the other column."""
    blocks = [block("a", 1, offset=5.0), block("b", 2, rows=500, noise=2.0), block("c", 3, offset=-4.0)]
    blocks[1] = blocks[1].with_nuisance(np.linspace(-1, 1, 500)[:, None])
    blocks[2].regressor[:, 1 - column] = 0.0
    blocks[0].response[:] += 3.0 * blocks[0].regressor[:, column]
    expected = []
    for own in blocks:
        fit = fit_linear([beside(each, each.regressor[:, [column]] * (each is own)) for each in blocks])
        expected.append(abs(fit.values[-1]) / fit.std[-1])
    np.testing.assert_allclose(sureness_of_own(blocks, column), expected, rtol=1e-6)


def test_a_recording_without_motion_tells_no_coefficient_of_its_own() -> None:
    blocks = [block("a", 1), block("b", 2), block("c", 3)]
    blocks[1].regressor[:, 1] = 0.0
    assert sureness_of_own(blocks, 1)[1] == 0.0


def test_an_offset_for_each_recording_or_one_for_all() -> None:
    blocks = [block("a", 1, offset=5.0, noise=0), block("b", 2, offset=-7.0, noise=0)]
    own = fit_linear(blocks)
    np.testing.assert_allclose(own.values, [400, 20], rtol=1e-9)
    assert own.offsets == {"a": pytest.approx(5.0), "b": pytest.approx(-7.0)}
    shared = fit_linear(blocks, shared_offset=True)
    assert shared.offsets["a"] == shared.offsets["b"]
    design = np.vstack([np.column_stack([one.regressor, np.ones(300)]) for one in blocks])
    expected = np.linalg.lstsq(design, np.concatenate([one.response for one in blocks]), rcond=None)[0]
    np.testing.assert_allclose([*shared.values, shared.offsets["a"]], expected, rtol=1e-9)
    assert np.linalg.norm(shared.residuals["a"]) > 1.0


def test_own_offsets_are_the_stacked_problem_with_dummy_columns() -> None:
    blocks = [block("a", 1, offset=5.0), block("b", 2, offset=-7.0, rows=500)]
    design = np.vstack(
        [
            np.column_stack([one.regressor, np.tile(row, (len(one.response), 1))])
            for one, row in zip(blocks, np.eye(2), strict=True)
        ]
    )
    response = np.concatenate([one.response for one in blocks])
    fit = fit_linear(blocks)
    expected, residual = np.linalg.lstsq(design, response, rcond=None)[:2]
    np.testing.assert_allclose([*fit.values, *fit.offsets.values()], expected, rtol=1e-9)
    covariance = residual[0] / (len(design) - 4) * np.linalg.inv(design.T @ design)
    np.testing.assert_allclose(fit.white_covariance, covariance, rtol=1e-7)


def test_equation_7_a_recording_cut_in_two_is_the_recording() -> None:
    whole = block("a", 3, offset=2.0)
    halves = [
        Block(name, whole.regressor[rows], whole.response[rows], 0.01)
        for name, rows in (("a", slice(100)), ("b", slice(100, None)))
    ]
    fit, cut = fit_linear([whole]), fit_linear(halves, shared_offset=True)
    np.testing.assert_allclose(cut.values, fit.values, rtol=1e-10)
    np.testing.assert_allclose(cut.white_covariance, fit.white_covariance, rtol=1e-8)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_units_scale_through(scale: float) -> None:
    """The regressor in other units: values and deviations scale the other way, rank and condition stay."""
    one = block("a", 5, offset=1.0)
    fit = fit_linear([one])
    other = fit_linear([Block("a", one.regressor * [scale, 1.0], one.response, 0.01)])
    np.testing.assert_allclose(other.values, fit.values / [scale, 1.0], rtol=1e-8)
    np.testing.assert_allclose(other.std, fit.std / [scale, 1.0], rtol=1e-8)
    np.testing.assert_allclose(other.white_std, fit.white_std / [scale, 1.0], rtol=1e-8)
    np.testing.assert_allclose(other.freedom, fit.freedom, rtol=1e-8)
    assert other.condition_number == pytest.approx(fit.condition_number, rel=1e-6)
    torque = fit_linear([Block("a", one.regressor, one.response * scale, 0.01)])
    np.testing.assert_allclose(torque.values, fit.values * scale, rtol=1e-8)
    np.testing.assert_allclose(torque.std, fit.std * scale, rtol=1e-8)


def test_what_is_not_excited_shows_in_the_rank() -> None:
    one = block("a", 6)
    still = Block("a", one.regressor * [1.0, 0.0], one.response, 0.01)
    fit = fit_linear([still])
    assert fit.rank == 2
    assert np.isinf(fit.condition_number)
    assert fit.singular
    assert not fit_linear([one]).singular
    assert fit.values[1] == 0.0
    assert np.isfinite(fit.values).all()
    twice = Block("a", one.regressor[:, [0, 0]], one.response, 0.01)
    assert fit_linear([twice]).rank == 2


def test_rows_that_are_thinned_leave_the_papers_deviation_as_it_is() -> None:
    """It takes residuals of all samples for white; a fit of every fifth must not make it wider."""
    random, stride = np.random.default_rng(3), 5
    regressor = np.column_stack([np.sin(0.01 * np.arange(20_000)), np.cos(0.013 * np.arange(20_000))])
    response = regressor @ [3.0, 2.0] + random.normal(size=20_000)
    every = fit_linear([Block("log", regressor, response, 0.005)])
    thin = Block("log", regressor[::stride], response[::stride], 0.005 * stride, thinned=stride)
    np.testing.assert_allclose(fit_linear([thin]).white_std, every.white_std, rtol=0.05)
    assert thin.duration == pytest.approx(100.0)


def test_a_nuisance_is_fitted_beside_the_values_and_forgotten() -> None:
    """What all columns give as one fit, in values, residuals and their white deviations."""
    drift = np.linspace(-1, 1, 300)[:, None] ** [1, 2]
    one = block("a", 1)
    moved = Block("a", one.regressor + 0.02 * drift[:, :1], one.response + drift @ [3.0, 5.0], 0.01)
    design = np.column_stack([moved.regressor, np.ones(300), drift])
    values, squares, *_ = np.linalg.lstsq(design, moved.response, rcond=None)
    found = fit_linear([moved.with_nuisance(drift[:, :1]).with_nuisance(drift[:, 1:])])
    np.testing.assert_allclose(found.values, values[:2], rtol=1e-10)
    np.testing.assert_allclose(found.offsets["a"], values[2], rtol=1e-10)
    np.testing.assert_allclose(found.residuals["a"], moved.response - design @ values, atol=1e-10)
    white = np.sqrt(np.diag(np.linalg.inv(design.T @ design))[:2] * squares / (300 - 5))
    np.testing.assert_allclose(found.white_std, white, rtol=1e-10)


def test_values_without_each_recording_are_those_of_fits_of_the_others() -> None:
    random = np.random.default_rng(5)
    blocks = [
        Block(
            str(place),
            random.normal(size=(40, 2)),
            random.normal(size=40),
            0.1,
        ).with_nuisance(np.arange(40.0)[:, None])
        for place in range(4)
    ]
    expected = [fit_linear([*blocks[:place], *blocks[place + 1 :]]).values for place in range(4)]
    assert values_without_each(blocks) == pytest.approx(np.array(expected), rel=1e-10)
