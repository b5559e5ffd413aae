"""Sliding soles are seen, noise and standing are not called sliding."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.contact.slip_indicator import (
    SlipIndicator,
    _without_drift,
    apart_speed,
    slides,
    turning,
    twist_speed,
    unresisted,
)

PERIOD = 0.005
TIME = np.arange(4000) * PERIOD
BOTH = np.ones(TIME.size, dtype=bool)


def apart(distance: float, start: float = 8.0, end: float = 8.3) -> np.ndarray:
    """A distance that grows smoothly by `distance` [m] between `start` and `end` [s]."""
    share = np.clip((TIME - start) / (end - start), 0, 1)
    return distance * share**2 * (3 - 2 * share)


def noise(size: float, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(0, size, (TIME.size, 2))


def indicator(speed: np.ndarray, deviation: float = 0.001) -> SlipIndicator:
    return SlipIndicator(speed, np.full(TIME.size, deviation))


def sliding(position: np.ndarray, yaw: np.ndarray, both: np.ndarray, period: float) -> np.ndarray:
    """Samples in which two soles slide against each other."""
    indicator = apart_speed(position, yaw, both, period)
    return slides([indicator], indicator.speed, period) & both


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


def test_a_slide_reaches_as_far_as_it_is_possible() -> None:
    """Sure in its middle, possible before; what is possible alone is none, nor what covers no way."""
    middle, slow = (TIME >= 8.1) & (TIME < 8.3), (TIME >= 8.0) & (TIME < 8.4)
    speed = np.where(middle, 0.0055, np.where(slow, 0.004, 0.0005))
    assert np.array_equal(slides([indicator(speed)], speed, PERIOD), slow)
    assert not slides([indicator(np.where(slow, 0.004, 0.0))], speed, PERIOD).any()
    assert not slides([indicator(speed)], 0.3 * speed, PERIOD).any()


def test_two_witnesses_see_one_slide() -> None:
    """One says where it begins, the other where it ends, though neither covers LEAST_PATH alone."""
    first, second = (TIME >= 8.0) & (TIME < 8.1), (TIME >= 8.15) & (TIME < 8.25)
    seen = [indicator(np.where(part, 0.006, 0.0)) for part in (first, second)]
    way = np.where(first | second, 0.006, 0.0)
    assert np.array_equal(slides(seen, way, PERIOD), (TIME >= 8.0) & (TIME < 8.25))
    assert not slides(seen[:1], np.where(first, 0.006, 0.0), PERIOD).any()


def test_the_ringing_of_the_filter_is_no_part_of_a_slide() -> None:
    """A sole that stops at once from 100 mm/s."""
    path = np.cumsum(np.where((TIME >= 8.0) & (TIME < 8.2), 0.1, 0.0)) * PERIOD
    found = sliding(np.column_stack([path, 0 * path]), 0 * path, BOTH, PERIOD)
    assert found[(TIME > 8.0) & (TIME < 8.2)].all()
    assert not found[(TIME < 7.96) | (TIME > 8.24)].any()


@pytest.mark.parametrize(("force", "against"), [(-0.1, False), (0.1, True), (0.02, False), (np.nan, False)])
def test_friction_must_resist_a_slide(force: float, against: bool) -> None:
    """Unless it is so small that the sensors' zeros turn it, or unknown."""
    fast = (TIME > 8.0) & (TIME < 8.3)
    velocity = np.column_stack([np.where(fast, 0.02, 0.0005), np.zeros(TIME.size)])
    friction = np.column_stack([np.full(TIME.size, force), np.zeros(TIME.size)])
    found = unresisted(indicator(velocity[:, 0]), velocity, friction, PERIOD)
    assert np.array_equal(found, fast & against)


def test_a_sole_that_turns_is_seen_whatever_the_other_does() -> None:
    drift = np.radians(1.0) * TIME / TIME[-1] + np.random.default_rng(2).normal(0, 1e-4, TIME.size)
    found = turning(twist_speed(apart(np.radians(4)) + drift, BOTH, PERIOD), PERIOD)
    assert found[(TIME > 8.1) & (TIME < 8.2)].all()
    assert not found[(TIME < 7.85) | (TIME > 8.45)].any()
    behind = twist_speed(
        np.angle(np.exp(1j * (apart(np.radians(4)) + drift + np.pi - np.radians(2)))), BOTH, PERIOD
    )
    assert np.array_equal(turning(behind, PERIOD), found), (
        "past a half turn the heading jumps, the sole does not"
    )
    elastic = twist_speed(apart(np.radians(0.8)) + drift, BOTH, PERIOD)
    assert not turning(elastic, PERIOD).any(), "a bush's own twist"
    to_and_fro = apart(np.radians(0.8), 8.0, 8.15) - apart(np.radians(0.8), 8.15, 8.3)
    assert not turning(twist_speed(to_and_fro + drift, BOTH, PERIOD), PERIOD).any(), "a bush that turns back"


def test_a_foot_in_the_air_turns_on_no_floor() -> None:
    """Its heading is known there, and moves."""
    standing, heading = BOTH & ((TIME < 5.0) | (TIME > 7.0)), apart(np.radians(4), 5.5, 6.5)
    found = twist_speed(heading, standing, PERIOD)
    np.testing.assert_array_equal(np.isfinite(found), standing)


def test_a_slide_that_is_sure_makes_no_other_one_sure() -> None:
    sure, possible = (TIME >= 8.0) & (TIME < 8.4), (TIME >= 12.0) & (TIME < 12.4)
    speed = np.where(sure, 0.006, np.where(possible, 0.004, 0.0005))
    assert np.array_equal(slides([indicator(speed)], speed, PERIOD), sure)


def test_what_goes_on_and_what_jumps_is_drift_to_the_ends_and_what_is_short_is_not() -> None:
    """A line leaves nothing, at its ends neither; a second's bump stays."""
    line = 0.3 * TIME - 1.0
    np.testing.assert_allclose(_without_drift(line, PERIOD)[:-10], 0.0, atol=1e-9)
    jump = np.where(TIME > 10.0, 2.0, 0.0)
    np.testing.assert_allclose(_without_drift(line + jump, PERIOD)[np.abs(TIME - 10.0) > 0.1], 0.0, atol=0.05)
    bump = np.where(np.abs(TIME - 6.0) < 0.5, 1.0, 0.0)
    left = _without_drift(bump, PERIOD)
    assert left[np.abs(TIME - 6.0) < 0.4] == pytest.approx(1.0)
    assert left[np.abs(TIME - 6.0) > 0.6] == pytest.approx(0.0)
