"""Deviations of what stands beside the values: offsets, delays. Too small, they make intervals that do not hold."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.estimation.delays.delay import Delay, Pair, estimate_delay
from plantar.estimation.delays.sensor_delays import Balance, estimate_delays
from plantar.estimation.least_squares import Block, fit_linear
from plantar.estimation.residual_covariance import cosine_covariance
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.resampling import interpolate

PERIOD, SAMPLES = 0.005, 6000
INNER = slice(100, -100)


def recording(label: str, rows: int, seed: int) -> Block:
    """Angle and rate with a mean of their own, and torque with white noise."""
    random = np.random.default_rng(seed)
    regressor = random.normal(size=(rows, 2)) * [0.02, 0.1] + random.normal(size=2) * [0.02, 0.1]
    response = regressor @ [400.0, 20.0] + random.normal() + 0.5 * random.normal(size=rows)
    return Block(label, regressor, response, 0.01)


def test_offsets_of_recordings_of_unequal_length_have_their_own_deviations() -> None:
    """Against the sandwich of the stacked problem with a column of ones for each recording."""
    lengths = {"long": 6000, "short": 250, "middle": 1500}
    blocks = [recording(label, rows, seed) for seed, (label, rows) in enumerate(lengths.items())]
    fit = fit_linear(blocks)
    designs = [
        np.column_stack([block.regressor, np.tile(row, (len(block.response), 1))])
        for block, row in zip(blocks, np.eye(3), strict=True)
    ]
    inverse = np.linalg.inv(sum(design.T @ design for design in designs))
    solution = inverse @ sum(design.T @ block.response for design, block in zip(designs, blocks, strict=True))
    middle = np.zeros((5, 5))
    for design, block in zip(designs, blocks, strict=True):
        scores = design * (block.response - design @ solution)[:, None]
        middle += cosine_covariance(scores, len(scores) * block.period)[0]
    expected = np.sqrt(np.diag(inverse @ middle @ inverse))
    np.testing.assert_allclose(fit.std, expected[:2], rtol=1e-8)
    np.testing.assert_allclose([fit.offset_std(label) for label in lengths], expected[2:], rtol=1e-8)
    assert expected[3] > 2 * expected[2], "the short recording tells less of its zero"


def late(values: Array, delay: float) -> Array:
    """Values (n, k) as a sensor reports them that is late by `delay` [s]."""
    time: Array = PERIOD * np.arange(len(values), dtype=np.float64)
    return np.nan_to_num(np.column_stack([interpolate(time - delay, time, one, 1.0) for one in values.T]))


def axes_late_by(delays: Array, seed: int) -> Pair:
    """A random wrench below 3 Hz, each axis measured late by a delay of its own."""
    random = np.random.default_rng(seed)
    true = 300 * low_pass(random.standard_normal((SAMPLES, 6)), PERIOD, 3.0)
    shifted = np.hstack([late(column[:, None], delay) for column, delay in zip(true.T, delays, strict=True)])
    measured = low_pass(shifted + 0.1 * random.standard_normal(shifted.shape), PERIOD, 8.0)
    rate, predicted = differentiate(measured, PERIOD), low_pass(true, PERIOD, 8.0)
    return Pair("sweep", measured[INNER], rate[INNER], predicted[INNER], PERIOD)


def test_axes_that_disagree_about_a_delay_make_it_less_sure() -> None:
    """A wrong URDF or mount shows as another delay on each axis; within each there is hardly any noise."""
    together, apart = np.full(6, 0.005), np.array([0.001, 0.009, 0.001, 0.009, 0.001, 0.009])
    agreed, disputed = (estimate_delay([axes_late_by(delays, 1)]) for delays in (together, apart))
    assert isinstance(agreed, Delay)
    assert isinstance(disputed, Delay)
    assert agreed.value == pytest.approx(0.005, abs=4e-4)
    # Six draws of a delay, 4 ms from their mean, whatever the number of bands.
    assert disputed.std > 4 * agreed.std
    assert disputed.std > 0.25 * 0.004 / np.sqrt(6)
    assert abs(disputed.value - 0.005) < 4 * disputed.std


def balance(seed: int, *, missed: float = 0.0, delay: float = 0.0, samples: int = SAMPLES) -> Balance:
    """Two feet, both late by `delay` [s], and a prediction that misses a share of each axis slowly, as a wrong URDF."""
    random = np.random.default_rng(seed)
    load, share, between, wrong = (
        300 * low_pass(random.standard_normal((samples, 6)), PERIOD, 1.5) for _ in range(4)
    )
    feet = [load / 2 + share + between, load / 2 - share - between]
    readings = [
        low_pass(late(foot, delay) + random.standard_normal(foot.shape), PERIOD, 8.0) for foot in feet
    ]
    rates = np.array([differentiate(reading, PERIOD) for reading in readings])[:, INNER]
    predicted = low_pass(load + missed * wrong, PERIOD, 8.0)[INNER]
    return Balance(predicted, np.array(readings)[:, INNER], rates, PERIOD)


def test_a_wrong_model_does_not_make_delays_surer_than_they_are() -> None:
    """Samples of one band err together: deviations for white residuals would be several times too small."""
    found = [estimate_delays([balance(seed, missed=0.1)]) for seed in range(24)]
    far = np.concatenate([one.values / np.sqrt(np.diag(one.covariance)) for one in found if one is not None])
    assert len(far) == 2 * len(found)
    assert 0.6 < np.sqrt(np.mean(far**2)) < 1.7


def test_a_short_recording_counts_less_than_a_long_one() -> None:
    """Beside one of 100 s without delay, one of 15 s in which both feet are 6 ms late, as noisy."""
    long, short = balance(11, samples=20_000, missed=0.1), balance(21, samples=3000, missed=0.1, delay=0.006)
    found = estimate_delays([long, short])
    assert found is not None
    assert 0 < found.values.mean() < 0.002, (
        "about a seventh of 6 ms; evenly weighed it would be more than half"
    )
