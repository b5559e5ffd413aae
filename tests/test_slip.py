"""Sliding soles are seen, noise and standing are not called sliding."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.slip import sliding

PERIOD = 0.005
TIME = np.arange(4000) * PERIOD
BOTH = np.ones(TIME.size, dtype=bool)


def apart(distance: float, start: float = 8.0, end: float = 8.3) -> np.ndarray:
    """A distance that grows smoothly by `distance` [m] between `start` and `end` [s]."""
    share = np.clip((TIME - start) / (end - start), 0, 1)
    return distance * share**2 * (3 - 2 * share)


def noise(size: float, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(0, size, (TIME.size, 2))


@pytest.mark.parametrize("distance", [0.003, -0.01])
def test_a_slide_is_found_where_it_is(distance: float) -> None:
    position = noise(1e-5) + np.column_stack([apart(distance), np.zeros(TIME.size)])
    found = sliding(position, np.zeros(TIME.size), BOTH, PERIOD)
    assert found[(TIME > 8.05) & (TIME < 8.25)].all()
    assert not found[(TIME < 7.7) | (TIME > 8.6)].any()


def test_a_twist_is_a_slide_too_and_full_turns_of_yaw_are_not() -> None:
    still = noise(1e-5)
    twist = apart(np.radians(4))
    assert sliding(still, twist, BOTH, PERIOD)[(TIME > 8.1) & (TIME < 8.2)].all()
    wrapped = np.mod(3.13 + noise(0.02, 1)[:, 0] * 0.1 + np.pi, 2 * np.pi) - np.pi
    assert not sliding(still, wrapped, BOTH, PERIOD).any()


@pytest.mark.parametrize("size", [0.0, 1e-5, 3e-4])
def test_noise_and_slow_drift_are_no_slide(size: float) -> None:
    position = noise(size) + np.column_stack([1e-4 * TIME, 5e-4 * np.sin(TIME)])
    assert not sliding(position, noise(size, 1)[:, 0], BOTH, PERIOD).any()


def test_nothing_slides_but_in_double_support() -> None:
    position = noise(1e-5) + np.column_stack([apart(0.2), np.zeros(TIME.size)])
    single = (TIME < 7.5) | (TIME > 9.0)
    assert not sliding(position, np.zeros(TIME.size), single, PERIOD).any()
    assert not sliding(position, np.zeros(TIME.size), np.zeros(TIME.size, dtype=bool), PERIOD).any()
