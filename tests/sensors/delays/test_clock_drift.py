"""Clocks that run apart, within a log and from log to log: wrenches late by more and more, or each otherwise."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.estimation.delays.delay import Delay, Pair
from plantar.sensors.delays.clock_drift import clock_drift
from plantar.sensors.delays.delays_by_log import delays_by_log
from plantar.signals.filters import differentiate, low_pass

PERIOD, SAMPLES = 0.01, 4000


def pair(share: float, seed: int, late: float = 0.0, noise: float = 1.0) -> Pair:
    """A random wrench below 1.5 Hz, read `late` [s] and by a `share` of the time since the middle later."""
    random = np.random.default_rng(seed)
    time = PERIOD * (np.arange(SAMPLES) - SAMPLES / 2)
    true = 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 1.5)
    read = np.column_stack([np.interp(time * (1 - share) - late, time, column) for column in true.T])
    measured = read + noise * low_pass(random.standard_normal(read.shape), PERIOD, 8.0)
    return Pair(f"sweep_{seed}", measured, differentiate(measured, PERIOD), true, PERIOD)


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


@pytest.mark.parametrize(("milliseconds", "told"), [(1.5, False), (2.5, True)])
def test_two_milliseconds_from_the_middle_to_an_end_matter(milliseconds: float, told: bool) -> None:
    """However surely less is seen: here without noise, of 40 s."""
    share = 1e-3 * milliseconds / 20
    assert (clock_drift([pair(share, seed, noise=0.01) for seed in range(4)]) is not None) is told


def test_logs_with_delays_of_their_own_are_told_with_each() -> None:
    """Read 10 ms later than recorded, as is right for none of them."""
    found = delays_by_log([pair(0.0, 1, 0.01), pair(0.0, 2, -0.01), pair(0.0, 3)], 0.01)
    assert found is not None
    assert found.by_log == pytest.approx({"sweep_1": 0.02, "sweep_2": 0.0, "sweep_3": 0.01}, abs=1e-3)
    assert found.std == pytest.approx(0.01, rel=0.1)
    assert "sweep_1 +20" in found.note.text


def test_logs_with_one_delay_and_a_single_log_say_nothing() -> None:
    assert delays_by_log([pair(0.0, seed, 0.02) for seed in range(4)], 0.0) is None
    assert delays_by_log([pair(0.0, 1, 0.002), pair(0.0, 2)], 0.0) is None, "too little to matter"
    assert delays_by_log([pair(0.0, 1, 0.02)], 0.0) is None


@pytest.mark.parametrize(("freedom", "apart", "told"), [
    (1e6, 4.9, False), (1e6, 5.1, True),
    # Student's 97.5 % with 4 degrees of freedom lies at 2.776, the normal distribution's at 1.960.
    (4.0, 5.1, False), (4.0, 0.99 * 5 * 2.776 / 1.960, False), (4.0, 1.01 * 5 * 2.776 / 1.960, True),
])  # fmt: skip
def test_a_deviation_of_few_values_reaches_further(
    monkeypatch: pytest.MonkeyPatch, freedom: float, apart: float, told: bool
) -> None:
    """A slow log of a light robot seemed 27 ± 5 ms late, by three bands of two waves each."""
    delays = {"slow": Delay(0.005 * apart, 0.005, freedom, 3), "quick": Delay(0.0, 1e-9, 40.0, 14)}
    monkeypatch.setattr(
        "plantar.sensors.delays.delays_by_log.estimate_delay", lambda own: delays[own[0].label]
    )
    pairs = [Pair(label, *np.zeros((3, 1, 6)), PERIOD) for label in delays]
    assert (delays_by_log(pairs, 0.0) is not None) == told


@pytest.mark.parametrize(("freedom", "times", "told"), [
    (1e6, 3.9, False), (1e6, 4.1, True), (4.0, 4.1, False), (4.0, 4.1 * 2.776 / 1.960, True),
])  # fmt: skip
def test_halves_of_few_values_differ_by_chance(
    monkeypatch: pytest.MonkeyPatch, freedom: float, times: float, told: bool
) -> None:
    """Two halves, each known to 5 ms: their difference to √2 times that."""
    halves = iter([Delay(0.0, 0.005, freedom, 3), Delay(np.sqrt(2) * 0.005 * times, 0.005, freedom, 3)])
    monkeypatch.setattr("plantar.sensors.delays.clock_drift.delay_in", lambda _: next(halves))
    assert (clock_drift([pair(0.0, 1)]) is not None) == told
