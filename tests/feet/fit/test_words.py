"""What is said of memories that motions may hide, and of models that hardly matter: whole lines, and when."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.feet.fit import half_turns
from plantar.feet.fit.half_turns import _back, _spanned, cautioned_if_hardly_turned, slid_back
from plantar.feet.fit.hidden_memory import (
    NOT_EXCLUDED,
    TORN,
    UNBELIEVED,
    UNTIMED,
    cautioned,
    element_slope,
    only_too_small,
)
from plantar.feet.fit.worth import in_place_of
from plantar.feet.regression.axis import AxisFit
from plantar.model_selection.selection import ModelChoice, ModelScore
from plantar.models import MODELS, BushMotion


def score_of(model: str, rms: float, *, chosen: bool = False, refused: str | None = None) -> ModelScore:
    fit: Any = SimpleNamespace(model=MODELS[model])
    return ModelScore(MODELS[model], rms, fit, refused, chosen=chosen)


def choice_of(*scores: ModelScore, reach: float = 0.02, caution: str | None = None) -> ModelChoice:
    chosen = next(score for score in scores if score.chosen)
    spring = next(score for score in scores if score.model.name == "kelvin_voigt")
    return ModelChoice(chosen.fit, spring.fit, scores, "pieces", "why", reach, caution)


def axis_of(model: str, choice: ModelChoice | None, values: tuple[float, ...], **changes: Any) -> AxisFit:
    own = MODELS[model]
    size = len(own.terms) + len(own.shape_terms)
    return AxisFit(**({
        "foot": "left", "axis": "roll", "model": own, "values": np.array(values),
        "shape": np.full(len(own.shape_terms), 0.01), "covariance": np.eye(size), "freedom": np.full(size, 30.0),
        "white_std": np.ones(size), "offset_std": {}, "equivalent": (1.0, 1.0), "choice": choice, "reason": "",
    } | changes))  # fmt: skip


SPRING = score_of("kelvin_voigt", 1.0, chosen=True)
TIRED = score_of("elastoplastic", 0.7, refused="tired")


def test_cautions_come_in_their_order() -> None:
    small = "bent by 0.0123 rad at most: hysteresis that needs larger motions would not show; in those the stiffness "
    small += "may be smaller (record larger motions)"
    choice = choice_of(SPRING, reach=0.012345)
    assert cautioned(choice, timed=False, steps=False, torn=True).caution == UNTIMED
    assert cautioned(choice, timed=True, steps=True, torn=True).caution == TORN
    assert cautioned(choice, timed=True, steps=True, torn=False) is choice
    told = cautioned(choice, timed=True, steps=False, torn=False)
    assert told.caution == small.replace("0.0123", "0.012")
    assert only_too_small(told)
    assert not only_too_small(replace(told, reach=0.03))
    assert not only_too_small(choice)
    another = replace(choice, caution="another")
    assert cautioned(another, timed=True, steps=False, torn=True) is another


def test_a_memory_beside_delays_that_nobody_knows_is_no_memory() -> None:
    """Spring and damper stand in its place; what remembers nothing was refused for its own reason."""
    memory = score_of("elastoplastic", 0.7, chosen=True)
    plain = score_of("kelvin_voigt", 1.0)
    other = score_of("hardening", 0.9, refused="own reason")
    choice = choice_of(memory, other, plain)
    found = cautioned(choice, timed=False, steps=False, torn=False)
    assert (found.fit, found.caution, found.reason) == (plain.fit, UNTIMED, UNTIMED)
    assert [(one.model.name, one.chosen, one.refused) for one in found.ranking] == [
        ("elastoplastic", False, UNBELIEVED), ("hardening", False, "own reason"), ("kelvin_voigt", True, None)
    ]  # fmt: skip
    assert cautioned(choice, timed=True, steps=False, torn=False) is choice


def test_an_element_is_as_stiff_as_its_torque_over_its_angle() -> None:
    fit = axis_of("elastoplastic", None, (400.0, 20.0, -3.0), shape=np.array([0.012]))
    assert element_slope(fit) == pytest.approx(250.0)
    assert element_slope(axis_of("kelvin_voigt", None, (400.0, 20.0))) == 0.0
    assert element_slope(axis_of("hardening", None, (400.0, 20.0, 1e4))) == 0.0


def motions(
    monkeypatch: pytest.MonkeyPatch, *runs: list[float], steps: bool = True, name: str = "walk"
) -> Any:
    angle = np.concatenate([[*run, np.nan] for run in runs])
    monkeypatch.setattr(half_turns, "path_of", lambda *_: BushMotion(angle, 0 * angle, 0.01))
    return SimpleNamespace(name=name, stances={"left": object() if steps else None})


def test_hardly_turned_stances_in_words(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the median stance, from end to end."""
    one = motions(monkeypatch, [0.0, 0.0123], [0.1, -0.1], [0.003, -0.0093])
    of_memory = choice_of(score_of("elastoplastic", 0.7, chosen=True), score_of("kelvin_voigt", 1.0))
    memory = axis_of("elastoplastic", of_memory, (400.0, 20.0, 3.0), offsets={"walk": 0.0})
    told = cautioned_if_hardly_turned(memory, [one]).choice
    assert told is not None
    assert told.caution == (
        "stances bend the foot by 1.2 slip angles from end to end, where a full loop of hysteresis needs two: "
        "stiffness and slip torque can hardly be told apart (record longer steps, or stand and sway)"
    )
    spring = axis_of("kelvin_voigt", choice_of(SPRING), (400.0, 20.0), offsets={"walk": 0.0})
    told = cautioned_if_hardly_turned(spring, [one]).choice
    assert told is not None
    assert told.caution == (
        "stances bend the foot by 0.012 rad from end to end: hysteresis that needs more would not show; in larger "
        "motions the stiffness may be smaller (record longer steps, or stand and sway)"
    )
    assert _spanned(replace(spring, offsets={"other": 0.0}), [one]) is None, (
        "a walk that the fit has not seen"
    )


@pytest.mark.parametrize(
    ("slider", "way"),
    [
        ([0.0, 1.0, 2.0], 0.0),
        ([0.0, 1.0, 0.4, 0.1, 0.6], 0.9),
        ([0.0, -1.0, -1.0, -0.3, -0.9, -2.0], 1.7),  # standing still is no turn
        ([0.0, 1.0, 1.0 - 1e-7, 2.0], 0.0),  # nor is rounding
    ],
)
def test_the_longest_way_back_of_a_slider(slider: list[float], way: float) -> None:
    assert _back(np.array(slider)) == pytest.approx(way)


def test_of_many_runs_the_longest_way_back_counts_and_those_without_states_do_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one = motions(monkeypatch, [0.0, 0.018, -0.005], [0.0, 0.018, -0.009], steps=False)
    fit = axis_of("elastoplastic", None, (400.0, 20.0, 3.0), initial_states={"walk": np.zeros(2)})
    assert slid_back(fit, [one]) == pytest.approx(0.7)
    assert slid_back(replace(fit, initial_states={"walk": np.zeros(1)}), [one]) == np.inf
    assert slid_back(replace(fit, initial_states={}), [one]) == np.inf


@pytest.mark.parametrize("hidden", [0.0, 0.2])
def test_a_model_that_hardly_matters_gives_its_place_and_says_why(hidden: float) -> None:
    memory = score_of("elastoplastic", 0.7, chosen=True)
    others = score_of("iwan", 0.8, refused="tired"), score_of("kelvin_voigt", 1.0)
    choice = choice_of(memory, *others, caution="before")
    rich = axis_of("elastoplastic", choice, (412.0, 19.0, 3.0), hidden_share=hidden)
    spring = axis_of("kelvin_voigt", None, (400.0, 20.0))
    found = in_place_of(rich, spring)
    assert (found.model.name, found.hidden_share) == ("kelvin_voigt", hidden)
    assert found.reason == (
        "elastoplastic changes stiffness by 3 % and damping by 5 % only, less than their uncertainty"
    )
    assert found.choice is not None
    assert found.choice.caution == (NOT_EXCLUDED if hidden else "before")
    assert [(one.model.name, one.chosen, one.refused) for one in found.choice.ranking] == [
        ("elastoplastic", False, "hardly matters"), ("iwan", False, "tired"), ("kelvin_voigt", True, None)
    ]  # fmt: skip
    simpler = in_place_of(
        axis_of("hardening_elastoplastic", None, (412.0, 19.0, 3.0, 1e4)), replace(rich, choice=choice)
    )
    assert simpler.reason == (
        "what hardening_elastoplastic adds is no more than errors of robot file and sensors may make"
    )
    assert simpler.choice is None
