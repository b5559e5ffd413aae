"""One axis: the model asked for or chosen, and what is tried at all."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.contact.reasons import Reason
from plantar.contact.stances import Stances
from plantar.feet.fit import axis_fit
from plantar.feet.fit.axis_fit import LEAST_GAIN_IN_STANCES, _where_a_spring_turns, fit_axis
from plantar.feet.fit.hidden_memory import TORN, UNBELIEVED, UNTIMED, has_memory, moved_by_memory
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.settings import FeetSettings
from plantar.model_selection.selection import LEAST_GAIN
from plantar.models import KelvinVoigt

OFFSETS = (1.5, -0.7)
LINEAR = Rubber(stiffness=420.0, damping=18.0)
SLIPPING = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006)


def recordings(
    rubber: Rubber, noise: float = 0.15, disturbed: float = 0.0, amplitude: float = 0.03
) -> list[Recording]:
    """Two sways by `amplitude` [rad]; `disturbed` [N·m] is a torque that is none of the bush's."""
    made = []
    for seed, offset in enumerate(OFFSETS):
        angle, random = swayed(6000, amplitude, seed=seed), np.random.default_rng(seed)
        torque = (
            rubber.torque(angle, np.gradient(angle, PERIOD)) + offset + noise * random.standard_normal(6000)
        )
        torque += disturbed * np.sin(2 * np.pi * 0.53 * PERIOD * np.arange(6000))
        made.append(made_recording(f"sway_{seed}", angle, torque))
    return made


def fitted(made: list[Recording], **settings: object) -> AxisFit:
    fit = fit_axis(made, FOOT, "pitch", FeetSettings(**settings))  # type: ignore[arg-type]
    assert fit is not None
    return fit


def test_spring_damper_and_each_recordings_offset_come_back() -> None:
    fit = fitted(recordings(LINEAR), model="kelvin_voigt")
    assert fit.reason == "asked for"
    assert fit.choice is None
    assert fit.values == pytest.approx([420.0, 18.0], rel=0.01)
    assert list(fit.offsets.values()) == pytest.approx(OFFSETS, abs=0.05)
    assert np.all(np.abs(fit.values - [420.0, 18.0]) < 4 * fit.std)


def test_a_shared_offset_is_one() -> None:
    offsets = list(fitted(recordings(LINEAR), model="kelvin_voigt", offset="shared").offsets.values())
    assert offsets[0] == offsets[1]
    assert offsets[0] == pytest.approx(np.mean(OFFSETS), abs=0.2)


def test_hysteresis_is_chosen_by_held_out_motions_and_the_linear_fit_is_kept_beside() -> None:
    fit = fitted(recordings(SLIPPING))
    assert fit.model.name == "elastoplastic"
    assert fit.values == pytest.approx([420.0, 18.0, 4.0], rel=0.05)
    assert fit.equivalent[0] > 430.0
    assert fit.choice is not None
    assert "held-out" in fit.reason


@pytest.mark.parametrize("noise", [0.05, 0.01])  # with little noise a spring explains all there is
def test_motions_so_small_that_rubber_may_not_slip_are_no_proof_of_a_spring(noise: float) -> None:
    """An element that never slips is a spring like any other, and stiffness comes out larger by it."""
    hidden = Rubber(stiffness=420.0, damping=18.0, slip_torque=4.2, slip_angle=0.012)
    fit = fitted(recordings(hidden, noise=noise, amplitude=0.006))
    assert fit.model.name == "kelvin_voigt"
    assert fit.values[0] == pytest.approx(420.0 + 4.2 / 0.012, rel=0.02)
    assert fit.choice is not None
    assert fit.choice.caution is not None
    assert "bent by 0.0077 rad at most" in fit.choice.caution
    larger = fitted(recordings(LINEAR, noise=0.05, amplitude=0.015)).choice
    assert larger is not None
    assert larger.caution is None


def test_where_timing_is_in_doubt_no_memory_is_believed_but_widens_the_spring() -> None:
    """Sensors that are late make a loop of torque over angle as rubber's memory does."""
    fit = fit_axis(recordings(SLIPPING), FOOT, "pitch", FeetSettings(), timed=False)
    believed = fit_axis(recordings(SLIPPING), FOOT, "pitch", FeetSettings())
    assert fit is not None
    assert believed is not None
    assert fit.choice is not None
    assert fit.model.name == "kelvin_voigt"
    assert fit.choice.caution == UNTIMED
    assert [score.model.name for score in fit.choice.ranking if score.chosen] == ["kelvin_voigt"]
    assert all(score.refused == UNBELIEVED for score in fit.choice.ranking if has_memory(score.model))
    assert believed.model.name == "elastoplastic"
    moved = moved_by_memory(fit, steps=False)
    assert moved[0] >= 0.99 * abs(fit.values[0] - believed.values[0]) > 0.1 * believed.values[0]


def test_where_gaps_leave_short_runs_no_memory_is_tried_and_none_excluded() -> None:
    """Each run begins with a state that nobody knows: the element's slope is taken for the spring's."""
    silent = np.mod(PERIOD * np.arange(6000), 2.0) < 0.1
    edges = np.convolve(silent, np.ones(61), mode="same") > 0.5
    torn = []
    for one in recordings(SLIPPING):
        bush = one.bushes[FOOT]
        signals = {name: getattr(bush, name).copy() for name in ("deflection", "rate", "torque")}
        for values in signals.values():
            values[silent] = np.nan
        bushes = {FOOT: replace(bush, **signals)}
        torn.append(replace(one, raw=bushes, bushes=bushes).without(FOOT, edges, Reason.IMPACT))
    fit = fitted(torn)
    assert not fit.model.remembers
    assert fit.values[0] > 430.0
    assert fit.choice is not None
    assert fit.choice.caution == TORN


def test_without_noise_nothing_richer_is_tried_and_under_a_strange_torque_neither() -> None:
    exact = fitted(recordings(LINEAR, noise=0.0))
    assert exact.choice is None
    assert "no richer" in exact.reason
    strange = fitted(recordings(LINEAR, disturbed=30.0))
    assert isinstance(strange.model, KelvinVoigt)
    assert strange.choice is None
    assert "than the bush" in strange.reason


def test_a_foot_without_samples_has_no_fit() -> None:
    nothing = [one.without(FOOT, np.ones(6000, dtype=bool), Reason.IMPACT) for one in recordings(LINEAR)]
    assert fit_axis(nothing, FOOT, "pitch", FeetSettings()) is None


@pytest.mark.parametrize(("share", "moves"), [(0.4, True), (0.6, False)])
def test_another_place_has_to_explain_half_of_the_squares(share: float, moves: bool) -> None:
    """A torque by a horizontal force 4 mm above, and one that is nobody's with the `share` of the squares of both."""
    made = []
    for one in recordings(LINEAR, noise=0.0):
        time = one.time
        force, strange = 100.0 * np.sin(2 * np.pi * 0.53 * time), 0.4 * np.sin(2 * np.pi * 0.71 * time)
        bush = one.bushes[FOOT]
        more = 4e-3 * force + strange * np.sqrt(share / (1 - share))
        wrench = bush.wrench + force[:, None] * (np.arange(6) == 0)
        state = replace(bush, wrench=wrench, torque=bush.torque + more[:, None])
        turns = {FOOT: np.zeros((len(time), 2, 3))}
        made.append(replace(one, bushes={FOOT: state}, raw={FOOT: state}, imu_turns=turns))
    spring = fitted(made, model="kelvin_voigt")
    found = _where_a_spring_turns(spring, made, PlaceSpread(0.005, 0.005, 0.0), False)
    assert (found is not spring) == moves


class Asked(Exception):
    """In place of a choice of models."""


@pytest.mark.parametrize(
    ("steps", "offset"), [(False, "per-motion"), (False, "shared"), (True, "per-motion")]
)
def test_what_a_choice_of_models_is_asked(steps: bool, offset: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only of recordings that have a fit; stances follow their own offsets in part, and need a larger gain."""
    made, stances = recordings(SLIPPING), Stances(np.arange(6000) // 200, np.ones(6000))
    unused = np.arange(6000) >= 0
    made.append(
        replace(made[0], log=replace(made[0].log, name="unused")).without(FOOT, unused, Reason.SOLE_SLIDES)
    )
    if steps:
        made = [replace(one, stances={FOOT: stances}) for one in made]
        for one in made:
            one.raw[FOOT].torque[:, 1] = 0.0  # else a turned sensor would explain all
    before = fit_axis(recordings(SLIPPING), FOOT, "pitch", FeetSettings())
    assert before is not None
    asked: dict[str, Any] = {}

    def choose(data_sets: Any, models: Any, cutoff: float, **named: Any) -> None:
        asked.update(named, sets=data_sets, cutoff=cutoff)
        raise Asked

    monkeypatch.setattr(axis_fit, "choose_model", choose)
    settings = FeetSettings(offset=offset)  # type: ignore[arg-type]
    with pytest.raises(Asked):
        fit_axis(made, FOOT, "pitch", settings, before=before)
    assert [one.label for one in asked["sets"]] == ["sway_0", "sway_1"]
    assert asked["shared_offset"] == (offset == "shared")
    assert asked["least_gain"] == (LEAST_GAIN_IN_STANCES if steps else LEAST_GAIN)
    assert asked["before"] is before.choice
    assert asked["cutoff"] == made[0].cutoff
    if steps:
        assert {one.steps.share for one in asked["sets"]} != {0.0}


@pytest.mark.parametrize(
    ("steps", "short", "timed"), [(0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 1, 1), (1, 1, 0), (1, 0, 1)]
)
def test_a_standing_foot_whose_runs_are_short_is_torn(
    steps: bool, short: bool, timed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, stances = recordings(SLIPPING), Stances(np.arange(6000) // 200, np.ones(6000))
    if steps:
        made = [replace(one, stances={FOOT: stances}) for one in made]
        for one in made:
            one.raw[FOOT].torque[:, 1] = 0.0
    asked: dict[str, Any] = {}

    def tell(choice: Any, **named: Any) -> None:
        asked.update(named)
        raise Asked

    def choose(data_sets: Any, models: Any, cutoff: float, **named: Any) -> None:
        asked["remember"] = any(model.remembers for model in models)

    monkeypatch.setattr(axis_fit, "choose_model", choose)
    monkeypatch.setattr(axis_fit, "_remembers", lambda data_sets: not short)
    monkeypatch.setattr(axis_fit, "cautioned", tell)
    with pytest.raises(Asked):
        fit_axis(made, FOOT, "pitch", FeetSettings(), timed=bool(timed))
    assert asked == {
        "timed": bool(timed),
        "steps": bool(steps),
        "torn": bool(short and not steps),
        "remember": bool(timed) if steps else not short,
    }
