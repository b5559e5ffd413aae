"""A bush with hysteresis through short stances: the search must not stay where all states are wrong together."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from plantar.model_selection import model_fit, selection
from plantar.model_selection.cross_validation import Candidate
from plantar.model_selection.data_sets import DataSet, StepColumns, prepare_data_sets
from plantar.model_selection.grid import Pieces
from plantar.model_selection.model_fit import ModelFit, fit_again, fit_model, refits_without_each
from plantar.model_selection.selection import choose_model
from plantar.model_selection.variable_projection import Problem
from plantar.models import MODELS, BushMotion

PERIOD = 0.005
K, C, SLIP_TORQUE, SLIP_ANGLE = 323.0, 17.5, 2.2, 0.01
LOAD = 560.0  # N


def walk(name: str, seed: int, stances: int = 12) -> tuple[DataSet, np.ndarray]:
    """One recording and the true state at each landing: a roll that swings over at landing and stays in the middle.

    In the air the bush goes back to where spring and element balance.
    """
    random, model = np.random.default_rng(seed), MODELS["elastoplastic"]
    path, stance, load, landings = [0.0], [-1], [0.0], []
    state = 0.0
    for number in range(stances):
        peak, middle, last = random.normal([0.026, 0.001, 0.020], [0.0010, 0.0015, 0.0015])
        knots = [random.normal(0.003, 0.001), peak, -0.012, middle, middle + 0.001, last]
        time = np.arange(0.0, 1.1, PERIOD)
        own = np.interp(time, [0.0, 0.1, 0.2, 0.35, 0.85, 1.1], knots)
        own = np.convolve(np.pad(own, 12, mode="edge"), np.hanning(25) / np.hanning(25).sum(), "valid")
        air = balanced(path[-1], state)
        way = np.concatenate([np.linspace(path[-1], air, 40), np.linspace(air, own[0], 40)])
        state = followed(way, state)
        landings.append(state)
        path += [*way, *own]
        stance += [-1] * len(way) + [number] * len(own)
        load += [0.0] * len(way) + [LOAD] * len(own)
        state = followed(own, state)
    deflection, number = np.array(path), np.array(stance)
    rate = np.gradient(deflection, PERIOD)
    columns = model.columns(BushMotion(deflection, rate, PERIOD), [SLIP_ANGLE], np.zeros(1))
    torque = columns @ [K, C, SLIP_TORQUE] + random.normal(0, 0.05, len(deflection)) + 0.7
    used = number >= 0
    for each in range(stances):
        rows = np.flatnonzero(number == each)
        used[rows[:22]] = used[rows[-22:]] = False
    away = np.where(number < 0, np.nan, 0.0)
    motion = BushMotion(deflection + away, rate + away, PERIOD)
    steps = StepColumns(number, np.array(load)[:, None], 0.95)
    return DataSet(name, motion, torque, used, steps), np.array(landings)


def followed(path: np.ndarray, state: float) -> float:
    """The element's state at the end of a path."""
    motion = BushMotion(path, np.zeros(len(path)), PERIOD)
    return float(MODELS["elastoplastic"].columns(motion, [SLIP_ANGLE], np.array([state]))[-1, 2])


def balanced(lifted: float, state: float) -> float:
    """Where a bush without load comes to rest after a lift from ``lifted``."""

    def torque(angle: float) -> float:
        return K * angle + SLIP_TORQUE * followed(np.linspace(lifted, angle, 100), state)

    return brentq(torque, -0.03, 0.03)


def test_spring_and_element_are_told_apart_through_short_stances() -> None:
    sets, truth = zip(*(walk(f"walk_{seed}", seed) for seed in (1, 2, 3)), strict=True)
    fit = fit_model(MODELS["elastoplastic"], sets, shared_offset=False)
    errors = np.concatenate(
        [fit.initial_states[one.label] - own for one, own in zip(sets, truth, strict=True)]
    )
    assert abs(fit.value("stiffness") / K - 1) < 0.005
    assert np.sqrt(np.mean(errors**2)) < 0.2


def shaken(seed: int) -> DataSet:
    """Stances of 0.7 s of a foot that steps and shakes, the element followed forty times as finely as it is sampled."""
    random, fine = np.random.default_rng(seed), 40
    time = PERIOD / fine * np.arange(24 * fine / PERIOD)
    angle, rate = np.zeros((2, len(time)))
    for frequency, size in ((1.0, 0.03), (2.0, 0.01), (4.3, 0.003), (9.0, 0.0015), (17.0, 0.0004)):
        pace = 2 * np.pi * frequency * random.normal(1.0, 0.02)
        phase = pace * time + random.uniform(0.0, 2 * np.pi)
        angle, rate = angle + size * np.sin(phase), rate + size * pace * np.cos(phase)
    element, state = np.empty(len(time)), 0.0
    for place, step in enumerate(np.diff(angle, prepend=angle[0]).tolist()):
        state = element[place] = min(max(state + step, -SLIP_ANGLE), SLIP_ANGLE)
    torque = K * angle + C * rate + SLIP_TORQUE / SLIP_ANGLE * element
    time, angle, rate, torque = (column[::fine] for column in (time, angle, rate, torque))
    away = np.where(time % 0.8 > 0.7, np.nan, 0.0)
    steps = StepColumns((time // 0.8).astype(np.intp), np.zeros((len(time), 1)), 1.0)
    motion = BushMotion(angle + away, rate + away, PERIOD)
    return DataSet(str(seed), motion, torque + away, away == 0, steps)


def test_a_turn_between_two_samples_takes_nothing_off_the_slip_angle() -> None:
    fit = fit_model(MODELS["elastoplastic"], [shaken(seed) for seed in (1, 2)], shared_offset=False)
    assert fit.value("slip_angle") == pytest.approx(SLIP_ANGLE, rel=0.002)
    assert fit.value("slip_torque") == pytest.approx(SLIP_TORQUE, rel=0.002)


def test_stances_take_the_rate_that_the_filter_leaves_and_states_that_of_the_path() -> None:
    data = shaken(1)
    (filtered,) = prepare_data_sets([data], cutoff=5.0, drift=True)
    assert filtered.every == 1 / (4 * 5.0 * PERIOD) // 1 > 1
    assert len(filtered.path) == len(filtered.motion) == len(data.motion)
    assert len(filtered.used) == len(filtered.motion.deflection[:: filtered.every])
    assert filtered.duration == pytest.approx(PERIOD * data.used.sum(), rel=0.05)


@pytest.mark.parametrize(("least_gain", "searched"), [(0.5, False), (0.1, True)])
def test_a_memory_that_could_not_help_enough_is_not_searched_for(least_gain: float, searched: bool) -> None:
    sets = []
    for seed in (1, 2, 3):
        data, _ = walk(f"walk_{seed}", seed)
        noise = np.random.default_rng(seed).normal(0, 0.05, len(data.torque))
        sets.append(replace(data, torque=K * data.motion.deflection + C * data.motion.rate + noise))
    models = [MODELS["kelvin_voigt"], MODELS["elastoplastic"]]
    choice = choose_model(sets, models, least_gain=least_gain, shared_offset=False, before=None)
    (memory,) = (score.fit for score in choice.ranking if score.model is models[1])
    tried = models[1].candidates([each.motion for each in prepare_data_sets(sets, 5.0, drift=True)])
    assert choice.fit.model.name == "kelvin_voigt"
    assert bool(np.isclose(tried, memory.shape, rtol=1e-12).any()) is not searched


@pytest.mark.parametrize(
    ("least_gain", "share", "searched"),
    [(0.31, 0.48, True), (0.31, 0.5, False), (0.29, 0.5, True), (0.29, 5.9, True), (0.29, 6.1, False)],
)
def test_what_is_searched_is_told_by_what_the_grid_leaves(
    least_gain: float, share: float, searched: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A gain of three tenths is half of the squares; where less is asked for, six times the best one is hopeless."""
    models = [MODELS["kelvin_voigt"], MODELS["elastoplastic"]]
    squares, asked, search = Candidate.squares.fget, {}, selection.refine  # type: ignore[attr-defined]
    linear: list[float] = []

    def left(candidate: Candidate) -> float:
        if candidate.model is models[0]:
            linear.append(squares(candidate))
        return linear[0] if candidate.model is models[0] else share * linear[0]

    def refine(problem: Problem, *given: Any, refined: bool, **more: Any) -> ModelFit:
        asked[problem.model.name] = refined
        return search(problem, *given, refined=False, **more)

    monkeypatch.setattr(Candidate, "squares", property(left))
    monkeypatch.setattr(selection, "refine", refine)
    choose_model([shaken(1)], models, least_gain=least_gain, shared_offset=False, before=None)
    assert asked[models[1].name] == searched


def test_a_fit_that_had_come_to_rest_looks_for_no_other_landings(monkeypatch: pytest.MonkeyPatch) -> None:
    """They would only be thrown away."""
    asked: list[object] = []
    land = model_fit.landed
    monkeypatch.setattr(model_fit, "landed", lambda *given: asked.append(given) or land(*given))
    sets = [walk("walk_1", 1)[0]]
    before = fit_model(MODELS["elastoplastic"], sets, shared_offset=False)
    searched = len(asked)
    assert searched == 1
    fit_again(before, sets)
    assert len(asked) == searched


@pytest.fixture(scope="module")
def walked() -> tuple[list[DataSet], ModelFit]:
    sets = [walk(f"walk_{seed}", seed)[0] for seed in (1, 2, 3)]
    return sets, fit_model(MODELS["elastoplastic"], sets, shared_offset=False)


def test_elsewhere_is_looked_for_from_a_minimum_that_is_not_the_least(
    walked: tuple[list[DataSet], ModelFit],
) -> None:
    """From an angle that is too large, and landings that are all wrong, steps and scans come to rest halfway."""
    sets, fit = walked
    half = {label: np.full(len(states), 0.5) for label, states in fit.initial_states.items()}
    wrong = replace(fit, shape=1.9 * fit.shape, initial_states=half)
    stays, found = (fit_again(wrong, sets, elsewhere=look) for look in (False, True))
    assert stays.value("slip_angle") > 1.5 * SLIP_ANGLE
    assert stays.rms > 1.2 * found.rms
    assert found.value("slip_angle") == pytest.approx(fit.value("slip_angle"), rel=0.02)
    again = fit_again(fit, sets, elsewhere=True)
    np.testing.assert_array_equal(again.values, fit_again(fit, sets).values)


def test_refits_lack_one_recording_each(walked: tuple[list[DataSet], ModelFit]) -> None:
    sets, fit = walked
    found = refits_without_each(fit.model, fit.shape, fit.initial_states, sets, fit.cutoff)
    without = [fit_again(fit, [each for each in sets if each is not one]) for one in sets]
    np.testing.assert_allclose(found, [np.append(each.values, each.shape) for each in without], rtol=1e-9)
    assert np.ptp(found, axis=0).all()


def test_a_choice_goes_on_from_the_one_with_a_few_samples_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its landings and its memory are known: the fit is that of a choice from nothing, and what to search is less."""
    models = [MODELS["kelvin_voigt"], MODELS["elastoplastic"]]
    sets = [walk(f"walk_{seed}", seed)[0] for seed in (1, 2, 3)]
    before = choose_model(sets, models, shared_offset=False, before=None)
    fewer = [replace(one, used=one.used & (np.arange(len(one.used)) % 1000 > 20)) for one in sets]
    anew = choose_model(fewer, models, shared_offset=False, before=None)
    tried: list[int] = []
    of = Pieces.of.__func__  # type: ignore[attr-defined]

    def counted(cls: type[Pieces], *given: Any, **more: Any) -> Pieces:
        tried.append(len(given[3]))
        return of(cls, *given, **more)

    monkeypatch.setattr(model_fit, "landed", None)
    monkeypatch.setattr(Pieces, "of", classmethod(counted))
    after = choose_model(fewer, models, before=before, shared_offset=False)
    assert after.fit.model.name == "elastoplastic"
    np.testing.assert_allclose(after.fit.values, anew.fit.values, rtol=2e-3)
    assert max(tried) < len(models[1].candidates([one.motion for one in sets]))
