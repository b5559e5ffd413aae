"""Columns of a slow drift: they follow what wanders, and leave a motion that is slow itself."""

from __future__ import annotations

import numpy as np

from plantar.estimation.slow_drift import (
    drift_basis,
    drift_beside,
)

MOST_COSINES = 60

TIME = 0.05 * np.arange(720) + 12.0  # s


def test_columns_are_of_mean_zero_and_the_first_is_a_line() -> None:
    basis = drift_basis(TIME)
    assert basis.shape == (720, 4)  # 36 s: cosines of 72, 36 and 24 s
    np.testing.assert_allclose(basis.mean(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(basis.T @ basis, np.eye(4), atol=1e-12)
    line = TIME - TIME.mean()
    np.testing.assert_allclose(np.abs(basis[:, 0]), np.abs(line) / np.linalg.norm(line))
    np.testing.assert_allclose(drift_basis(TIME + 1e3), basis, atol=1e-9)


def test_the_cost_of_a_long_recording_is_bounded() -> None:
    hour = np.arange(0.0, 3600.0, 0.5)
    assert drift_basis(hour).shape == (len(hour), 1 + MOST_COSINES)
    assert drift_basis(hour[:1200]).shape == (1200, 60)  # ten minutes are followed down to 20 s


def test_a_short_recording_has_the_line_alone() -> None:
    assert drift_basis(TIME[:150]).shape == (150, 1)
    assert drift_basis(TIME[:0]).shape == (0, 1)
    assert drift_basis(TIME[:1]).shape == (1, 0)


def test_a_wandering_angle_draws_no_stiffness_to_zero() -> None:
    random = np.random.default_rng(3)
    biases = {1: [], 4: []}
    for _ in range(40):
        true = 0.004 * np.sin(2 * np.pi * 0.25 * TIME + random.uniform(0, 6))
        walk = np.cumsum(random.standard_normal(720)) * 0.001 / np.sqrt(720)
        read = true + walk
        for size, found in biases.items():
            design = np.column_stack([read, np.ones(720), drift_beside(read, drift_basis(TIME))[:, :size]])
            found.append(float(np.linalg.lstsq(design, 500 * true)[0][0]) / 500 - 1)
    assert np.mean(biases[1]) < -0.006
    assert abs(np.mean(biases[4])) < 0.5 * abs(np.mean(biases[1]))


def test_a_slow_motion_keeps_its_information() -> None:
    slow = np.sin(2 * np.pi * TIME / 33.0)
    assert drift_beside(slow, drift_basis(TIME)).shape == (720, 1)
    quick = np.sin(2 * np.pi * TIME / 8.0)
    assert drift_beside(quick, drift_basis(TIME)).shape == (720, 4)
