"""Minimal parameters: as many as the numerical rank, and equal to it in what they predict."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

import example_robots
from example_robots import random_motion
from plantar.dynamics import BaseParameters, Equation, base_parameters, regressor
from plantar.dynamics.base_parameters import parameter_name

ROBOTS = [
    (example_robots.TALOS, True),
    (example_robots.G1, True),
    (example_robots.ICUB, True),
    (example_robots.HUMANOID, True),
    (example_robots.TIAGO, True),
    (example_robots.HAND, False),
    (example_robots.PANDA, False),
    (example_robots.UR5, False),
    (example_robots.TIAGO, False),
]
NAMES = [f"{urdf.stem}-{'floating' if floating else 'fixed'}" for urdf, floating in ROBOTS]


@pytest.mark.parametrize(("urdf", "floating"), ROBOTS, ids=NAMES)
def test_there_are_as_many_as_the_numerical_rank_on_random_motion(urdf: object, floating: bool) -> None:
    model = example_robots.model(urdf, floating=floating)  # type: ignore[arg-type]
    base = base_parameters(Equation(model))
    y = regressor(model, *random_motion(model, 150, 1))
    rows = y[:, :6] if floating else y
    stacked = rows.reshape(-1, y.shape[2])
    singular = np.linalg.svd(stacked, compute_uv=False)
    assert len(base) == np.sum(singular > 1e-9 * singular[0])
    # Every row of eq. 1, joints included, follows from them.
    every = y.reshape(-1, y.shape[2])
    np.testing.assert_allclose(every[:, base.kept] @ base.grouping, every, atol=1e-9 * np.abs(every).max())


def test_talos_has_234() -> None:
    model = example_robots.model(example_robots.TALOS, floating=True)
    assert len(base_parameters(Equation(model))) == 234


def pendulum() -> pin.Model:
    """One link about a horizontal axis: Izz and the two first moments across it are all that moves it."""
    model = pin.Model()
    model.addJoint(0, pin.JointModelRZ(), pin.SE3(pin.utils.rotate("x", np.pi / 2), np.zeros(3)), "hinge")
    model.appendBodyToJoint(1, pin.Inertia.Random(), pin.SE3.Identity())
    return model


def test_a_pendulum_keeps_what_textbooks_keep() -> None:
    assert base_parameters(Equation(pendulum())).names == ("hinge.mx", "hinge.my", "hinge.Izz")


def bolted(kinds: tuple[object, ...]) -> pin.Model:
    """An arm whose joints all have the base's axes."""
    pin.seed(2)
    model, parent = pin.Model(), 0
    for place, kind in enumerate(kinds):
        about = pin.SE3(np.eye(3), np.array([0.2, 0.1, 0.3]))
        parent = model.addJoint(parent, kind, about, f"joint {place}")
        model.appendBodyToJoint(parent, pin.Inertia.Random(), pin.SE3.Identity())
    return model


@pytest.mark.parametrize(
    "kinds",
    [
        (pin.JointModelRZ(), pin.JointModelRZ(), pin.JointModelPZ()),
        (pin.JointModelPZ(), pin.JointModelRZ(), pin.JointModelRZ()),
        (pin.JointModelPX(), pin.JointModelRZ(), pin.JointModelRZ(), pin.JointModelPZ()),
    ],
)
def test_what_a_fixed_base_hides_is_lumped(kinds: tuple[object, ...]) -> None:
    """Of a SCARA and gantries some parameters act in fixed sums alone, though each has a column."""
    model = bolted(kinds)
    base = base_parameters(Equation(model))
    y = regressor(model, *random_motion(model, 60, 1))
    y = y.reshape(-1, y.shape[2])
    singular = np.linalg.svd(y, compute_uv=False)
    assert len(base) == np.sum(singular > 1e-9 * singular[0])
    np.testing.assert_allclose(y[:, base.kept] @ base.grouping, y, atol=1e-9 * np.abs(y).max())


def test_an_expression_says_what_is_lumped() -> None:
    """Two parallel hinges, 0.3 m apart: the second link's mass adds to the first one's moments."""
    model = pendulum()
    model.addJoint(1, pin.JointModelRZ(), pin.SE3(np.eye(3), np.array([0.3, 0, 0])), "elbow")
    base = base_parameters(Equation(model))
    assert base.expressions == (
        "hinge.mx + 0.3 elbow.m",
        "hinge.my",
        "hinge.Izz + 0.09 elbow.m",
        "elbow.mx",
        "elbow.my",
        "elbow.Izz",
    )


def test_expressions_say_each_share_with_its_sign() -> None:
    """Read back term by term, they are the grouping."""
    base = base_parameters(Equation(example_robots.model(example_robots.UR5)))
    number = {parameter_name(base.links, k): k for k in range(base.grouping.shape[1])}
    negative = 0
    for row, expression in enumerate(base.expressions):
        own, *rest = expression.split(" ")
        found = np.zeros(len(number))
        found[number[own]] = 1.0
        while rest:
            sign, rest = rest[0], rest[1:]
            size, rest = (1.0, rest) if rest[0] in number else (float(rest[0]), rest[1:])
            assert size > 0
            negative += sign == "-" and size != 1.0
            found[number[rest[0]]], rest = (size if sign == "+" else -size), rest[1:]
        np.testing.assert_allclose(found, base.grouping[row], atol=1e-5)
    assert negative > 3


def test_they_are_the_same_every_time_and_embed_without_loss() -> None:
    equation = Equation(example_robots.model(example_robots.UR5))
    first, second = base_parameters(equation), base_parameters(equation)
    assert isinstance(first, BaseParameters)
    np.testing.assert_array_equal(first.kept, second.kept)
    np.testing.assert_array_equal(first.grouping, second.grouping)
    values = np.arange(1.0, len(first) + 1)
    np.testing.assert_allclose(first.grouping @ first.embed(values), values, rtol=1e-12)
