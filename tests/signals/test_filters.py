"""Signals: filtering without lag, gaps that stay gaps, delays undone."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from plantar.signals.filters import (
    differentiate,
    gain,
    low_pass,
)

PADDED = 3.0

PERIOD = 0.005

TIME = np.arange(4000) * PERIOD


def tone(hertz: float, phase: float = 0.0, time: np.ndarray = TIME) -> np.ndarray:
    return np.sin(2 * np.pi * hertz * time + phase)


@pytest.mark.parametrize("hertz", [0.2, 1.0, 3.0])
def test_the_filter_has_no_lag(hertz: float) -> None:
    middle = slice(500, -500)
    filtered = low_pass(tone(hertz), PERIOD, 5.0)[middle]
    in_phase = filtered @ tone(hertz)[middle]
    quadrature = filtered @ tone(hertz, np.pi / 2)[middle]
    assert abs(quadrature / in_phase) < 1e-3


def test_the_filter_keeps_slow_and_removes_fast() -> None:
    middle = slice(500, -500)
    slow = low_pass(tone(0.5), PERIOD, 5.0)[middle]
    np.testing.assert_allclose(slow, tone(0.5)[middle], atol=1e-5)
    assert np.abs(low_pass(tone(20.0), PERIOD, 5.0)[middle]).max() < 1e-4
    half = np.abs(low_pass(tone(5.0), PERIOD, 5.0)[middle]).max()
    assert half == pytest.approx(0.5, abs=0.01), "forth and back: -6 dB at the cutoff"


@pytest.mark.parametrize("hertz", [2.0, 5.0, 8.0, 20.0])
def test_the_gain_is_what_is_left_of_a_tone(hertz: float) -> None:
    middle = slice(1000, -1000)
    left = np.std(low_pass(tone(hertz), PERIOD, 5.0)[middle]) / np.std(tone(hertz)[middle])
    assert left == pytest.approx(float(gain(np.array([hertz]), PERIOD, 5.0)[0]), rel=1e-3, abs=1e-7)


@pytest.mark.parametrize(
    ("cutoff", "rows", "columns"),
    [(0.8, 1500, 1), (5.0, 1500, 3), (40.0, 1500, 11), (5.0, 40_000, 3), (2.0, 9000, 70)],
)
def test_the_filter_is_scipys_of_the_same_name(cutoff: float, rows: int, columns: int) -> None:
    """Fourth order forth and back, continued point-symmetrically, each way begun in its settled state."""
    values = np.cumsum(np.random.default_rng(1).normal(size=(rows, columns)), axis=0)
    sections = butter(4, 2 * cutoff * PERIOD, output="sos")
    expected = sosfiltfilt(sections, values, axis=0, padtype="odd", padlen=int(PADDED / cutoff / PERIOD))
    np.testing.assert_allclose(low_pass(values, PERIOD, cutoff), expected, atol=1e-10 * np.ptp(values))


def test_a_line_stays_a_line_in_runs_far_shorter_than_the_filter() -> None:
    line = 3.0 - 2.0 * TIME[:12]
    np.testing.assert_allclose(low_pass(line, PERIOD, 1.0, shortest=8), line, atol=1e-3)


def test_the_filter_is_linear_and_keeps_constants() -> None:
    """So a law between signals is a law between filtered signals, edges included."""
    random = np.random.default_rng(0)
    a, b = random.normal(size=(2, 1000))
    both = low_pass(3 * a - 2 * b + 7, PERIOD, 5.0)
    np.testing.assert_allclose(
        both, 3 * low_pass(a, PERIOD, 5.0) - 2 * low_pass(b, PERIOD, 5.0) + 7, atol=1e-12
    )


def test_the_filter_treats_each_run_by_itself() -> None:
    values = tone(0.5)
    values[1000:1200] = np.nan
    filtered = low_pass(values, PERIOD, 5.0)
    assert np.isnan(filtered[1000:1200]).all()
    np.testing.assert_allclose(filtered[:1000], low_pass(values[:1000], PERIOD, 5.0))
    np.testing.assert_allclose(filtered[1200:], low_pass(values[1200:], PERIOD, 5.0))
    np.testing.assert_allclose(filtered[100:900], tone(0.5)[100:900], atol=1e-3)


def test_runs_too_short_to_filter_become_nan() -> None:
    values = tone(0.5)
    values[100:200] = np.nan
    values[210:300] = np.nan
    filtered = low_pass(values, PERIOD, 5.0)
    assert np.isnan(filtered[100:300]).all()
    assert np.isfinite(filtered[300:]).all()


def test_columns_are_filtered_together_and_nan_spreads_over_them() -> None:
    pair = np.column_stack([tone(0.5), tone(0.9)])
    pair[50, 1] = np.nan
    filtered = low_pass(pair, PERIOD, 5.0)
    assert filtered.shape == pair.shape
    assert np.isnan(filtered[50]).all()


def test_a_cutoff_above_nyquist_changes_nothing() -> None:
    noise = np.random.default_rng(0).normal(size=500)
    np.testing.assert_array_equal(low_pass(noise, PERIOD, 100.0), noise)


def test_differences_of_a_parabola() -> None:
    slope = differentiate(TIME**2, PERIOD)
    np.testing.assert_allclose(slope[1:-1], 2 * TIME[1:-1], atol=1e-10)
    assert differentiate(np.array([1.0]), PERIOD).shape == (1,)


@pytest.mark.parametrize("every", [1, 2, 7, 400, 5000])
@pytest.mark.parametrize("holes", [False, True])
def test_every_nth_sample_is_that_of_the_whole_signal(every: int, holes: bool) -> None:
    values = np.random.default_rng(3).standard_normal((4001, 5))
    if holes:
        values[1000:1040] = np.nan
    whole = low_pass(values, PERIOD, 5.0)
    np.testing.assert_array_equal(low_pass(values, PERIOD, 5.0, every=every), whole[::every])
    np.testing.assert_array_equal(low_pass(values[:, 0], PERIOD, 5.0, every=every), whole[::every, 0])
    np.testing.assert_array_equal(low_pass(values, PERIOD, 1e6, every=every), values[::every])
