"""Every lag tried: the right one is found among all, a push says nothing, and what does not fit says so."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.estimation.delays.lag_search import LagGrid, _beside, _windows, search_lags
from plantar.signals.filters import low_pass

PERIOD, SAMPLES, STEPS = 0.05, 800, 5
LAGS: Array = PERIOD * np.arange(-STEPS, STEPS + 1, dtype=np.float64)


def grid(late: tuple[int, int, int], *, seed: int = 1, push: float = 0.0) -> LagGrid:
    """Two feet and encoders late by steps of the grid; half of the motion shows in the encoders alone."""
    random = np.random.default_rng(seed)
    length = SAMPLES + 8 * STEPS
    trunk, arms, between, hand = (
        low_pass(random.standard_normal((length, 6)), PERIOD, 1.5) for _ in range(4)
    )
    ground = trunk + arms + push * hand
    feet = [ground / 2 + 3 * between, ground / 2 - 3 * between]

    def read(values: Array, shift: int) -> Array:
        return values[4 * STEPS + shift : 4 * STEPS + shift + SAMPLES]

    *each, encoders = late
    steps = range(-STEPS, STEPS + 1)
    predicted = np.array([read(trunk, 0) + read(arms, step - encoders) for step in steps])
    own = np.array([[read(foot, step - by) for step in steps] for foot, by in zip(feet, each, strict=True)])
    return LagGrid(predicted, np.tile(own, (len(LAGS), 1, 1, 1, 1)), LAGS, LAGS, PERIOD)


@pytest.mark.parametrize("late", [(0, 0, 0), (4, 4, 0), (4, 0, 0), (-4, -4, -4), (2, -1, 3)])
def test_each_lag_is_found_among_all(late: tuple[int, int, int]) -> None:
    found = search_lags([grid(late)])
    np.testing.assert_allclose(found.values, PERIOD * np.array(late), atol=1e-9)
    assert 0 <= found.missed[0] < 0.01
    assert found.std.max() < 0.05
    assert not found.at_edge


def test_rounding_leaves_no_less_than_nothing() -> None:
    """Where all is explained the rest is zero, on any processor: below it no lag was near the best, and std NaN."""
    for seed in range(8):
        found = search_lags([grid((4, 4, 0), seed=seed)])
        assert found.missed[0] >= 0
        assert np.isfinite(found.std).all()


def test_a_push_neither_hides_the_lag_nor_passes_for_one() -> None:
    found = search_lags([grid((3, 3, 0), push=5.0), grid((3, 3, 0), seed=2)])
    np.testing.assert_allclose(found.values, PERIOD * np.array([3, 3, 0]), atol=1e-9)
    assert found.missed[0] > 0.5
    assert found.missed[1] < 0.01
    assert found.power[0] < 0.2, "the hand's torques are not predicted"
    assert 0.8 < found.power[1] < 1.25


def test_a_narrow_grid_draws_what_is_beside_it_to_none() -> None:
    """By Bayes' rule: as far as the grid's steps let it go, and in the direction in which the windows pull."""
    grids, places = [grid((1, 0, 0)), grid((1, 0, 0), seed=2)], np.array([STEPS, STEPS, STEPS])
    steps = PERIOD * np.array([1.0, 2.0, 0.5])
    free = _beside(grids, places, 1e6 * steps)
    assert free[0] > 0.2 * PERIOD, "the first foot is late by a step"
    pulls = []
    for share in (1e-4, 1e-5):
        drawn = _beside(grids, places, share * steps)
        assert (np.abs(drawn) < 1e-3 * PERIOD).all()
        pulls.append(12 * drawn / (share * steps) ** 2)
    np.testing.assert_allclose(*pulls, rtol=1e-3)
    assert pulls[0] @ free > 0, "towards what it would be"
    between = _beside(grids, places, 0.1 * steps)
    assert 0 < between[0] < free[0]


def test_lags_beyond_the_grid_are_missed_and_no_lag_is_better_than_others() -> None:
    found = search_lags([grid((10, 10, 0))])
    assert found.missed[0] > 0.3
    assert found.at_edge or found.std.max() > 0.1


def test_at_the_end_of_the_grid_it_says_so() -> None:
    assert search_lags([grid((STEPS, STEPS, 0))]).at_edge


@pytest.mark.parametrize(("second", "near"), [(1.29, 1), (1.31, 0)])
def test_lags_that_miss_a_third_more_are_as_good(second: float, near: int) -> None:
    """One foot at five lags, of which the third is best; what it misses is a tone beside the predicted one.

    The deviation is that of the lags as good, about the best one, and of a step of the grid.
    """
    time = 0.05 * np.arange(240)
    tone, other = np.sin(2 * np.pi * 0.5 * time), np.sin(2 * np.pi * 0.75 * time)
    predicted = np.tile(tone[:, None], 6)
    missed = [0.5, 0.1 * np.sqrt(second), 0.1, 0.1 * np.sqrt(second), 0.6]
    measured = np.array([[np.tile((tone + one * other)[:, None], 6) for one in missed]])
    lags = np.array([-0.1, -0.05, 0.0, 0.05, 0.1])
    encoders = np.array([0.0, 0.05])  # of which nothing is told
    grid = LagGrid(np.array([predicted] * 2), np.array([measured] * 2), encoders, lags, 0.05)
    found = search_lags([grid])
    assert found.values[0] == 0.0
    assert found.missed[0] == pytest.approx(0.01)
    assert not found.at_edge
    spread = np.sqrt(2 * near * 0.05**2 / (1 + 2 * near))
    assert found.std[0] == pytest.approx(np.hypot(spread, 0.05 / np.sqrt(12)))
    assert found.power[0] == pytest.approx(1 / 1.01)


@pytest.mark.parametrize("late", [(0.012, -0.003), (-0.024, -0.024)])
def test_a_foot_late_by_less_than_a_step_of_the_grid_is_found_where_the_load_changes_feet(
    late: tuple[float, float],
) -> None:
    """Of feet that hand the weight to each other, whatever the encoders; what nobody told tells nothing."""
    time = PERIOD * np.arange(400)

    def tones(seed: int, at: Array) -> Array:
        random = np.random.default_rng(seed)
        hertz, phase = random.uniform(0.2, 1.0, (3, 6)), random.uniform(0, 2 * np.pi, (3, 6))
        return np.asarray(np.sin(2 * np.pi * hertz * at[:, None, None] + phase).sum(axis=1))

    def foot(sign: float, by: float) -> Array:
        own = [tones(0, time + lag - by) / 2 + sign * 3 * tones(1, time + lag - by) for lag in LAGS]
        return np.array(own)

    measured = np.array([foot(sign, by) for sign, by in zip((1, -1), late, strict=True)])
    hand = np.where(time[:, None] < 10, 30 * tones(2, time), 0.0)
    grids = [
        LagGrid(np.array([tones(0, time)] * 3), np.array([one] * 3), LAGS[:3], LAGS, PERIOD)
        for one in (measured, measured + hand / 2)
    ]
    found = search_lags(grids)
    np.testing.assert_allclose(found.values[:2], late, atol=0.003)


@pytest.mark.parametrize(
    ("samples", "found"),
    [(399, (1, 399)), (400, (1, 400)), (799, (1, 400)), (800, (2, 400)), (2010, (5, 400))],
)
def test_windows_last_four_seconds_or_as_long_as_there_is(samples: int, found: tuple[int, int]) -> None:
    grid = LagGrid(np.zeros((1, samples, 6)), np.zeros((1, 2, 1, samples, 6)), np.zeros(1), np.zeros(1), 0.01)
    assert _windows(grid) == found
