"""Sliding soles are seen, noise and standing are not called sliding."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.slip import slides, sliding, sole_velocity, turning

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


def swaying(slide: np.ndarray, seed: int = 0, quiet: bool = True) -> dict[str, np.ndarray]:
    """A sole seen from an IMU that sways 0.9 m above it at 0.4 Hz, while the sole goes `slide` (N,) [m] along x.

    The attitude is wrong by 0.15 deg and wanders by 0.06; unless `quiet`, impacts ring in the accelerometer for a
    second from 13 s.
    """
    random = np.random.default_rng(seed)
    sway = 0.03 * np.sin(2 * np.pi * 0.4 * TIME)
    imu = np.column_stack([slide + sway, 0.5 * sway])
    acceleration = np.gradient(np.gradient(imu, PERIOD, axis=0), PERIOD, axis=0)
    acceleration += 0.026 + 0.01 * np.sin(2 * np.pi * TIME / 15)[:, None] + random.normal(0, 0.004, imu.shape)
    if not quiet:
        acceleration[(TIME > 13) & (TIME < 14)] += random.normal(0, 1.5, (int(1 / PERIOD) - 1, 2))
    position = np.column_stack([-sway, -0.5 * sway]) + random.normal(0, 5e-5, imu.shape)
    return {
        "position": position, "heading": np.zeros(TIME.size), "acceleration": acceleration,
        "rate": np.zeros((TIME.size, 2)),
    }  # fmt: skip


def found_alone(scene: dict[str, np.ndarray], friction: np.ndarray | None = None) -> np.ndarray:
    velocity, shaken = sole_velocity(**scene, standing=BOTH, period=PERIOD)
    return slides(velocity, PERIOD, shaken, friction)


def test_a_sole_that_slides_alone_shows_in_the_acceleration() -> None:
    found = found_alone(swaying(apart(0.004)))
    assert found[(TIME > 8.05) & (TIME < 8.25)].all()
    assert not found[(TIME < 7.85) | (TIME > 8.45)].any()
    assert not found_alone(swaying(np.zeros(TIME.size))).any()


def test_impacts_are_no_slides() -> None:
    """They make the integrated velocity jump by centimetres a second; the slide before them is still found."""
    found = found_alone(swaying(apart(0.01), quiet=False))
    assert found[(TIME > 8.05) & (TIME < 8.25)].all()
    assert not found[TIME > 9].any()


@pytest.mark.parametrize(("force", "believed"), [(-0.1, True), (0.1, False), (0.01, True)])
def test_friction_must_resist_a_slide(force: float, believed: bool) -> None:
    """Unless it is so small that the sensors' zeros turn it."""
    friction = np.column_stack([np.full(TIME.size, force), np.zeros(TIME.size)])
    assert found_alone(swaying(apart(0.01)), friction).any() == believed


def test_a_sole_that_turns_is_seen_whatever_the_other_does() -> None:
    drift = np.radians(1.0) * TIME / TIME[-1] + np.random.default_rng(2).normal(0, 1e-4, TIME.size)
    found = turning(apart(np.radians(4)) + drift, BOTH, PERIOD)
    assert found[(TIME > 8.1) & (TIME < 8.2)].all()
    assert not found[(TIME < 7.85) | (TIME > 8.45)].any()
    assert not turning(apart(np.radians(0.8)) + drift, BOTH, PERIOD).any(), "a bush's own twist"
