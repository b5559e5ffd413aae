"""Clocks that run apart, seen in the halves of wrenches that are late by more and more."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.estimation.delay import Pair
from plantar.sensors.clock_drift import clock_drift
from plantar.signals.filters import differentiate, low_pass

PERIOD, SAMPLES = 0.01, 4000


def pair(share: float, seed: int) -> Pair:
    """A random wrench below 1.5 Hz whose sensor's clock is late by `share` of the time since the middle."""
    random = np.random.default_rng(seed)
    time = PERIOD * (np.arange(SAMPLES) - SAMPLES / 2)
    true = 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5)
    read = np.column_stack([np.interp(time * (1 - share), time, column) for column in true.T])
    measured = read + low_pass(random.standard_normal(read.shape), PERIOD, 8.0)
    return Pair("sweep", measured, differentiate(measured, PERIOD), true, PERIOD)


@pytest.mark.parametrize("share", [1e-3, -5e-4])
def test_a_clock_that_runs_apart_is_found(share: float) -> None:
    found = clock_drift([pair(share, 1), pair(share, 2)])
    assert found is not None
    assert found.share == pytest.approx(share, rel=0.15)
    assert found.duration == pytest.approx(40.0, abs=0.1)
    assert found.std == pytest.approx(abs(found.share) * 40 / np.sqrt(12), rel=0.01)
    assert f"{abs(1e3 * found.share * 40):.0f} ms" in found.note.text


def test_clocks_that_agree_are_left_alone() -> None:
    assert clock_drift([pair(0.0, seed) for seed in range(4)]) is None
    assert clock_drift([]) is None
