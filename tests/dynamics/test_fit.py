"""Streamed least squares for the base parameters, against a stacked QR."""

from __future__ import annotations

import itertools

import numpy as np
import pinocchio as pin
import pytest
from scipy import linalg

import example_robots
from example_robots import random_motion
from plantar import _core
from plantar.conventions import Array
from plantar.dynamics import (
    Equation,
    EquationStream,
    base_parameters,
    fit_base_parameters,
    fit_base_parameters_chunked,
    model_parameters,
    pinocchio_motion,
    regressor,
)
from plantar.dynamics.fit import solve_triangle
from plantar.dynamics.stream import stacked
from plantar.errors import DataError, RobotError, SettingsError


def measured(model: pin.Model, motion: tuple[Array, Array, Array], noise: float, seed: int) -> Array:
    equation = Equation(model)
    exact = equation.inverse_dynamics(
        pinocchio_motion(model, equation.tree, *motion), model_parameters(model)
    ).T
    return exact + np.random.default_rng(seed).normal(0, noise, exact.shape)


def stacked_qr(y: Array, tau: Array) -> tuple[Array, Array]:
    """Values and white deviations by SciPy, everything stacked."""
    q, r = linalg.qr(y, mode="economic")
    values = linalg.solve_triangular(r, q.T @ tau)
    residual = tau - y @ values
    inverse = linalg.solve_triangular(r, np.eye(len(values)))
    return values, np.sqrt(residual @ residual / (len(tau) - len(values)) * np.sum(inverse**2, axis=1))


@pytest.mark.parametrize("rows", ["base", "all"])
def test_values_and_deviations_are_those_of_the_stacked_problem(rows: str) -> None:
    model = example_robots.model(example_robots.TALOS, floating=True)
    motion = random_motion(model, 700, 1)
    tau = measured(model, motion, 0.5, 1)
    fit = fit_base_parameters(model, *motion, tau, rows=rows)  # type: ignore[arg-type]
    taken = 6 if rows == "base" else model.nv
    y = regressor(model, *motion)[:, :taken].reshape(-1, 330)[:, fit.base.kept]
    values, std = stacked_qr(y, tau[:, :taken].ravel())
    assert fit.rank == 234
    np.testing.assert_allclose(fit.values, values, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(fit.std, std, rtol=1e-9)
    missed = tau[:, :taken].ravel() - y @ values
    assert fit.residual_rms == pytest.approx(np.sqrt(np.mean(missed**2)), rel=1e-9)
    assert fit.condition_number == pytest.approx(np.linalg.cond(y), rel=1e-8)
    other = random_motion(model, 11, 2)
    expected = regressor(model, *other)[:, :taken][:, :, fit.base.kept] @ values
    np.testing.assert_allclose(fit.predict(*other), expected, rtol=1e-9, atol=1e-8)
    assert not any(name in repr(fit) for name in ("equation=", "base=", "rows=", "triangle=", "model="))


def test_rows_of_another_name_are_refused() -> None:
    model = example_robots.model(example_robots.PANDA)
    motion = random_motion(model, 3, 1)
    with pytest.raises(SettingsError, match=r"value 'joints': rows is not a choice \(valid: base, all\)"):
        fit_base_parameters(model, *motion, motion[1], rows="joints")  # type: ignore[arg-type]


def test_badly_conditioned_samples_keep_the_accuracy_of_qr() -> None:
    """A robot that hardly moves: condition number far beyond what normal equations bear."""
    model = example_robots.model(example_robots.PANDA)
    q, v, a = random_motion(model, 3000, 3)
    q, v, a = 0.3 + 3e-3 * q, 3e-3 * v, 3e-3 * a
    tau = measured(model, (q, v, a), 0.0, 3)
    fit = fit_base_parameters(model, q, v, a, tau, rows="all")
    assert 1e7 < fit.condition_number < 1e10
    truth = fit.base.grouping @ model_parameters(model)
    # Normal equations would leave no digit: eps times the condition squared is above one.
    assert np.finfo(float).eps * fit.condition_number**2 > 1e-2
    np.testing.assert_allclose(fit.values, truth, atol=1e-5)


@pytest.mark.parametrize("isa", _core.instruction_sets())
@pytest.mark.parametrize("count", [40, 3000])  # by reflections; by products, on all cores
def test_the_factor_is_that_of_the_dense_rows(isa: str, count: int) -> None:
    model = example_robots.model(example_robots.G1, floating=True)
    equation = Equation(model)
    base = base_parameters(equation)
    motion = pinocchio_motion(model, equation.tree, *random_motion(model, count, 6))
    torque = np.random.default_rng(6).normal(size=(count, 3))
    used, group = [0] * equation.n_rows, [0] * equation.n_rows
    used[3:6] = [1, 1, 1]
    stream = _core.Stream(equation.core, base.masks, used, group)
    extras: list[list[Array]] = [[] for _ in range(equation.n_rows)]
    extras[3:6] = [[column] for column in torque.T]
    for part in (slice(0, count // 2), slice(count // 2, count)):
        given = [[column[part] for column in columns] for columns in extras]
        stream.add(*vars(motion.select(part)).values(), given, 0, isa)
    rows = equation.regressor(motion, base.masks)[3:6]
    dense = np.hstack([np.vstack([row, column]) for row, column in zip(rows, torque.T, strict=True)]).T
    factor = stream.factor(0)
    assert np.array_equal(factor, np.triu(factor))
    square = dense.T @ dense
    scale = np.maximum(np.sqrt(np.diag(square)), 1.0)
    assert np.abs((factor.T @ factor - square) / np.outer(scale, scale)).max() < 1e-12


@pytest.mark.parametrize("exact", range(3))  # forces: torques about one point never determine all
def test_rows_that_products_cannot_serve_go_by_reflections_alone(exact: int) -> None:
    model = example_robots.model(example_robots.G1, floating=True)
    equation = Equation(model)
    base = base_parameters(equation)
    motion = pinocchio_motion(model, equation.tree, *random_motion(model, 1500, 8))
    wrench = np.random.default_rng(8).normal(size=(6, len(motion)))
    wrench[exact] = equation.inverse_dynamics(motion, model_parameters(model))[
        exact
    ]  # nothing of it is left over
    stream = EquationStream(equation, base, range(6))
    stream.add(motion, dict(enumerate(wrench)))
    rows = equation.regressor(motion, base.masks)
    for row, factor in stream.factors().items():
        dense = np.vstack([rows[row][factor.columns], wrench[row]])
        square, scale = dense @ dense.T, np.linalg.norm(dense, axis=1)
        np.testing.assert_allclose(
            factor.upper.T @ factor.upper, square, atol=1e-10 * float(scale.max()) ** 2
        )


def test_batches_of_any_size_give_the_same_as_one() -> None:
    model = example_robots.model(example_robots.G1, floating=True)
    motion = random_motion(model, 900, 4)
    tau = measured(model, motion, 0.1, 4)
    whole = fit_base_parameters(model, *motion, tau)
    cuts = [0, 1, 2, 40, 297, 298, 810, 900]
    chunks = (tuple(array[start:end] for array in (*motion, tau)) for start, end in itertools.pairwise(cuts))
    streamed = fit_base_parameters_chunked(model, chunks)  # type: ignore[arg-type]
    np.testing.assert_allclose(streamed.values, whole.values, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(streamed.std, whole.std, rtol=1e-9)
    assert streamed.samples == 900


def test_strided_and_fortran_arrays_are_read_as_they_are() -> None:
    model = example_robots.model(example_robots.UR5)
    motion = random_motion(model, 400, 5)
    tau = measured(model, motion, 0.1, 5)
    expected = fit_base_parameters(model, *motion, tau, rows="all").values
    wide = [np.asfortranarray(np.repeat(array, 2, axis=0))[::2] for array in (*motion, tau)]
    np.testing.assert_allclose(fit_base_parameters(model, *wide, rows="all").values, expected, rtol=1e-9)


def test_weights_and_extra_columns_enter_as_in_the_stacked_problem() -> None:
    model = example_robots.model(example_robots.UR5)
    equation, rng = Equation(model), np.random.default_rng(6)
    base = base_parameters(equation)
    q, v, a = random_motion(model, 500, 6)
    tau = rng.normal(size=(500, 6))
    stream = EquationStream(equation, base, range(6), {1: 2, 4: 1})
    extras = {1: [np.sign(v[:, 1]), np.ones(500)], 4: [v[:, 4]]}
    stream.add(pinocchio_motion(model, equation.tree, q, v, a), {r: tau[:, r] for r in range(6)}, extras)
    weights = [1.0, 0.5, 2.0, 3.0, 0.1, 1.5]
    triangle = stacked(list(stream.factors().values()), len(base), weights)
    dense = np.zeros((500, 6, len(base) + 3))
    dense[:, :, : len(base)] = regressor(model, q, v, a)[:, :, base.kept]
    dense[:, 1, -3:-1] = np.column_stack(extras[1])
    dense[:, 4, -1] = v[:, 4]
    y = (dense * np.array(weights)[:, None]).reshape(-1, dense.shape[2])
    b = (tau * weights).ravel()
    square = np.column_stack([y, b]).T @ np.column_stack([y, b])
    np.testing.assert_allclose(triangle.T @ triangle, square, rtol=1e-9, atol=1e-7)
    assert np.array_equal(triangle, np.triu(triangle))


def test_what_a_motion_does_not_excite_is_named_and_infinitely_uncertain() -> None:
    """An arm that only turns about its first axis: most of the wrist stays unknown, and is said so."""
    model = example_robots.model(example_robots.UR5)
    q, v, a = random_motion(model, 500, 7)
    for array in (q, v, a):
        array[:, 1:] = 0.0
    tau = measured(model, (q, v, a), 0.01, 7)
    fit = fit_base_parameters(model, q, v, a, tau, rows="all")
    assert fit.rank < len(fit.values)
    assert fit.condition_number == np.inf
    assert np.isinf(fit.std).any()
    assert np.isfinite(fit.values).all()
    (note,) = fit.notes
    assert note.code == "unexcited"
    named = note.text.split("not determined: ")[1].split("; ")
    unknown = [name for name, std in zip(fit.expressions, fit.std, strict=True) if np.isinf(std)]
    assert named == unknown
    assert any("wrist_3" in name for name in named)
    assert note.text.startswith(
        f"{len(fit.values) - fit.rank} of {len(fit.values)} directions are not excited"
    )
    np.testing.assert_allclose(fit.predict(q, v, a), tau, atol=0.06)


@pytest.mark.parametrize(("share", "excited"), [(0.04, True), (0.06, False)])
def test_a_parameter_is_named_from_a_twentieth_of_an_unexcited_direction_on(
    share: float, excited: bool
) -> None:
    """Three columns of length one whose sum, weighted by a unit direction, is nothing."""
    others = np.sqrt((1 - share**2) / 2)
    sine = share / (2 * others)
    columns = np.array([[1.0, -sine, -sine], [0.0, np.sqrt(1 - sine**2), -np.sqrt(1 - sine**2)]])
    stacked = np.column_stack([np.vstack([columns, np.zeros((2, 3))]), [1.0, 2.0, 0.0, 0.5]])
    found = solve_triangle(np.linalg.qr(stacked)[1])
    assert found.rank == 2
    assert found.excited.tolist() == [excited, False, False]
    assert found.residual == pytest.approx(0.5)


def test_one_sample_is_fitted_with_a_warning() -> None:
    model = example_robots.model(example_robots.G1, floating=True)
    motion = random_motion(model, 1, 8)
    fit = fit_base_parameters(model, *motion, measured(model, motion, 0.0, 8))
    assert fit.rank == 6
    assert {note.code for note in fit.notes} == {"unexcited", "too_few_samples"}
    assert not np.isfinite(fit.std).any()


def test_what_cannot_be_fitted_is_refused_in_one_line() -> None:
    model = example_robots.model(example_robots.UR5)
    q, v, a = random_motion(model, 10, 9)
    tau = np.zeros((10, 6))
    with pytest.raises(
        DataError, match=r"^base rows need a free-flyer at the root \(valid: rows='all' for a fixed base\)$"
    ):
        fit_base_parameters(model, q, v, a, tau)
    with pytest.raises(DataError, match=r"^tau: an array of shape \(10, 5\) \(valid: \(10, 6\)\)$"):
        fit_base_parameters(model, q, v, a, tau[:, :5], rows="all")
    tau[3, 2] = np.inf
    with pytest.raises(DataError, match=r"^tau: sample 3, column 2 is inf \(valid: finite\)$"):
        fit_base_parameters(model, q, v, a, tau, rows="all")
    with pytest.raises(DataError, match=r"^no samples to fit \(valid: at least one\)$"):
        fit_base_parameters_chunked(model, [], rows="all")
    ball = pin.Model()
    ball.addJoint(0, pin.JointModelSpherical(), pin.SE3.Identity(), "ball")
    with pytest.raises(
        RobotError, match=r"^joint 'ball' is of type Spherical: write it as three revolute joints$"
    ):
        fit_base_parameters(ball, q, v, a, tau, rows="all")


def test_deviations_count_what_is_excited_where_not_all_is() -> None:
    """A robot of which one joint alone turns: its noise comes back over the equations less the rank. Columns in which
    nothing but rounding is left are none: their values were 1e16."""
    model = example_robots.model(example_robots.PANDA)
    q, v, a = random_motion(model, 12, 3)
    q[:], v[:], a[:] = q[0], v * np.eye(model.nv)[1], a * np.eye(model.nv)[1]
    q[:, 1] += np.linspace(-0.5, 0.5, 12)
    fit = fit_base_parameters(model, q, v, a, measured(model, (q, v, a), 0.5, 1), rows="all")
    base = base_parameters(Equation(model))
    y = regressor(model, q, v, a).reshape(-1, 10 * (model.njoints - 1))[:, base.kept]
    assert fit.rank == np.linalg.matrix_rank(y) < len(base)
    assert np.abs(fit.values).max() < 1e3
    count, rank = len(y), fit.rank
    unseen = solve_triangle(np.linalg.qr(np.column_stack([y, np.zeros(count)]), mode="r"))
    white = fit.residual_rms * np.sqrt(count / (count - rank))
    np.testing.assert_allclose(fit.std[unseen.excited], (white * unseen.spread)[unseen.excited], rtol=1e-6)
