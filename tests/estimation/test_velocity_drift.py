"""The drift of an integrated velocity: told from slides, across jumps, with its deviation."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.estimation.velocity_drift import fit_drift

PERIOD, NOISE, WANDER = 0.02, 0.0005, 0.001**2
TIME = np.arange(1500) * PERIOD
NO_COLUMNS = np.empty((0, TIME.size, 2))


def scene(seed: int, struck: tuple[float, ...] = ()) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A drift (n, 2) with a slope that wanders and jumps of 30 mm/s at `struck` [s]; noise; variance of the steps."""
    random = np.random.default_rng(seed)
    slope = 0.02 + np.cumsum(random.normal(0, np.sqrt(WANDER * PERIOD), (TIME.size, 2)), axis=0)
    jump = np.full(TIME.size, 1e-10)
    for second in struck:
        jump[int(second / PERIOD)] = 0.03**2
    step = random.normal(0, 1, (TIME.size, 2)) * np.sqrt(jump)[:, None]
    drift = np.cumsum(slope * PERIOD + step, axis=0)
    return drift, random.normal(0, NOISE, drift.shape), jump


def sliding(start: float, end: float, speed: float) -> np.ndarray:
    return np.where((start <= TIME) & (end > TIME), speed, 0.0)[:, None] * np.array([0.6, -0.8])


def fitted(
    velocity: np.ndarray, jump: np.ndarray, columns: np.ndarray = NO_COLUMNS
) -> tuple[np.ndarray, np.ndarray]:
    still = np.zeros(TIME.size)
    found = fit_drift(velocity, columns, still, jump, WANDER, NOISE, 1.0, PERIOD)
    return found.value, found.deviation


def test_the_deviation_is_that_of_the_errors() -> None:
    shares = []
    for seed in range(12):
        drift, noise, jump = scene(seed)
        value, deviation = fitted(drift + noise, jump)
        shares.append((value - drift) / deviation[:, None])
    assert np.std(shares) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(
    ("start", "end", "speed"), [(10, 11.5, 0.02), (10, 13, 0.05), (29, 30, 0.03), (0, 0.5, 0.02)]
)
def test_a_slide_is_no_drift(start: float, end: float, speed: float) -> None:
    """In the middle as well as where the log begins or ends."""
    drift, noise, jump = scene(1)
    value, deviation = fitted(drift + noise + sliding(start, end, speed), jump)
    assert np.all(np.abs(value - drift) < 4.5 * deviation[:, None])
    assert deviation.max() < 0.002


def test_a_slide_that_ends_in_an_impact_is_told_from_the_jump() -> None:
    drift, noise, jump = scene(3, struck=(10.5,))
    value, _ = fitted(drift + noise + sliding(10.0, 10.5, 0.04), jump)
    assert np.abs(value - drift)[TIME < 10.4].max() < 0.002
    assert np.abs(value - drift)[TIME > 10.6].max() < 0.002


def test_what_is_known_to_move_is_no_drift_however_long() -> None:
    """A slide of seconds at an even speed, which only another witness tells from a jump of the drift."""
    drift, noise, jump = scene(4, struck=(5.0, 25.0))
    slide = sliding(5.02, 25.02, 0.03)
    columns, unrest = NO_COLUMNS, 100.0 * (slide[:, 0] > 0)
    arguments = (jump, WANDER, NOISE, 1.0, PERIOD)
    blind = fit_drift(drift + noise + slide, columns, np.zeros(TIME.size), *arguments).value
    told = fit_drift(drift + noise + slide, columns, unrest, *arguments).value
    off = np.abs(told - drift)[(TIME < 5) | (TIME > 25.1)]
    assert off.max() < 0.002
    assert np.abs(blind - drift)[TIME > 6].max() > 0.01


def test_causes_of_constant_size_are_taken_off() -> None:
    drift, noise, jump = scene(5)
    cause = np.sin(2 * np.pi * 0.4 * TIME)[:, None] * np.array([1.0, 0.3])
    idle = np.zeros_like(cause)
    value, _ = fitted(drift + noise + 0.02 * cause, jump, np.array([cause, idle, cause]))
    assert np.abs(value - drift - 0.02 * cause).max() < 0.001


def test_where_nothing_is_seen_the_drift_goes_on() -> None:
    drift, noise, jump = scene(6)
    velocity = drift + noise
    velocity[(TIME > 10) & (TIME < 11)] = np.nan
    value, deviation = fitted(velocity, jump)
    assert np.all(np.abs(value - drift) < 4.5 * deviation[:, None])
    assert deviation[TIME.searchsorted(10.5)] > 2 * deviation[TIME.searchsorted(20.0)]


def test_what_a_velocity_shows_counts_as_unrest_of_the_same_square() -> None:
    """To and fro by five deviations on both axes, about a drift that is known: as unrest of their mean square."""
    swing = 5 * NOISE * np.where(np.arange(TIME.size) % 2, 1.0, -1.0)[:, None] * np.ones(2)
    arguments = (np.zeros(TIME.size), WANDER, NOISE, 1.0, PERIOD)
    shown = fit_drift(swing, NO_COLUMNS, np.zeros(TIME.size), *arguments).deviation
    told = fit_drift(np.zeros_like(swing), NO_COLUMNS, np.full(TIME.size, 25.0), *arguments).deviation
    calm = fit_drift(np.zeros_like(swing), NO_COLUMNS, np.zeros(TIME.size), *arguments).deviation
    middle = slice(200, -200)
    np.testing.assert_allclose(shown[middle], told[middle], rtol=0.02)
    assert np.all(told > 1.3 * calm)


def test_samples_that_repeat_each_other_weigh_as_their_independent_share() -> None:
    """A quarter of them: as so many of twice the noise."""
    rest, still = np.zeros((TIME.size, 2)), np.zeros(TIME.size)
    repeated = fit_drift(rest, NO_COLUMNS, still, still, WANDER, NOISE, 0.25, PERIOD).deviation
    noisier = fit_drift(rest, NO_COLUMNS, still, still, WANDER, 2 * NOISE, 1.0, PERIOD).deviation
    np.testing.assert_allclose(repeated, noisier, rtol=1e-9)


def test_of_what_is_never_seen_only_a_robots_speed_is_known() -> None:
    """A meter a second and 0.3 m/s² of slope, at first; both go on."""
    still = np.zeros(TIME.size)
    deviation = fit_drift(
        np.full((TIME.size, 2), np.nan), NO_COLUMNS, still, still, WANDER, NOISE, 1.0, PERIOD
    ).deviation
    np.testing.assert_allclose(deviation, np.hypot(1.0, 0.3 * TIME), rtol=0.01)
