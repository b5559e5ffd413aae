"""Zeros of force sensors read in the air: their middle, their drift, and when nothing is said."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.sensors.air_zero import _usual_slope, air_zero

WEIGHT, PERIOD = 700.0, 0.02
ZERO = np.array([12.0, -17.0, -60.0, 0.4, -0.2, 0.8])


def walked(swings: int, drift: float = 0.0, noise: float = 0.5) -> tuple[np.ndarray, np.ndarray]:
    """Time (N,) and wrench (N, 6) of a foot that stands and swings for a second each."""
    time = np.arange(0, 2.0 * swings + 1.0, PERIOD)
    stands = np.mod(time, 2.0) < 1.0
    wrench = np.zeros((time.size, 6))
    wrench[stands, 2], wrench[stands, 4] = WEIGHT, 30.0
    wrench += ZERO + drift * np.outer(time - time.mean(), [1, 1, 1, 0, 0, 0])
    return time, wrench + noise * np.random.default_rng(0).normal(size=wrench.shape)


def test_the_zero_is_what_a_lifted_foot_reads() -> None:
    time, wrench = walked(8)
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    assert zero.swings == 8
    assert zero.at(time).mean(axis=0) == pytest.approx(ZERO, abs=0.3)


def test_each_swing_is_a_row_of_the_result() -> None:
    time, wrench = walked(8, drift=2.0)
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    rows = zero.rows("walk", "left")
    assert [row.time for row in rows] == pytest.approx(np.arange(1.5, 17.0, 2.0), abs=0.05)
    for row in rows:
        drifted = ZERO + 2.0 * (row.time - time.mean()) * np.array([1, 1, 1, 0, 0, 0])
        assert (*row.force, *row.torque) == pytest.approx(drifted, abs=0.6)
        assert (*row.force_zero, *row.torque_zero) == pytest.approx(drifted, abs=0.6)
    assert {(row.motion, row.foot) for row in rows} == {("walk", "left")}


def test_a_drift_is_followed() -> None:
    time, wrench = walked(8, drift=2.0)
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    assert zero.drift[:3] == pytest.approx(np.full(3, 2.0), abs=0.1)
    assert zero.drift[3:] == pytest.approx(np.zeros(3), abs=0.1)


@pytest.mark.parametrize(("swings", "followed"), [(3, False), (4, True)])
def test_four_swings_show_a_drift_and_three_do_not(swings: int, followed: bool) -> None:
    time, wrench = walked(swings, drift=2.0, noise=0.05)
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    assert zero.swings == swings
    assert zero.drift[:3] == pytest.approx(np.full(3, 2.0 if followed else 0.0), abs=0.1)


def test_what_swings_scatter_by_is_no_drift() -> None:
    time, wrench = walked(8, noise=0.0)
    number = np.floor(time / 2.0).astype(int)
    wrench += np.random.default_rng(1).normal(0, 2.0, (number.max() + 1, 6))[number]
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    assert np.count_nonzero(zero.drift) <= 1


def test_a_swing_that_touches_the_ground_moves_it_little() -> None:
    time, wrench = walked(8)
    wrench[(time > 3.0) & (time < 4.0), 2] += 25.0
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    assert zero.middle[2] == pytest.approx(ZERO[2], abs=1.0)


@pytest.mark.parametrize("swings", [2, 8])
def test_a_foot_that_rests_on_the_ground_before_and_after_is_not_in_the_air(swings: int) -> None:
    """The robot stands still with little on this foot, as much as a quarter of its weight."""
    time, wrench = walked(swings)
    rest = (time < 0.9) | (time > 2.0 * swings)
    wrench[rest, 2] = ZERO[2] + WEIGHT / 4
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    assert zero.swings == swings
    assert zero.at(time).mean(axis=0) == pytest.approx(ZERO, abs=0.3)


@pytest.mark.parametrize("kind", ["stands", "sways", "one swing", "hardly loaded", "nothing known"])
def test_nothing_is_said_of_a_foot_that_does_not_step(kind: str) -> None:
    time, wrench = walked(1 if kind == "one swing" else 8)
    if kind == "stands":
        wrench[:, 2] = WEIGHT / 2
    if kind == "sways":  # down to a tenth of the weight at its lightest
        wrench[:, 2] = WEIGHT * (0.5 + 0.4 * np.sin(2 * np.pi * 0.3 * time))
    if kind == "hardly loaded":
        wrench[:, 2] = np.where(wrench[:, 2] > 100, 0.2 * WEIGHT, 0.0)
    if kind == "nothing known":
        wrench[:] = np.nan
    assert air_zero(time, wrench, wrench[:, 2], WEIGHT) is None


def test_how_much_swings_differ_is_their_deviation_and_told() -> None:
    time, wrench = walked(200, noise=0.0)
    number = np.floor(time / 2.0).astype(int)
    wrench += np.random.default_rng(2).normal(0, 4.0, (number.max() + 1, 6))[number]
    zero = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert zero is not None
    assert zero.scatter == pytest.approx(np.full(6, 4.0), rel=0.2)
    assert f"(200 swings, which differ by {zero.scatter[:3].max():.2g} N)" in zero.text


def test_swings_too_short_to_be_flat_leave_no_rest_for_a_zero() -> None:
    """Weight goes over slowly: a foot hangs for 0.3 s between two ramps of 0.8 s. The robot rests twice."""
    time, wrench = walked(8)
    share = np.interp(np.mod(time, 4.0), [0.0, 1.0, 1.8, 2.1, 2.9, 4.0], [1.0, 1.0, 0.0, 0.0, 1.0, 1.0])
    rest = ((time > 7.0) & (time < 8.0)) | (time > 15.0)
    wrench[:, 2] = ZERO[2] + WEIGHT * np.where(rest, 0.3, share)
    assert air_zero(time, wrench, wrench[:, 2], WEIGHT) is None


def stepped(
    high: float = WEIGHT, low: float = 0.0, swing: float = 1.0, rough: float = 0.0, rest: float | None = None
) -> tuple[Array, Array]:
    """Eight stances of a second and swings of `swing` [s], in which the load varies by `rough`; one may read `rest`."""
    period = 0.01
    one = np.concatenate([np.full(100, high), low + rough * np.tile([1.0, -1.0], round(50 * swing))])
    force = np.tile(one, 8)
    if rest is not None:
        force[100 : one.size] = rest
    wrench = np.zeros((force.size, 6))
    wrench[:, 2], wrench[:, 5] = force, 0.7
    return period * np.arange(force.size), wrench


@pytest.mark.parametrize(
    ("changes", "swings"),
    [({"high": 0.51 * WEIGHT}, 8), ({"high": 0.49 * WEIGHT}, None), ({"low": 0.19 * WEIGHT}, 8),
     ({"low": 0.21 * WEIGHT}, None), ({"low": -0.21 * WEIGHT}, None), ({"swing": 0.24}, 8), ({"swing": 0.16}, None),
     ({"rough": 0.0145 * WEIGHT}, 8), ({"rough": 0.0155 * WEIGHT}, None), ({"rest": 0.09 * WEIGHT}, 8),
     ({"rest": 0.11 * WEIGHT}, 7)],
)  # fmt: skip
def test_a_zero_is_read_in_swings_that_are_long_flat_and_alike(
    changes: dict[str, float], swings: int | None
) -> None:
    time, wrench = stepped(**changes)
    found = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert (found and found.swings) == swings
    assert found is None or found.middle[5] == pytest.approx(0.7)


@pytest.mark.parametrize(("drift", "followed"), [(0.9, False), (1.1, True)])
def test_a_zero_s_drift_is_three_of_its_deviations(drift: float, followed: bool) -> None:
    """Eight swings 2 s apart, by turns 1 N above and below the line: a slope's deviation is 1 / √(Σ t²)."""
    time, wrench = stepped()
    when = 1.495 + 2.0 * np.arange(8)
    usual = 1 / np.sqrt(np.sum((when - when.mean()) ** 2))
    above = np.tile([1.0, -1.0, -1.0, 1.0], 2)
    wrench[:, 0] = np.repeat(above, 200) + 3 * drift * usual * np.repeat(when - when.mean(), 200)
    found = air_zero(time, wrench, wrench[:, 2], WEIGHT)
    assert found is not None
    assert bool(found.drift[0]) == followed
    assert "in the air its force sensor reads " in found.text
    x, _, z = found.middle[:3]
    told = f"reads {x:.3g}, 0, {z:.3g} N (8 swings, which differ by {found.scatter[0]:.2g} N)"
    assert told in found.text


def test_one_swing_that_touches_moves_no_slope() -> None:
    """Of nine swings on a line one is far off: of all 36 pairs 8 know of it."""
    when = np.cumsum(np.random.default_rng(0).uniform(1.0, 3.0, 9))
    slope = np.array([0.5, -0.2, 2.0, 0.01, 0.0, -0.03])
    seen = slope * when[:, None] + 7.0
    seen[3] += 100.0
    np.testing.assert_allclose(_usual_slope(when, seen), slope, atol=1e-12)
