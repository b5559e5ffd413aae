"""What residuals' scores say too little of a fit's deviations, against a dense fit of noise, and draws of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from bush_data_sets import PERIOD, Rubber, sway
from plantar.model_selection import model_fit
from plantar.model_selection.absorbed_noise import lacking
from plantar.model_selection.data_sets import DataSet, FilteredDataSet, StepColumns, prepare_data_sets
from plantar.model_selection.model_fit import fit_model
from plantar.model_selection.partialled_out import Linearised, Memory
from plantar.model_selection.variable_projection import Problem
from plantar.models import BushMotion, Elastoplastic

RUBBER = Rubber(slip_torque=5.0, slip_angle=0.01)
COSINES = 0.2  # of a second of a recording: those below 0.1 Hz


def recorded(rng: np.random.Generator, size: float, duration: float) -> DataSet:
    """A sway of `size` slip angles and its torque."""
    angle = sway(rng, size * RUBBER.slip_angle, 0.4, duration)
    rate = np.gradient(angle, PERIOD)
    motion = BushMotion(angle, rate, PERIOD)
    return DataSet(f"{size}", motion, RUBBER.torque(angle, rate), np.ones(len(angle), dtype=bool))


def prepared_of(sizes: list[float], duration: float) -> list[FilteredDataSet]:
    rng = np.random.default_rng(4)
    return prepare_data_sets([recorded(rng, size, duration) for size in sizes], 5.0, drift=True)


def tangent(prepared: list[FilteredDataSet]) -> tuple[Linearised, np.ndarray]:
    """A fit of spring, damper and element with free states at the start, and its dense columns."""
    designs, effects = [], []
    for each in prepared:
        states = RUBBER.states(each.motion.deflection)
        columns = np.column_stack([each.motion.deflection, each.motion.rate, states])[:: each.every]
        slid = (np.cumsum(np.abs(states) == 1.0) == 0)[:: each.every]
        designs.append(each.without_nuisance(columns[each.used]))
        effects.append(each.without_nuisance(slid[each.used].astype(float)))
    rows = [len(design) for design in designs]
    run, design, effect = (
        np.repeat(np.arange(len(rows)), rows), np.concatenate(designs), np.concatenate(effects),
    )  # fmt: skip
    memory = Memory(effect, run, [1] * len(rows))
    linear = Linearised(design, np.zeros(len(design)), rows, False, memory)
    own = (run[:, None] == np.arange(len(rows))).astype(float)
    return linear, np.column_stack([design, effect[:, None] * own, own])


def drifts_of(prepared: list[FilteredDataSet]) -> list[np.ndarray]:
    return [each.drift for each in prepared]


def durations_of(prepared: list[FilteredDataSet]) -> list[float]:
    return [each.duration for each in prepared]


def dense_ratio(prepared: list[FilteredDataSet], dense: np.ndarray) -> np.ndarray:
    """Scatter of estimates of random walks over what the lowest cosines of their residuals' scores say of it."""
    solve, count = np.linalg.pinv(dense), 3
    rows = [len(each.response) for each in prepared]
    ends = np.cumsum([0, *rows])
    walks = np.zeros((ends[-1], ends[-1]))
    for each, first, last in zip(prepared, ends, ends[1:], strict=False):
        walks[first:last, first:last] = each.without_nuisance(np.tri(last - first))
    found = solve @ walks
    left = walks - dense @ found
    shown = np.zeros(count)
    for first, n, span in zip(ends, rows, durations_of(prepared), strict=False):
        most, own = round(COSINES * span), slice(first, first + n)
        phase = np.pi * np.arange(1, most + 1)[:, None] * (np.arange(n) + 0.5) / n
        for place in range(count):
            scores = np.sqrt(2 / most) * np.cos(phase) * solve[place, own]
            shown[place] += np.sum((scores @ left[own]) ** 2)
    return np.sqrt(np.sum(found[:count] ** 2, axis=1) / shown)


@pytest.mark.parametrize(("sizes", "duration"), [([1.3, 0.6, 0.5], 24.0), ([2.0], 100.0)])
def test_deviations_lack_what_a_dense_fit_of_noise_shows(sizes: list[float], duration: float) -> None:
    """Also where not every cosine is tried: there are 20 in 100 s."""
    prepared = prepared_of(sizes, duration)
    linear, dense = tangent(prepared)
    found = lacking(linear, drifts_of(prepared), durations_of(prepared))
    expected = dense_ratio(prepared, dense)
    assert expected.max() > 1.05
    np.testing.assert_allclose(found, np.maximum(expected, 1.0), rtol=0.02)


def test_a_short_recording_lacks_more_than_a_long_one() -> None:
    short, long = (prepared_of([1.2, 0.5], duration) for duration in (24.0, 240.0))
    few, many = (lacking(tangent(each)[0], drifts_of(each), durations_of(each)) for each in (short, long))
    assert few[2] > 1.4
    assert (many < 1.2).all()


def test_deviations_of_a_fit_hold_what_an_attitude_wanders_by() -> None:
    """Slip torque and slip angle of recordings in which the element hardly slips are off by what they claim."""
    rng, told = np.random.default_rng(3), []
    for _ in range(40):
        data_sets = []
        for size in (1.2, 1.1):
            clean = recorded(rng, size, 24.0)
            walk = 1e-5 * np.cumsum(rng.standard_normal(len(clean.torque)))
            motion = replace(clean.motion, deflection=clean.motion.deflection + walk)
            data_sets.append(replace(clean, motion=motion))
        fit = fit_model(Elastoplastic(), data_sets, shared_offset=False)
        errors = [fit.values[2] - RUBBER.slip_torque, fit.shape[0] - RUBBER.slip_angle]
        told.append(np.array(errors) / fit.std[2:])
    rms = np.sqrt(np.mean(np.square(told), axis=0))
    assert (rms < 1.5).all(), rms


def test_steps_lack_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """There it is not the attitude that makes the noise."""
    asked: list[int] = []
    monkeypatch.setattr(
        model_fit, "lacking", lambda linear, *_: asked.append(linear.size) or np.ones(linear.size)
    )
    rng = np.random.default_rng(3)
    stands = [recorded(rng, size, 24.0) for size in (1.3, 0.6)]
    none = [np.zeros(len(each.torque), dtype=np.intp) for each in stands]
    steps = [
        replace(each, steps=StepColumns(stance, np.zeros((len(stance), 0)), 1.0))
        for each, stance in zip(stands, none, strict=True)
    ]
    fit_model(Elastoplastic(), steps, shared_offset=False)
    assert not asked
    fit_model(Elastoplastic(), stands, shared_offset=False)
    assert asked


def test_a_model_that_is_not_searched_takes_up_no_noise(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_fit, "lacking", None)
    problem = Problem(Elastoplastic(), prepared_of([1.5, 3.0], 20.0), False)
    start = problem.at(np.array([RUBBER.slip_angle]), np.zeros(sum(problem.counts)))
    limits = RUBBER.slip_angle * np.array([[0.5], [2.0]])
    fit = model_fit.refine(problem, start, limits, refined=False)
    assert fit.shape == start.shape
    with pytest.raises(TypeError):
        model_fit.refine(problem, start, limits)
