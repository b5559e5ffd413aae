"""What a result says of a regularised fit: rank, what is not excited, how strongly it leans on the URDF, its rows."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from scipy import stats

import small_biped
from plantar.dynamics import base_parameters, model_parameters
from plantar.dynamics.equation import Equation
from plantar.robot.model import RobotModel
from plantar.whole_body.covariance import Uncertainty
from plantar.whole_body.regularised_fit import HeldOutError
from plantar.whole_body.regularised_result import (
    base_rows,
    excitation_of,
    fit_notes,
    identified_urdf,
    inertial_rows,
)

# Of folds that are unlike: the root of their mean is 1, 2 and 3.
HELD_OUT = tuple(
    HeldOutError(10.0**power, np.array([0.2, 1.8, 1.0]) * (1.0 + power) ** 2) for power in (0, 1, 2)
)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return small_biped.robot(tmp_path_factory.mktemp("biped"))


def fit_of(robot: RobotModel, **changes: Any) -> Any:
    """A fit whose inertias are twice the URDF's, with a regressor that excites everything."""
    equation = Equation(robot.floating_model)
    cad, base = model_parameters(robot.floating_model), base_parameters(equation)
    size = len(base) + 1
    triangle = np.triu(np.random.default_rng(0).normal(size=(size, size))) + 10 * np.eye(size)
    fields = {
        "equation": equation, "base": base, "prior": SimpleNamespace(cad=cad), "inertial": 2 * cad,
        "regularisation": 10.0, "held_out": HELD_OUT, "triangle": triangle,
    }  # fmt: skip
    return SimpleNamespace(**(fields | changes))


def test_rank_and_condition_are_the_regressors(robot: RobotModel) -> None:
    fit = fit_of(robot)
    rank, condition, notes = excitation_of(fit)
    assert (rank, notes) == (len(fit.base), [])
    assert condition == pytest.approx(np.linalg.cond(fit.triangle[:-1, :-1]))


def test_what_no_motion_excites_is_named(robot: RobotModel) -> None:
    triangle = fit_of(robot).triangle.copy()
    triangle[:, 3] = 0.0
    fit = fit_of(robot, triangle=triangle)
    rank, condition, (note,) = excitation_of(fit)
    assert rank == len(fit.base) - 1
    assert condition < 1e6, "of the directions that are excited"
    assert note.code == "unexcited"
    assert f"{rank} of {len(fit.base)} directions" in note.text
    assert note.text.endswith(fit.base.names[3])


def test_how_strongly_the_fit_leans_on_the_urdf_is_said(robot: RobotModel) -> None:
    (note,) = fit_notes(fit_of(robot))
    assert (note.code, note.severity) == ("regularisation", "info")
    for number in ("10", "held-out error 2 ", "1 at", "3 at"):
        assert number in note.text
    (unsure,) = fit_notes(fit_of(robot, held_out=()))
    assert (unsure.code, unsure.severity) == ("regularisation", "warning")
    assert fit_notes(fit_of(robot, regularisation=np.inf)) == []


def test_a_link_of_the_urdf_that_no_body_can_be_is_named(robot: RobotModel) -> None:
    cad = model_parameters(robot.floating_model)
    cad[10] = -1.0
    codes = {note.code: note.text for note in fit_notes(fit_of(robot, prior=SimpleNamespace(cad=cad)))}
    assert codes["cad_inconsistent"].endswith(f": {fit_of(robot).equation.links[1]}")


@pytest.mark.parametrize("gain", [0.0, 0.05])
def test_base_rows_have_students_intervals_that_hold_the_sensors_gain(robot: RobotModel, gain: float) -> None:
    """Ten kilograms by sensors that read 5 % too much are not known to a gram."""
    fit = fit_of(robot)
    noise = np.linspace(0.1, 1.0, len(fit.base))
    told = replace(robot, uncertainty=replace(robot.uncertainty, wrench_gain=gain))
    rows = base_rows(told, fit, Uncertainty(noise, {}, 5.0))
    values = fit.base.grouping @ fit.inertial
    std = np.sqrt(noise**2 + (gain * values) ** 2)
    half = stats.t.ppf(0.975, 5.0) * std
    for row, value, deviation, width in zip(rows, values, std, half, strict=True):
        assert (row.value, row.std) == pytest.approx((value, deviation))
        assert row.interval95 == pytest.approx((value - width, value + width))
        assert row.relative_std_percent == (pytest.approx(100 * deviation / abs(value)) if value else None)


def test_inertial_rows_stand_beside_the_urdfs(robot: RobotModel) -> None:
    rows = inertial_rows(fit_of(robot))
    first = {row.name: row for row in rows if row.link == "trunk"}
    assert (first["m"].value, first["m"].cad, first["m"].unit) == (20.0, 10.0, "kg")
    assert (first["mz"].cad, first["mz"].unit, first["Izz"].unit) == (pytest.approx(2.0), "kg.m", "kg.m2")
    assert len(rows) == 10 * len(fit_of(robot).equation.links)


def test_the_identified_urdf_holds_the_fits_bodies(robot: RobotModel) -> None:
    fit = fit_of(robot)
    text, notes = identified_urdf(robot, fit)
    assert notes == ()
    again = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    np.testing.assert_allclose(model_parameters(again), fit.inertial, atol=1e-12)
    assert ET.fromstring(text.encode()).tag == "robot"
