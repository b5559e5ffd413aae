"""By how much groups differ beyond what each is unsure by, where there are few of them, and which one is odd."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array

# Share: who differs by less does not differ, and nothing is known better, not even without noise.
LEAST = 1e-5
TRIED = np.geomspace(LEAST, 0.2, 200)  # shares by which groups may differ
HEAVY = 3.0  # degrees of freedom of the prior's tail: groups that differ by far more than it are believed


class Differences(NamedTuple):
    """Shares of groups beside the first one's, `shares` (n,), and their `covariance` (n, n)."""

    shares: Array
    covariance: Array


class ShareBetween(NamedTuple):
    """By which share (standard deviation) groups differ, and the ends of its 95 % interval."""

    share: float
    low: float
    high: float


class Odd(NamedTuple):
    """The group at `place`: what it is less the others' mean, as a `share`, with deviation `std`; `apart`: the share by
    which the others scatter."""

    place: int
    share: float
    std: float
    apart: float


def resolution(sets: Sequence[Differences]) -> float:
    """What groups can be told apart by: the harmonic mean of the variances of all differences, as a deviation.

    By as much they may differ before they are compared, where nothing else is known: at that size a difference is
    believed by half (W. DuMouchel, NISS Technical Report 27, 1994).
    """
    variances = np.concatenate([np.diag(each.covariance) for each in sets])
    return float(1 / np.sqrt(np.mean(1 / np.maximum(variances, LEAST**2))))


def share_between(sets: Sequence[Differences], usual: float) -> ShareBetween:
    """By which share groups differ, where all sets of differences are of groups of one kind.

    Random effects: the root of the mean square over what their likelihood and a half-Student prior of size `usual`
    leave (A. Gelman, Bayesian Analysis 1, 2006). So few differences may be small by chance, which a moment estimate
    takes for none at all.
    """
    prior = -0.5 * (HEAVY + 1) * np.log1p((TRIED / max(usual, LEAST)) ** 2 / HEAVY)
    # Tried in even steps of the logarithm.
    logarithm = prior + np.log(TRIED) + sum(_likelihood(each) for each in sets)
    weight = np.exp(logarithm - logarithm.max())
    below = np.cumsum(weight) / np.sum(weight)
    low, high = np.interp([0.025, 0.975], below, TRIED)
    return ShareBetween(float(np.sqrt(np.sum(weight * TRIED**2) / np.sum(weight))), float(low), float(high))


def _likelihood(found: Differences) -> Array:
    """Logarithm of the density of differences from a first group that differs by each of `TRIED` like all others."""
    spread = found.covariance + np.multiply.outer(TRIED**2, np.eye(len(found.shares)) + 1.0)
    distance = found.shares @ np.linalg.solve(spread, found.shares[:, None])
    return np.asarray(-0.5 * (np.linalg.slogdet(spread)[1] + distance[:, 0]))


def furthest(found: Differences, much: float, sure: float) -> Odd | None:
    """The group that is by more than the share `much`, and by more than `sure` deviations, beside the others, as far as
    these agree; None where none is. The first group is one of them."""
    count = len(found.shares) + 1
    shares = np.append(0.0, found.shares)
    covariance = np.zeros((count, count))
    covariance[1:, 1:] = found.covariance
    tried = [_beside_others(shares, covariance, place) for place in range(count)]
    clear = [one for one in tried if abs(one.share) > max(much, sure * one.std)]
    return max(clear, key=lambda one: abs(one.share) / one.std, default=None)


def _beside_others(shares: Array, covariance: Array, place: int) -> Odd:
    """One group beside the mean of the others, weighted by how well each is known and by how far they differ."""
    others = [each for each in range(len(shares)) if each != place]
    apart = _apart(shares[others], covariance[np.ix_(others, others)])
    # Of this group less each other one: both ends of a difference may be off by `apart` as well.
    spread = covariance + apart**2 * np.eye(len(shares))
    step = np.eye(len(shares)) - np.eye(len(shares))[place]
    differences = step[others] @ spread @ step[others].T
    weight = np.linalg.solve(differences, np.ones(len(others)))
    variance = 1.0 / float(weight.sum())
    share = float(variance * weight @ (shares[place] - shares[others]))
    return Odd(place, share, float(np.sqrt(variance)), apart)


def _apart(shares: Array, covariance: Array) -> float:
    """By which share these differ among one another; nothing is known of one alone. Never 0: without noise a covariance
    is."""
    if len(shares) < 2:
        return LEAST
    step = np.eye(len(shares))[1:] - np.eye(len(shares))[0]
    beside = Differences(step @ shares, step @ covariance @ step.T)
    return share_between([beside], float(np.sqrt(np.mean(np.diag(beside.covariance))))).share
