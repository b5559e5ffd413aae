"""A bush with hysteresis through short stances: the search must not stay where all states are wrong together."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from plantar.model_selection.data_sets import DataSet, StepColumns
from plantar.model_selection.model_fit import fit_model
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
    fit = fit_model(MODELS["elastoplastic"], sets)
    errors = np.concatenate(
        [fit.initial_states[one.label] - own for one, own in zip(sets, truth, strict=True)]
    )
    assert abs(fit.value("stiffness") / K - 1) < 0.005
    assert np.sqrt(np.mean(errors**2)) < 0.2
