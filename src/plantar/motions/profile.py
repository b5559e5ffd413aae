"""Displacements over time: smooth starts and ends, sways and sweeps."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array


def smooth_step(phase: Array) -> Array:
    """0 below 0, 1 above 1, with two continuous derivatives in between (quintic)."""
    s = np.clip(phase, 0.0, 1.0)
    return np.asarray(s**3 * (10 + s * (6 * s - 15)))


def window(time: Array, start: float, end: float, ramp: float) -> Array:
    """1 between `start` and `end` [s], rising and falling over `ramp` [s] inside them."""
    return smooth_step((time - start) / ramp) * smooth_step((end - time) / ramp)


def cycles(time: Array, start: float, period: float, count: int) -> Array:
    """`count` sine periods from `start` on, zero outside, the first and last eighth eased."""
    end = start + count * period
    return np.asarray(np.sin(2 * np.pi * (time - start) / period) * window(time, start, end, period / 8))


def bows(time: Array, start: float, period: float, count: int) -> Array:
    """`count` times from 0 to 1 and back, (1 - cos)/2."""
    inside = (time >= start) & (time <= start + count * period)
    return np.where(inside, (1 - np.cos(2 * np.pi * (time - start) / period)) / 2, 0.0)


def sweep(time: Array, start: float, end: float, low: float, high: float) -> Array:
    """A sine whose frequency grows linearly from `low` to `high` [Hz] between `start` and `end`, eased."""
    t = time - start
    phase = 2 * np.pi * (low * t + (high - low) * t**2 / (2 * (end - start)))
    return np.asarray(np.sin(phase) * window(time, start, end, 2.0))
