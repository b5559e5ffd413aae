"""Beside a memory that motions hardly show, spring and damper are as unsure as that memory makes them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from plantar.feet.fit.hidden_memory import (
    UNTIMED,
    cautioned,
    may_hide_a_memory,
    moved_by_memory,
    rival,
    slope_share,
)
from plantar.feet.regression.axis import AxisFit
from plantar.model_selection.model_fit import ModelFit
from plantar.model_selection.selection import ModelChoice, ModelScore
from plantar.models import MODELS, BushMotion

SMALL = 0.015

SPRING = (500.0, 20.0)
OTHER = (400.0, 14.0, 2.0)  # with an element of slip torque 2 N.m


def fit_of(model: str, values: tuple[float, ...]) -> ModelFit:
    own = MODELS[model]
    size, shape = len(own.terms) + len(own.shape_terms), np.full(len(own.shape_terms), 0.02)
    white = np.ones(size)
    return ModelFit(
        own, np.array(values), shape, np.eye(size), white, white, {}, {}, {}, {}, np.zeros((2, 1)), 5.0, False
    )


def axis_of(
    *scores: tuple[str, tuple[float, ...], float], caution: str | None = "a memory may be hidden"
) -> AxisFit:
    """Spring and damper that predict with an error of 1, and what else was tried: model, values and error."""
    spring = fit_of("kelvin_voigt", SPRING)
    every = [ModelScore(spring.model, 1.0, spring, None, chosen=True)]
    every += [
        ModelScore(MODELS[name], error, fit_of(name, values), "hardly known")
        for name, values, error in scores
    ]
    ranking = tuple(sorted(every, key=lambda score: score.held_out_rms))
    choice = ModelChoice(spring, spring, ranking, "", "", 0.004, caution)
    return AxisFit(
        foot="left", axis="roll", model=spring.model, values=spring.values, shape=spring.shape,
        covariance=np.eye(2), freedom=np.full(2, 30.0), white_std=np.ones(2), offset_std={}, offsets={},
        equivalent=SPRING, choice=choice, reason="",
    )  # fmt: skip


def test_a_passive_memory_that_predicts_better_is_a_rival() -> None:
    found = rival(axis_of(("elastoplastic", OTHER, 0.6), ("bouc_wen", OTHER, 0.7)))
    assert found is not None
    assert found.model.name == "elastoplastic"


@pytest.mark.parametrize(
    ("model", "values", "error"),
    [
        ("elastoplastic", OTHER, 1.1),  # predicts worse
        ("elastoplastic", (400.0, 14.0, -2.0), 0.6),  # is not passive
        ("hardening", (400.0, 14.0, 1e4), 0.6),  # remembers nothing
    ],
)
def test_what_is_no_rival(model: str, values: tuple[float, ...], error: float) -> None:
    assert rival(axis_of((model, values, error))) is None


def test_a_memory_that_was_chosen_has_no_rival() -> None:
    fit = axis_of(("elastoplastic", OTHER, 0.6))
    assert rival(replace(fit, model=MODELS["bouc_wen"])) is None


def test_the_share_of_an_element_that_does_not_slip() -> None:
    """2 N.m at 0.02 rad are 100 N.m/rad: beside a spring of 400, a fifth of what both make together."""
    element = replace(
        axis_of(), model=MODELS["elastoplastic"], values=np.array(OTHER), shape=np.array([0.02])
    )
    assert slope_share(element) == pytest.approx(0.2)
    assert slope_share(axis_of()) == 0.0


@pytest.mark.parametrize("steps", [False, True])
def test_numbers_move_by_what_the_rival_makes_of_them_and_by_what_it_does_not_know(steps: bool) -> None:
    """100 N.m/rad and 6 N.m.s/rad apart, and the rival knows each to one."""
    moved = moved_by_memory(replace(axis_of(("elastoplastic", OTHER, 0.6)), hidden_share=0.19), steps=steps)
    np.testing.assert_allclose(moved, [np.hypot(100.0, 1.0), np.hypot(6.0, 1.0)])


def test_a_rival_that_leaves_the_spring_nearly_as_it_is_hides_no_element_like_those_of_other_axes() -> None:
    """In motions too small for it, a rival is the noise's: K = 499 beside it, where others' share makes 150 of 500."""
    fit = replace(axis_of(("elastoplastic", (499.0, 20.0, 0.1), 0.99)), hidden_share=0.3)
    np.testing.assert_allclose(moved_by_memory(fit, steps=False), [150.0, 1.0])


def test_without_a_rival_stiffness_moves_by_what_other_axes_show() -> None:
    np.testing.assert_allclose(
        moved_by_memory(replace(axis_of(), hidden_share=0.3), steps=False), [150.0, 0.0]
    )


def test_a_memory_that_was_chosen_hides_none() -> None:
    fit = replace(axis_of(("elastoplastic", OTHER, 0.6)), hidden_share=0.3, model=MODELS["elastoplastic"])
    np.testing.assert_array_equal(moved_by_memory(fit, steps=False), [0.0, 0.0])


def test_without_a_caution_nothing_moves() -> None:
    fit = axis_of(("elastoplastic", OTHER, 0.95), caution=None)
    np.testing.assert_array_equal(moved_by_memory(replace(fit, hidden_share=0.3), steps=False), [0.0, 0.0])


def test_in_short_stances_a_rival_counts_only_where_another_axis_shows_a_memory() -> None:
    fit = axis_of(("elastoplastic", OTHER, 0.6))
    assert moved_by_memory(fit, steps=False).all()
    np.testing.assert_array_equal(moved_by_memory(fit, steps=True), [0.0, 0.0])


def choice(model: str = "kelvin_voigt", reach: float = 2 * SMALL, caution: str | None = None) -> ModelChoice:
    fit = SimpleNamespace(model=MODELS[model])
    return ModelChoice(fit, fit, (), "", "", reach, caution)  # type: ignore[arg-type]


def test_sensors_that_may_be_late_leave_it_open() -> None:
    assert cautioned(choice(), timed=False, steps=True, torn=False).caution == UNTIMED
    assert cautioned(choice(caution="another"), timed=False, steps=True, torn=False).caution == "another"


@pytest.mark.parametrize(
    ("model", "reach", "steps", "told"),
    [
        ("kelvin_voigt", 0.9 * SMALL, False, True),
        ("kelvin_voigt", 1.1 * SMALL, False, False),
        ("kelvin_voigt", 0.9 * SMALL, True, False),
        ("elastoplastic", 0.9 * SMALL, False, False),
    ],
)
def test_small_motions_leave_it_open(model: str, reach: float, steps: bool, told: bool) -> None:
    found = cautioned(choice(model, reach), timed=True, steps=steps, torn=False).caution
    assert (found is not None) == told
    if found is not None:
        assert "bent by 0.013 rad" in found


@pytest.mark.parametrize(("amplitude", "hidden"), [(1.2 * SMALL, True), (1.5 * SMALL, False)])
def test_a_spring_that_explains_small_motions_may_not_be_all(amplitude: float, hidden: bool) -> None:
    angle = amplitude * np.sin(np.linspace(0, 20, 2000))
    assert may_hide_a_memory([BushMotion(angle, 0 * angle, 0.01)]) == hidden
