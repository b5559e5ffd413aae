"""How likely joints bend: against a second derivation, in what must not matter, and where one joint alone is wrong."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from plantar.conventions import Array
from plantar.sensors.moments.bending_odds import (
    ALL,
    BEFORE,
    NONE,
    OWN,
    SINGLE,
    SIZES,
    TOGETHER,
    BendingOdds,
    bending_odds,
)

EVERY = np.ones(6)
LOWEST = np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0])


def odds(values: Array, std: float = 0.006, told: float = 0.0) -> BendingOdds:
    return bending_odds(values, std**2 * np.eye(len(values)), (EVERY, LOWEST), told)


@pytest.mark.parametrize("told", [0.0, 0.02])
def test_all_cases_one_by_one_say_the_same(told: float) -> None:
    """Of two joints, in the information form: unit numbers that make them bend, beside what each value says."""
    values, some = np.array([0.03, 0.012]), np.array([0.0, 1.0])
    noise = np.array([[4e-5, 1e-5], [1e-5, 9e-5]])
    single = [np.diag([SINGLE**2, 0.0]), np.diag([0.0, SINGLE**2]), SINGLE**2 * np.eye(2)]
    errors = [(NONE, np.zeros((2, 2))), *(((1 - NONE) / 2 / 3, one) for one in single)]
    errors += [((1 - NONE) / 2 / len(ALL), size**2 * np.eye(2)) for size in ALL]
    sizes = [np.sqrt(size**2 + told**2) for size in SIZES]
    bends = [(size, joints) for joints in (np.ones(2), some) for size in sizes]
    total, bent, mean, square = 0.0, 0.0, np.zeros(2), np.zeros((2, 2))
    stiff = [(1 - BEFORE, 0.0, told, np.ones(2))]
    for chance, centre, size, joints in [*stiff, *((BEFORE / len(bends), s, s, j) for s, j in bends)]:
        ways = size * np.column_stack([TOGETHER * joints, OWN * np.diag(joints)])
        for likely, error in errors:
            seen = noise + error + ways @ ways.T
            weight = chance * likely * multivariate_normal.pdf(values, centre * joints, seen)
            known = np.linalg.inv(noise + error)
            left = ways @ np.linalg.inv(np.eye(3) + ways.T @ known @ ways) @ ways.T
            there = centre * joints + left @ known @ (values - centre * joints)
            total += weight
            bent += weight * (centre > 0)
            mean += weight * there
            square += weight * (left + np.outer(there, there))
    mean, square = mean / total, square / total
    found = bending_odds(values, noise, (np.ones(2), some), told)
    assert found.chance == pytest.approx(bent / total, rel=1e-9)
    assert found.mean == pytest.approx(mean, rel=1e-9)
    assert found.covariance == pytest.approx(square - np.outer(mean, mean), rel=1e-8)


def test_joints_that_seem_to_do_nothing_are_stiff() -> None:
    found = odds(0 * EVERY)
    assert found.chance < 0.5 * BEFORE
    assert np.abs(found.mean).max() < 0.002


def test_joints_that_bend_alike_do_so_by_what_they_seem_to() -> None:
    found = odds(0.06 * EVERY)
    assert found.chance > 0.999
    assert found.mean == pytest.approx(0.06 * EVERY, rel=0.03)
    assert np.sqrt(np.diag(found.covariance)) == pytest.approx(0.006 * EVERY, rel=0.1)


def test_the_lowest_may_bend_alone() -> None:
    found = odds(0.06 * LOWEST)
    assert found.chance > 0.95
    assert found.mean[4:] == pytest.approx(0.06, rel=0.1)
    assert np.abs(found.mean[:4]).max() < 0.004
    higher = odds(0.06 * LOWEST[::-1])
    assert higher.chance < found.chance
    assert higher.mean[:2].max() < 0.5 * found.mean[4:].min()


@pytest.mark.parametrize("wrong", [[0.2, 0, 0, 0, 0, 0], [-0.2, 0, 0, 0.15, 0, 0]])
def test_one_or_two_joints_that_are_wrong_bend_no_others(wrong: list[float]) -> None:
    alone = odds(np.array(wrong))
    assert alone.chance < BEFORE
    beside = odds(0.05 * EVERY + wrong)
    assert beside.chance > 0.95
    right = np.array(wrong) == 0
    assert beside.mean[right] == pytest.approx(0.05, rel=0.06)
    assert (np.sqrt(np.diag(beside.covariance))[right] < 0.012).all()
    assert np.sqrt(np.diag(beside.covariance))[~right].min() > 0.015


def test_where_all_joints_disagree_little_is_known() -> None:
    disagree = np.array([0.09, -0.05, 0.12, 0.02, -0.02, 0.14])
    alike, apart = odds(0.05 * EVERY), odds(disagree)
    assert apart.chance < alike.chance
    assert np.diag(apart.covariance).min() > 4 * np.diag(alike.covariance).max()


def test_neither_the_order_of_joints_nor_of_cases_matters() -> None:
    values, order = np.array([0.01, 0.03, 0.02, -0.01, 0.05, 0.04]), np.array([3, 0, 5, 1, 4, 2])
    covariance = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]) * 1e-5
    first = bending_odds(values, covariance, (EVERY, LOWEST), 0.0)
    turned = covariance[np.ix_(order, order)]
    second = bending_odds(values[order], turned, (LOWEST[order], EVERY), 0.0)
    assert second.chance == pytest.approx(first.chance, rel=1e-9)
    assert second.mean == pytest.approx(first.mean[order], rel=1e-9)
    assert second.covariance == pytest.approx(first.covariance[np.ix_(order, order)], rel=1e-9)


def test_what_the_robot_file_says_is_known_before() -> None:
    """Of joints that show hardly anything, and of those that show a little."""
    unseen = odds(0 * EVERY, std=1.0, told=0.02)
    assert np.sqrt(np.diag(unseen.covariance)).min() > 0.02
    shown, untold = odds(0.015 * EVERY, told=0.02), odds(0.015 * EVERY)
    assert shown.mean.min() > untold.mean.max()
