"""Few groups that differ: what their differences say of the groups to come."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from plantar.estimation.random_effects import share_between


def found(true: float, own: float, groups: int = 3, draws: int = 150) -> np.ndarray:
    """Estimated deviations where groups differ by `true` and each is known within `own`, (draws,)."""
    random = np.random.default_rng(0)
    covariance = own**2 * (np.eye(groups - 1) + 1.0)
    spreads = []
    for _ in range(draws):
        shares = random.normal(0, np.hypot(true, own), groups)
        spreads.append(share_between(shares[1:] - shares[0], covariance, own))
    return np.array(spreads)


@pytest.mark.parametrize("true", [0.003, 0.01, 0.02])
def test_intervals_of_the_mean_hold(true: float) -> None:
    """Of three groups, with the mean's deviation from what is found, and Student's reach."""
    random = np.random.default_rng(1)
    own, groups, held = 0.001, 3, 0
    for _ in range(200):
        shares = random.normal(0, np.hypot(true, own), groups)
        covariance = own**2 * (np.eye(groups - 1) + 1.0)
        spread = share_between(shares[1:] - shares[0], covariance, own)
        held += abs(shares.mean()) < stats.t.ppf(0.975, groups - 1) * np.hypot(spread, own) / np.sqrt(groups)
    assert held >= 0.92 * 200


def test_groups_that_are_alike_widen_little() -> None:
    assert np.median(found(0.0, 0.001)) < 0.0025
    assert np.median(found(0.02, 0.001)) > 0.01
