"""Few groups that differ: what their differences say of the groups to come."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from plantar.estimation.random_effects import Differences, furthest, resolution, share_between


def found(true: float, own: float, groups: int = 3, draws: int = 150) -> np.ndarray:
    """Estimated deviations where groups differ by `true` and each is known within `own`, (draws,)."""
    random = np.random.default_rng(0)
    covariance = own**2 * (np.eye(groups - 1) + 1.0)
    spreads = []
    for _ in range(draws):
        shares = random.normal(0, np.hypot(true, own), groups)
        spreads.append(share_between([Differences(shares[1:] - shares[0], covariance)], own).share)
    return np.array(spreads)


@pytest.mark.parametrize("true", [0.003, 0.01, 0.02])
def test_intervals_of_the_mean_hold(true: float) -> None:
    """Of three groups, with the mean's deviation from what is found, and Student's reach."""
    random = np.random.default_rng(1)
    own, groups, held = 0.001, 3, 0
    for _ in range(200):
        shares = random.normal(0, np.hypot(true, own), groups)
        covariance = own**2 * (np.eye(groups - 1) + 1.0)
        spread = share_between([Differences(shares[1:] - shares[0], covariance)], own).share
        held += abs(shares.mean()) < stats.t.ppf(0.975, groups - 1) * np.hypot(spread, own) / np.sqrt(groups)
    assert held >= 0.92 * 200


def test_groups_that_are_alike_widen_little() -> None:
    assert np.median(found(0.0, 0.001)) < 0.0025
    assert np.median(found(0.02, 0.001)) > 0.01


def test_sets_together_show_what_one_alone_hides() -> None:
    """Two groups that happen to be alike are alike; four such pairs among others that differ are not."""
    covariance = np.array([[0.005**2]])
    alike, differing = Differences(np.array([0.001]), covariance), Differences(np.array([0.03]), covariance)
    alone = share_between([alike], 0.001)
    together = share_between([alike, differing, differing, differing], 0.001)
    all_differ = share_between([differing] * 4, 0.001)
    assert alone.share < 0.003 < 0.01 < together.share < all_differ.share
    assert share_between([alike] * 4, 0.001).share <= alone.share
    assert alone.low < 0.0005  # may as well be none
    assert 0.005 < together.low < together.share < together.high


def test_the_interval_of_the_share_holds() -> None:
    random = np.random.default_rng(2)
    true, own, held = 0.02, 0.002, 0
    for _ in range(200):
        shares = random.normal(0, np.hypot(true, own), 6)
        found = share_between([Differences(shares[1:] - shares[0], own**2 * (np.eye(5) + 1.0))], 0.01)
        held += found.low < true < found.high
    assert held >= 0.9 * 200


def test_differences_that_say_nothing_leave_the_prior() -> None:
    """The root of the mean square, and the ends of the middle 95 %, of Student's half with its three degrees."""
    found = share_between([Differences(np.zeros(1), np.array([[1e6]]))], 0.01)
    shares = np.geomspace(1e-5, 0.2, 20001)
    density = stats.t.pdf(shares / 0.01, 3)
    square = np.trapezoid(density * shares**2, shares) / np.trapezoid(density, shares)
    assert found.share == pytest.approx(np.sqrt(square), rel=0.02)
    below = np.cumsum(density * np.gradient(shares))
    low, high = np.interp([0.025, 0.975], below / below[-1], shares)
    assert found.low == pytest.approx(low, rel=0.1)
    assert found.high == pytest.approx(high, rel=0.1)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("apart", [0.0, 0.03])
def test_groups_that_are_known_exactly_differ_by_what_they_do(apart: float) -> None:
    exact = Differences(np.array([apart]), np.zeros((1, 1)))
    found = share_between([exact], resolution([exact]))
    assert np.isfinite(found).all()
    assert found.share < 1e-4 if apart == 0 else apart / 3 < found.share < 2 * apart


def test_one_group_beside_the_weighted_mean_of_the_others() -> None:
    """Of groups that are known each by itself: the odd one less the others' mean, weighted by how well each is known
    and how far they differ; whichever group is called the first."""
    shares = np.array([0.010, -0.004, 0.002, 0.150, 0.006])
    own = np.array([0.010, 0.004, 0.020, 0.008, 0.015]) ** 2
    others = np.delete(np.arange(5), 3)
    for first in range(5):
        order = [first, *(each for each in range(5) if each != first)]
        covariance = np.diag(own[order[1:]]) + own[first]
        odd = furthest(Differences(shares[order[1:]] - shares[first], covariance), 0.05, 3.0)
        assert odd is not None
        assert order[odd.place] == 3
        weight = 1 / (own[others] + odd.apart**2)
        assert odd.share == pytest.approx(0.150 - np.average(shares[others], weights=weight), rel=1e-9)
        assert odd.std == pytest.approx(np.sqrt(1 / weight.sum() + own[3] + odd.apart**2), rel=1e-9)
    assert furthest(Differences(shares[1:] - shares[0], np.diag(own[1:]) + own[0]), 0.2, 3.0) is None
    odd = furthest(Differences(shares[1:] - shares[0], np.diag(own[1:]) + own[0]), 0.0, 3.0)
    assert odd is not None
    for sure, told in ((0.99, True), (1.01, False)):
        again = furthest(
            Differences(shares[1:] - shares[0], np.diag(own[1:]) + own[0]), 0.0, sure * odd.share / odd.std
        )
        assert (again is not None) == told
