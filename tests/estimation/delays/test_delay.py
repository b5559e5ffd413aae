"""How late one signal is against another: found whatever its sign, and not claimed where somebody pushes."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.estimation.delays.delay import Delay, Pair, closes, estimate_delay
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import interpolate

PERIOD = 0.005

SAMPLES = 8000


def late_pair(delay: float, seed: int, push: float = 0.0, highest: float = 1.5) -> Pair:
    """A random wrench below `highest` [Hz], measured `delay` late, noise on both sides; `push`: an operator's share."""
    random = np.random.default_rng(seed)
    time = PERIOD * np.arange(SAMPLES)
    true = 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, highest)
    hand = push * 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, highest)
    late = np.nan_to_num(
        np.column_stack([interpolate(time - delay, time, column, 1.0) for column in (true + hand).T])
    )
    measured = low_pass(late + random.standard_normal(late.shape), PERIOD, 8.0)
    predicted = low_pass(true + random.standard_normal(true.shape), PERIOD, 8.0)
    rate = differentiate(measured, PERIOD)
    return Pair("sweep", measured[100:-100], rate[100:-100], predicted[100:-100], PERIOD)


@pytest.mark.parametrize("delay", [-0.02, 0.0, 0.004, 0.02])
def test_a_delay_is_found_whatever_its_sign(delay: float) -> None:
    found = [estimate_delay([late_pair(delay, seed)]) for seed in range(6)]
    assert all(each is not None for each in found)
    values = np.array([each.value for each in found if each is not None])
    claimed = np.array([each.std for each in found if each is not None])
    assert abs(values - delay).max() < 0.0015
    assert np.mean(abs(values - delay) < 2.2 * claimed) >= 0.75
    assert claimed.max() < 0.001


def test_a_delay_of_a_quick_motion_is_found_to_second_order() -> None:
    """In a tenth of a period a signal bends: by its rate alone it would come out 1.3 ms too late, and less sure."""
    found = estimate_delay([late_pair(0.02, 0, highest=5.0)])
    assert found is not None
    assert abs(found.value - 0.02) < 0.0008
    assert found.std < 0.0001


def test_nothing_is_claimed_where_somebody_pushes() -> None:
    assert estimate_delay([late_pair(0.005, 1, push=0.6)]) is None


def turning(delay: float, seed: int) -> Pair:
    """Sensors that turn by a degree or two under a weight of 560 N, and what they read is late."""
    random = np.random.default_rng(seed)
    time = PERIOD * np.arange(SAMPLES)
    angle, push = low_pass(random.standard_normal((SAMPLES, 2)), PERIOD, 1.5).T * [[0.1], [30.0]]
    ground = np.column_stack([push + 300 * angle, np.zeros(SAMPLES), np.full(SAMPLES, 560.0)])

    def turned(vectors: Array, sense: float) -> Array:
        cos, sin = np.cos(angle), sense * np.sin(angle)
        x, y, z = vectors.T
        return np.column_stack([cos * x + sin * z, y, cos * z - sin * x])

    readings = turned(ground, -1.0)
    late = np.column_stack(
        [np.nan_to_num(interpolate(time - delay, time, column, 1.0), nan=1.0) for column in readings.T]
    )
    still = np.zeros((SAMPLES, 3))
    inner = slice(100, -100)
    measured, rate = turned(late, 1.0), differentiate(late, PERIOD)
    pair = [np.hstack([part, still])[inner] for part in (measured, turned(rate, 1.0), ground)]
    mean = [part - part.mean(axis=0) for part in pair]
    return Pair("turning", mean[0], mean[1], mean[2], PERIOD)


@pytest.mark.parametrize("delay", [-0.01, 0.01, 0.02])
def test_the_frame_of_a_turning_sensor_is_not_late(delay: float) -> None:
    found = estimate_delay([turning(delay, 3)])
    assert isinstance(found, Delay)
    assert found.value == pytest.approx(delay, abs=3e-4)


def test_no_delay_is_claimed_beyond_what_delays_are() -> None:
    assert estimate_delay([late_pair(0.2, 0)]) is None


def tone(frequency: float, delay: float = 0.0) -> Pair:
    """A sine without noise on each axis, measured `delay` late."""
    time = PERIOD * np.arange(SAMPLES)
    phases = np.arange(6)
    predicted, measured = (
        300 * np.sin(2 * np.pi * frequency * (time - late)[:, None] + phases) for late in (0.0, delay)
    )
    return Pair("tone", measured, differentiate(measured, PERIOD), predicted, PERIOD)


@pytest.mark.parametrize("frequency", [0.2, 0.25, 0.3])
def test_a_slow_tone_is_not_outvoted_by_what_the_ends_leave_in_fast_bands(frequency: float) -> None:
    """Both sides end at the same moment, whatever the delay: what a filter makes of an end reads as no delay."""
    found = estimate_delay([tone(frequency, 0.004)])
    assert isinstance(found, Delay)
    assert found.value == pytest.approx(0.004, abs=1e-5)


@pytest.mark.parametrize("frequency", [0.6, 1.2])
def test_without_noise_a_model_is_trusted_to_three_thousandths(frequency: float) -> None:
    """An error of that share of the amplitude, a quarter of a period off, looks like a delay of as much over ω."""
    found = estimate_delay([tone(frequency, 0.004)])
    assert isinstance(found, Delay)
    assert found.value == pytest.approx(0.004, abs=1e-5)
    least = 0.003 / (2 * np.pi * frequency) / np.sqrt(found.cells)
    assert 0.95 * least < found.std < 1.5 * least  # the ends of the recording add a little


def test_a_pair_that_only_a_delay_of_half_a_second_would_close_does_not() -> None:
    """So slow that half a second is a small step along its rate: no sensor is as late, something else is wrong."""
    assert closes(tone(0.15, 0.03))
    assert not closes(tone(0.15, 0.5))


def test_a_pair_that_a_delay_closes_does() -> None:
    """A tenth of its squares is missed as it is, and hardly any along its rate."""
    assert closes(tone(1.2, 0.045))
    assert closes(tone(1.2, -0.045))


def test_a_delay_of_little_freedom_is_as_wide_as_student_says() -> None:
    """At 97.5 %: 4.303 with two degrees of freedom, 1.960 with endless."""
    assert Delay(0.0, 0.002, 2.0, 3).wide_std == pytest.approx(0.002 * 4.3027 / 1.95996, rel=1e-4)
    assert Delay(0.0, 0.002, np.inf, 3).wide_std == pytest.approx(0.002, rel=1e-4)
