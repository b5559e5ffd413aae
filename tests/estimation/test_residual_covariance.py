"""Covariance of coloured residuals, degrees of freedom, Student's intervals."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

from plantar.estimation.least_squares import Block, fit_linear
from plantar.estimation.residual_covariance import (
    cosine_covariance,
    interval95,
    pooled_freedom,
    relative_std_percent,
    score_cosines,
)


def test_cosines_of_white_scores_give_the_white_variance() -> None:
    """Sum of n white scores of unit variance: variance n. Averaged over many draws."""
    random = np.random.default_rng(0)
    found = np.mean([cosine_covariance(random.normal(size=(500, 1)), 60.0)[0][0, 0] for _ in range(400)])
    assert found == pytest.approx(500, rel=0.06)


def test_cosines_of_coloured_scores_see_the_colour() -> None:
    """AR(1) with coefficient a: the variance of the sum is n / (1 - a)² for unit innovations."""
    random, a, count = np.random.default_rng(0), 0.95, 12_000
    draws = [signal.lfilter([1], [1, -a], random.normal(size=(count, 1)), axis=0) for _ in range(200)]
    found = np.mean([cosine_covariance(scores - scores.mean(), 120.0)[0][0, 0] for scores in draws])
    assert found == pytest.approx(count / (1 - a) ** 2, rel=0.15)


def test_degrees_of_freedom() -> None:
    assert cosine_covariance(np.ones((1000, 1)), 100.0)[1] == 20
    assert cosine_covariance(np.ones((1000, 1)), 1.0)[1] >= 4
    equal = pooled_freedom(np.ones((5, 2)), np.full((5, 2), 10.0))
    np.testing.assert_allclose(equal, 50.0)
    one_rules = pooled_freedom(np.array([[1.0], [1e-9]]), np.array([[6.0], [100.0]]))
    assert one_rules[0] == pytest.approx(6.0, rel=1e-3)


def test_intervals_are_students() -> None:
    low, high = interval95(10.0, 2.0, 8.0)
    assert (high - 10.0, 10.0 - low) == (pytest.approx(2 * 2.306004), pytest.approx(2 * 2.306004))
    assert relative_std_percent(-50.0, 1.0) == 2.0
    assert relative_std_percent(0.0, 1.0) is None


@pytest.mark.parametrize("colour", [0.0, 0.9, 0.98])
def test_intervals_cover_the_truth_in_95_of_100_cases(colour: float) -> None:
    """Simulated sways whose residuals are AR(1) at 100 Hz: coverage of K and C between 90 and 99 %."""
    random = np.random.default_rng(7)
    truth, period, count, cases = np.array([400.0, 20.0]), 0.01, 3000, 250
    time = np.arange(count) * period
    hits, white_hits = np.zeros(2), np.zeros(2)
    for _ in range(cases):
        blocks = []
        for label in "abc":
            slow, fast = random.uniform(0.15, 0.4), random.uniform(0.5, 1.0)
            phase = random.uniform(0, 2 * np.pi, 2)
            angle = 0.02 * np.sin(2 * np.pi * slow * time + phase[0]) + 0.01 * np.sin(
                2 * np.pi * fast * time + phase[1]
            )
            regressor = np.column_stack([angle, np.gradient(angle, period)])
            noise = signal.lfilter([1.0], [1.0, -colour], random.normal(size=count)) * np.sqrt(1 - colour**2)
            blocks.append(Block(label, regressor, regressor @ truth + random.normal() + 0.4 * noise, period))
        fit = fit_linear(blocks)
        for place in range(2):
            low, high = interval95(fit.values[place], fit.std[place], fit.freedom[place])
            hits[place] += low <= truth[place] <= high
            white_hits[place] += abs(fit.values[place] - truth[place]) <= 1.96 * fit.white_std[place]
    assert (hits / cases >= 0.90).all(), hits / cases
    assert (hits / cases <= 0.99).all(), hits / cases
    if colour == 0.98:
        assert (white_hits / cases < 0.7).all(), "the white formula is not to be trusted here"


def test_the_mean_of_scores_is_no_cosine() -> None:
    """A fit with own offsets leaves scores without mean; what a shared one leaves says nothing of their colour."""
    scores = np.random.default_rng(3).normal(size=(400, 1))
    plain, moved = (cosine_covariance(scores + mean, 40.0)[0][0, 0] for mean in (0.0, 5.0))
    assert moved == pytest.approx(plain, rel=1e-9)


def test_two_scores_have_one_cosine_whose_square_is_twice_their_variance() -> None:
    root = score_cosines(np.array([[1.0], [4.0]]), 1.0)
    np.testing.assert_allclose(root**2, [[9.0]])
