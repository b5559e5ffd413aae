"""Bands of a balance: read later by their rates as if the sensors had been, and each half as if recorded alone."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.estimation.delays.bands import HALVES, Band, bands_of
from plantar.signals.filters import differentiate

PERIOD, SAMPLES = 0.02, 3000
LATE = np.array([0.8e-3, -0.5e-3, 1.0e-3])  # s: two sensors, and what moves half of the prediction


def bands(late: Array, samples: int = SAMPLES) -> list[Band]:
    """A balance of tones with sensors read `late` (3,) [s] later than recorded, and two models that are wrong."""
    phase = np.arange(6)

    def tones(hertz: float, moment: float) -> Array:
        time = (PERIOD * np.arange(samples) + moment)[:, None]
        slow, fast = (np.sin(2 * np.pi * tone * time + phase) for tone in (hertz, 4.7 * hertz))
        return np.asarray(slow + 0.3 * fast)

    def predicted(moment: float) -> Array:
        return 100 * tones(0.55, 0.0) + 80 * tones(0.97, moment)

    measured = np.array([60 * tones(0.55, late[0]), 30 * tones(0.71, late[1])])
    rates = np.array([differentiate(one, PERIOD) for one in measured])
    step = 1e-4
    by_encoders = (predicted(late[2] - step) - predicted(late[2] + step)) / (2 * step)
    errors = np.array([5 * tones(0.63, 0.0), 3 * tones(1.1, 0.0)])
    return bands_of(predicted(late[2]), measured, np.array([*rates, by_encoders]), PERIOD, errors)


@pytest.mark.parametrize("name", ["signals", "rates", "by_rate"])
def test_sensors_read_later_by_their_rates_are_those_read_anew(name: str) -> None:
    missed = moved = 0.0  # of all bands: in one without a tone is only what filters leak of others
    for recorded, anew in zip(bands(np.zeros(3)), bands(LATE), strict=True):
        before, expected, found = (getattr(one, name) for one in (recorded, anew, recorded.read_later(LATE)))
        if name == "rates":  # of what grows with a delay, which stays as it is
            before, expected, found = before[:, :1], expected[:, :1], found[:, :1]
        if name == "by_rate":
            before, expected, found = before[..., :1, :], expected[..., :1, :], found[..., :1, :]
        if name == "signals":
            # The prediction, the sensors' difference, and what is missing.
            places = np.array([0, 1, recorded.signals.shape[1] - 1])
            before, expected, found = (some[..., places, :] for some in (before, expected, found))
        missed += float(np.sum((found - expected) ** 2))
        moved += float(np.sum((expected - before) ** 2))
    assert missed < 0.05**2 * moved


def test_products_are_those_of_the_signals_read_later() -> None:
    for band in bands(np.zeros(3)):
        later = band.read_later(LATE)
        own = later.signals @ later.signals.transpose(0, 2, 1)
        count = own.shape[-1]
        np.testing.assert_allclose(later.products.sum(axis=0)[:, :count, :count], own, rtol=1e-9, atol=1e-6)


def test_halves_are_as_far_from_the_middle_as_from_their_ends_where_these_leave_enough() -> None:
    """Of 60 s a band from 0.4 Hz loses 5 s at either end, one from 0.15 Hz 13.3 s, and 7.5 s beside the middle."""
    all_bands = bands(np.zeros(3))
    assert len(all_bands) == 5
    for whole, end, near in zip(
        all_bands, [13.3, 5.0, 2.5, 1.25, 0.625], [7.5, 5.0, 2.5, 1.25, 0.625], strict=True
    ):
        halves = [whole.half(place) for place in HALVES]
        for half in halves:
            assert half is not None
            assert half.duration == pytest.approx(30 - end - near, abs=3 * half.step)
            own = half.signals @ half.signals.transpose(0, 2, 1)
            count = own.shape[-1]
            np.testing.assert_allclose(half.products[0, :, :count, :count], own, rtol=1e-12, atol=1e-9)
        first, second = halves
        assert first is not None
        assert second is not None
        np.testing.assert_array_equal(whole.signals[..., : first.size], first.signals)
        np.testing.assert_array_equal(whole.signals[..., -second.size :], second.signals)


def test_of_a_short_recording_only_quick_bands_have_halves() -> None:
    """Of 8 s a half keeps 1 s of the three slow bands, a quarter to four fifths of an independent pair of values."""
    kept = [band.half(HALVES[0]) is not None for band in bands(np.zeros(3), round(8 / PERIOD))]
    assert kept == [False, False, False, True, True]
