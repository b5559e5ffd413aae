"""How fast a sole moves over the floor: noise, drift and strain told apart, each with a deviation that holds."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.estimation.velocity_drift import Drift, fit_drift
from plantar.feet.exclusion import sole_velocity

PERIOD = 0.005
TIME = np.arange(12000) * PERIOD
STILL = np.zeros((TIME.size, 2))
NO_CAUSES = np.empty((0, TIME.size, 2))


def wandering(seed: int, wander: float, noise: float) -> tuple[np.ndarray, np.ndarray]:
    """A drift (N, 2) whose slope wanders by `wander` [m/s² in a second's root], and white noise of `noise` [m/s]."""
    random = np.random.default_rng(seed)
    slope = np.cumsum(random.normal(0, wander * np.sqrt(PERIOD), (TIME.size, 2)), axis=0)
    return np.cumsum(slope, axis=0) * PERIOD, random.normal(0, noise, (TIME.size, 2))


@pytest.mark.parametrize(("noise", "shaken"), [(0.0003, 0.0), (0.003, 0.0), (0.0003, 0.06)])
def test_the_slopes_wander_is_read_off_beside_noise_and_what_shaking_loses(
    noise: float, shaken: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A chest that shakes loses velocity between two samples and walks on from there."""
    told: list[float] = []

    def fitted(*given: object) -> Drift:
        told.append(float(given[4]))  # type: ignore[arg-type]
        return fit_drift(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(sole_velocity, "fit_drift", fitted)
    for seed in range(8):
        drift, white = wandering(seed, 0.01, noise)
        shaking = np.random.default_rng(seed + 99).normal(0, shaken, STILL.shape)
        lost = np.cumsum(np.random.default_rng(seed + 999).normal(0, shaken * PERIOD, STILL.shape), axis=0)
        sole_velocity._drift(drift + white + lost, NO_CAUSES, STILL[:, 0], shaking, PERIOD)
    assert np.median(told) == pytest.approx(0.01**2, rel=0.3)


def test_a_drifts_deviation_is_that_of_its_errors() -> None:
    """Neither noise nor wander is told: both are read off what is seen."""
    off = []
    for seed in range(6):
        drift, white = wandering(seed, 0.003, 0.002)
        value, deviation, told = sole_velocity._drift(drift + white, NO_CAUSES, STILL[:, 0], STILL, PERIOD)
        assert told == pytest.approx(0.002, rel=0.05)
        off.append((value - drift)[:-5] / deviation[:-5, None])
    # Two in five of the thinned samples are taken as new, as in a low-passed velocity; here each of them is.
    assert np.std(off) == pytest.approx(np.sqrt(0.4), rel=0.25)


def test_noise_and_drift_add_as_squares() -> None:
    """3, 4, 5: whatever moves, and where nothing is known."""
    for velocity in (STILL, STILL * np.nan):
        found = sole_velocity._deviation(velocity, 0.003, np.full(TIME.size, 0.004), np.zeros(TIME.size))
        assert found == pytest.approx(np.full(TIME.size, 0.005))


def test_strain_widens_where_the_velocity_is_off_under_it() -> None:
    """A tenth of the samples is strained at 4 m²/s⁴ and off by more: noise's square and a share of 4 add up to it."""
    strained = np.arange(TIME.size) > 0.9 * TIME.size
    speed, least = 0.02, 0.003
    velocity = np.where(strained, speed, 0.0)[:, None] * [0.6, -0.8]
    found = sole_velocity._deviation(velocity, least, STILL[:, 0], np.where(strained, 4.0, 0.0))
    assert found[~strained] == pytest.approx(least)
    # The median length of a plane vector whose components have deviation s is s √(2 ln 2).
    assert found[strained] == pytest.approx(speed / np.sqrt(2 * np.log(2)))


def test_the_mean_square_of_an_acceleration_counts_what_is_within_a_tenth_of_a_second() -> None:
    """One sample of 3, 4 m/s² beside a steady lean of the accelerometer: 25 over 41 samples, fewer at an end."""
    for place, count in ((5000, 41), (5, 26)):
        acceleration = STILL + [0.5, -0.2]
        acceleration[place] += [3.0, 4.0]
        found = sole_velocity._mean_square(acceleration, PERIOD)
        assert found[place] == pytest.approx(25 / count)
        assert found[place + 20] > 0 == found[place + 21]
        assert found[6000] == 0
    acceleration[8000] = np.nan
    assert sole_velocity._mean_square(acceleration, PERIOD)[9000] == 0


@pytest.mark.parametrize("heading", [0.0, 0.7, -2.0])
def test_a_bush_centre_that_is_too_high_moves_the_sole_as_a_lever_does(heading: float) -> None:
    """Along the turn's rate crossed with the vertical, in the world's axes."""
    rate = np.array([[0.3, 0.0], [0.0, 0.2], [np.nan, np.nan]])  # of pitch and roll
    bush = SimpleNamespace(heading=np.full(3, heading), rate=rate)
    forward, left = (
        np.array([np.cos(heading), np.sin(heading), 0]),
        np.array([-np.sin(heading), np.cos(heading), 0]),
    )
    by_pitch, by_roll = sole_velocity._moment_arm_errors(bush)  # type: ignore[arg-type]
    assert by_pitch[0] == pytest.approx(0.3 * np.cross(left, [0, 0, 1])[:2])
    assert by_roll[1] == pytest.approx(-0.2 * np.cross(forward, [0, 0, 1])[:2])
    assert not by_pitch[1:].any()
    assert not by_roll[[0, 2]].any()


def test_an_attitudes_noise_is_what_the_gyroscope_does_not_turn() -> None:
    """A lean about a tilted axis at 12 Hz that the gyroscope does not see, on a turn, slow and quick, that both see."""
    slow, quick = 0.3 * np.sin(0.5 * TIME) + 0.004 * np.sin(50 * TIME), 0.002 * np.sin(2 * np.pi * 12 * TIME)
    axis, z = np.array([0.6, 0.0, 0.8]), np.array([0, 0, 1.0])
    turn = np.column_stack([np.cos(slow / 2), np.sin(slow / 2)[:, None] * z])
    lean = np.column_stack([np.cos(quick / 2), np.sin(quick / 2)[:, None] * axis])
    w, v = lean[:, :1] * turn[:, :1] - lean[:, 1:] @ z[:, None] * turn[:, 3:], np.empty((TIME.size, 3))
    v[:] = lean[:, :1] * turn[:, 1:] + turn[:, :1] * lean[:, 1:] + np.cross(lean[:, 1:], turn[:, 1:])
    rates = (0.15 * np.cos(0.5 * TIME) + 0.2 * np.cos(50 * TIME))[:, None] * z
    found = sole_velocity._attitude_noise(np.hstack([w, v]), rates, PERIOD)
    inside = slice(200, -200)
    assert found[inside] == pytest.approx(quick[inside, None] * axis, abs=1e-4)


def test_a_sensor_has_some_noise_always() -> None:
    assert sole_velocity._drift(STILL, NO_CAUSES, STILL[:, 0], STILL, PERIOD)[2] == 0.0002


def test_what_moves_as_noise_does_is_as_unsure() -> None:
    velocity = np.random.default_rng(0).normal(0, 0.01, STILL.shape)
    found = sole_velocity._deviation(velocity, 0.003, STILL[:, 0], STILL[:, 0])
    assert found == pytest.approx(0.01, rel=0.03)
