"""Deviations of delays: from how axes disagree, from what a wrong model would make, from few independent values."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.estimation.delays.delay import Delay, Pair, _Cell, _pooled, estimate_delay
from plantar.estimation.delays.sensor_delays import (
    Balance,
    estimate_delays,
)
from plantar.signals.filters import differentiate, low_pass

FEWEST_CELLS = 6

PERIOD, SAMPLES = 0.01, 6000
INNER = slice(100, -100)
TIME = PERIOD * np.arange(SAMPLES)


def tone(delay: float, axes: int = 6, model_errors: Array | None = None) -> Pair:
    """A sine of 0.6 Hz on some axes, without noise, measured `delay` late."""
    predicted, measured = (
        300 * np.sin(2 * np.pi * 0.6 * (TIME - late)[:, None] + np.arange(6)) * (np.arange(6) < axes)
        for late in (0.0, delay)
    )
    drawn = np.zeros((0, 0, 6)) if model_errors is None else model_errors
    return Pair("tone", measured, differentiate(measured, PERIOD), predicted, PERIOD, drawn)


def test_two_values_that_differ_have_the_deviation_of_their_mean() -> None:
    """Half of their distance, as of any two values: with n for n - 1 it would be 0.7 of that."""
    found = estimate_delay([tone(0.002, axes=1), tone(0.008, axes=1)])
    assert isinstance(found, Delay)
    assert found.value == pytest.approx(0.005, abs=1e-4)
    assert found.std == pytest.approx(0.003 / np.sqrt(found.cells - 1), rel=0.02)


def test_a_model_that_is_wrong_in_size_is_no_delay_and_one_that_is_late_is() -> None:
    """The gain takes what goes along with the prediction; a prediction that may be 2 ms late moves all by 2 ms."""
    predicted = tone(0.0).predicted
    sized = np.array([0.1 * predicted, -0.1 * predicted])
    late = 0.002 * np.array([1.0, -1.0])[:, None, None] * differentiate(predicted, PERIOD)
    exact, larger, later = (
        estimate_delay([tone(0.004, model_errors=drawn)]) for drawn in (None, sized, late)
    )
    assert isinstance(exact, Delay)
    assert isinstance(larger, Delay)
    assert isinstance(later, Delay)
    assert larger.std == pytest.approx(exact.std, rel=0.02)
    assert later.std == pytest.approx(np.hypot(exact.std, 0.002), rel=0.05)


def feet(seed: int, *, axes: int = 6, late: float = 0.0, noise: float = 30.0) -> Balance:
    """Two feet's wrenches below 1.5 Hz on some axes; what the model may get wrong is `late` seconds of both feet."""
    random = np.random.default_rng(seed)
    load, between, wrong = (
        300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5) * (np.arange(6) < axes)
        for _ in range(3)
    )
    measured = np.array([load / 2 + between, load / 2 - between])
    rates = np.array([differentiate(foot, PERIOD) for foot in measured])
    drawn = late * rates.sum(axis=0) * np.array([1.0, -1.0])[:, None, None]
    predicted = load + noise / 300 * wrong
    return Balance(
        predicted[INNER], measured[:, INNER], rates[:, INNER], PERIOD, drawn[:, INNER] if late else drawn[:0]
    )


def test_a_model_that_moves_all_delays_at_once_stands_beside_the_scatter() -> None:
    exact, unsure = (estimate_delays([feet(1, late=late)]) for late in (0.0, 0.003))
    assert exact is not None
    assert unsure is not None
    for place in range(2):
        expected = np.hypot(np.sqrt(exact.covariance[place, place]), 0.003)
        assert np.sqrt(unsure.covariance[place, place]) == pytest.approx(expected, rel=0.1)


def test_few_cells_say_less_of_their_scatter() -> None:
    """The same recording twice: the covariance halves, and of n cells n - k are left to show the scatter."""
    one = feet(3, axes=2, noise=10.0)
    alone, twice = estimate_delays([one]), estimate_delays([one, one])
    assert alone is not None
    assert twice is not None
    assert FEWEST_CELLS <= alone.cells <= 12
    assert twice.cells == 2 * alone.cells
    left = [found.cells - len(found.values) for found in (alone, twice)]
    expected = 0.5 * alone.covariance * (2 * left[0] / left[1])
    np.testing.assert_allclose(twice.covariance, expected, rtol=1e-6)


def test_what_happens_to_leave_no_slow_scores_is_not_taken_for_certain() -> None:
    """A tenth of the force at another frequency of the same band: it beats too fast for the cosines of the covariance.

    Signals of a band have as many independent values as its width and length allow, so that such cells are not
    better known than others; with the model's error alone the deviation would be 0.6 ms.
    """
    clean = tone(0.0, axes=1)
    beside = 30 * np.sin(2 * np.pi * 0.75 * TIME)[:, None] * (np.arange(6) < 1)
    measured = clean.measured + beside
    found = estimate_delay([Pair("two", measured, differentiate(measured, PERIOD), clean.predicted, PERIOD)])
    assert isinstance(found, Delay)
    assert found.std > 0.001


def test_the_freedom_of_a_pooled_delay_is_that_of_its_best_cells() -> None:
    """Welch and Satterthwaite's: of n alike cells n times one's; a cell that hardly weighs hardly counts."""
    cell, loose = _Cell(0.002, 1e-3, 10.0, np.zeros(0)), _Cell(0.002, 1e-2, 30.0, np.zeros(0))
    assert _pooled([cell] * 4).freedom == pytest.approx(40.0)
    weights = np.array([1.0, 0.01]) / 1.01
    shares = weights**2 * np.array([1.0, 100.0])
    expected = shares.sum() ** 2 / (shares[0] ** 2 / 10 + shares[1] ** 2 / 30)
    assert _pooled([cell, loose]).freedom == pytest.approx(expected)
    assert _pooled([cell, loose]).std == pytest.approx(1e-3 / np.sqrt(1.01))
