"""By how much groups differ beyond what each is unsure by, where there are few of them."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array

TRIED = np.geomspace(1e-5, 0.2, 200)  # shares by which groups may differ
HEAVY = 3.0  # degrees of freedom of the prior's tail: groups that differ by far more than it are believed


def share_between(differences: Array, covariance: Array, usual: float) -> float:
    """Deviation of shares of which `differences` (n,) from the first one are known with a covariance (n, n).

    Random effects: the root of the mean square over what their likelihood and a half-Student prior of size `usual`
    leave (A. Gelman, Bayesian Analysis 1, 2006). So few differences may be small by chance, which a moment estimate
    takes for none at all.
    """
    together = np.eye(len(differences)) + 1.0
    weights = []
    for share in TRIED:
        spread = covariance + share**2 * together
        likelihood = -0.5 * (
            np.linalg.slogdet(spread)[1] + differences @ np.linalg.solve(spread, differences)
        )
        prior = -0.5 * (HEAVY + 1) * np.log1p((share / usual) ** 2 / HEAVY)
        weights.append(likelihood + prior + np.log(share))  # tried in even steps of the logarithm
    weight = np.exp(np.array(weights) - max(weights))
    return float(np.sqrt(np.sum(weight * TRIED**2) / np.sum(weight)))
