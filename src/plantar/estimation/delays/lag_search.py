"""A coarse search for sensors that are too late for a step along their rates: every lag on a grid is tried.

What a lag leaves of Newton's law counts window by window, and never more than the window holds: a window in which
somebody pushes is missed at every lag, and says nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import FORCE, TORQUE, Array

WINDOW = 4.0  # s: longer than any lag, so that a lag changes what a window misses and not what it holds
MOST_APART = 2  # feet that are searched each by itself; more have one lag, or the grid would be too large
TELLS = 0.5  # of what a window holds: one that misses more at the best lags says nothing of lags in between
NEAR_BEST = 1.3  # times the least miss: as good, for a coarse grid and a wrong URDF


@dataclass(frozen=True)
class LagGrid:
    """One recording read at every lag: `predicted` (a, n, 6) and `measured` (a, feet, b, n, 6).

    Encoders lag by each of `encoders` (a,), wrenches by each of `wrenches` (b,) [s], > 0: late. Evenly sampled,
    without NaN, slow drifts taken off.
    """

    predicted: Array
    measured: Array
    encoders: Array
    wrenches: Array
    period: float

    def missing(self, places: NDArray[np.intp]) -> Array:
        """What the wrenches lack at places (feet + 1,) of the feet's lags and the encoders', (n, 6)."""
        *feet, joints = places.tolist()
        own = [self.measured[joints, foot, place] for foot, place in enumerate(feet)]
        return np.asarray(self.predicted[joints] - np.sum(own, axis=0))

    def lags_at(self, places: NDArray[np.intp]) -> Array:
        """These lags, (feet + 1,) [s]."""
        return np.append(self.wrenches[places[:-1]], self.encoders[places[-1]])


@dataclass(frozen=True)
class Lags:
    """`values` (feet + 1,) [s], the feet's and then the encoders', at which the sum of all misses is least, between the
    grid's lags by a step to first order.

    `std` (feet + 1,): of the lags that do nearly as well; `at_edge`: the best lag stands at the end of the grid.
    `missed` (recordings,), from 0 to 1: what Newton's law leaves at the best lag of what windows hold; `power`
    (recordings,): squares of the predicted torques over those of the measured ones, where the lag of the encoders
    brings them closest to 1. Delays move it far less than a hand that carries a part of the robot.
    """

    values: Array
    std: Array
    at_edge: bool
    missed: Array
    power: Array


def search_lags(grids: Sequence[LagGrid]) -> Lags:
    """The best lags of all recordings together; all grids have the same lags."""
    first = grids[0]
    feet, count = first.measured.shape[1:3]
    combined = _combinations(feet, count)
    each = np.array([_missed_at_all(grid, combined) for grid in grids])
    missed = each.sum(axis=0)
    encoder, best = np.unravel_index(int(np.argmin(missed)), missed.shape)
    near = np.argwhere(missed <= NEAR_BEST * missed[encoder, best])
    lags = np.column_stack([first.wrenches[combined[near[:, 1]]], first.encoders[near[:, 0]]])
    places = np.append(combined[best], encoder)
    values = first.lags_at(places)
    steps = np.append(np.full(feet, np.diff(first.wrenches).max()), np.diff(first.encoders).max())
    last = np.append(np.full(feet, first.wrenches.max()), first.encoders.max())
    std = np.sqrt(np.mean((lags - values) ** 2, axis=0) + steps**2 / 12)
    edge = bool((np.abs(values) > last - 0.5 * steps).any())
    windows = np.array([_windows(grid)[0] for grid in grids])
    power = np.array([_power(grid) for grid in grids])
    beside = np.clip(_beside(grids, places, steps), -steps / 2, steps / 2)
    return Lags(values + beside, std, edge, each[:, encoder, best] / windows, power)


def _beside(grids: Sequence[LagGrid], places: NDArray[np.intp], steps: Array) -> Array:
    """How far lags (feet + 1,) are beside the best places of the grid [s], drawn to none by a share of its `steps`.

    A robot that walks hands its weight from foot to foot: one foot's lag between those of the grid is missed at all of
    them. Windows that miss much tell nothing.
    """
    products, against = np.zeros((len(places), len(places))), np.zeros(len(places))
    for grid in grids:
        windows, width = _windows(grid)
        scale = _scale(grid.predicted[places[-1]])
        last = np.array([*[len(grid.wrenches)] * (len(places) - 1), len(grid.encoders)]) - 1
        slopes = []
        for each in np.eye(len(places), dtype=np.intp):
            before, behind = (np.clip(places + by * each, 0, last) for by in (-1, 1))
            apart = float((grid.lags_at(behind) - grid.lags_at(before)).sum())
            slopes.append((grid.missing(behind) - grid.missing(before)) / apart)
        rows = np.stack([grid.missing(places), *slopes])[:, : windows * width] / scale
        rows = rows.reshape(len(rows), windows, -1)
        missed = np.sum(rows[0] ** 2, axis=1) / (2.0 * width)
        left, *columns = rows[:, missed < TELLS].reshape(len(rows), -1)
        noise = max(float(np.mean(left**2)), 1e-12) if left.size else 1.0
        products += np.array(columns) @ np.array(columns).T / noise
        against -= np.array(columns) @ left / noise
    return np.asarray(np.linalg.solve(products + np.diag(12 / steps**2), against))


def _scale(predicted: Array) -> Array:
    """By which forces and torques (n, 6) count alike: each as a share of its own squares."""
    squares = [np.mean(np.sum(predicted[:, part] ** 2, axis=1)) for part in (FORCE, TORQUE)]
    return np.repeat(np.sqrt(np.array(squares) + 1e-300), 3)


def _missed_at_all(grid: LagGrid, combined: NDArray[np.intp]) -> Array:
    """What each lag of the encoders and each combination of the wrenches' lags misses, (a, combinations)."""
    sides = zip(grid.predicted, grid.measured, strict=True)
    return np.array([_missed(*own, combined, _windows(grid)) for own in sides])


def _windows(grid: LagGrid) -> tuple[int, int]:
    """How many windows a recording has, and their samples."""
    samples = grid.predicted.shape[1]
    width = min(round(WINDOW / grid.period), samples)
    return samples // width, width


def _combinations(feet: int, count: int) -> NDArray[np.intp]:
    """Places of lags for every foot, (combinations, feet)."""
    if feet > MOST_APART:
        return np.tile(np.arange(count)[:, None], (1, feet))
    return np.array(list(product(range(count), repeat=feet)))


def _missed(predicted: Array, measured: Array, combined: NDArray[np.intp], split: tuple[int, int]) -> Array:
    """What each combination of lags misses, as a share of what windows hold, summed over windows: (combinations,).

    predicted: (n, 6); measured: (feet, b, n, 6).
    """
    windows, width = split
    feet, count = measured.shape[:2]
    scale, used = _scale(predicted), windows * width
    p = (predicted / scale)[:used].reshape(windows, -1)
    m = (measured / scale)[:, :, :used].reshape(feet * count, windows, -1).transpose(1, 0, 2)
    products = (m @ p[:, :, None]).reshape(windows, feet, count)
    squares = (m @ m.transpose(0, 2, 1)).reshape(windows, feet, count, feet, count)
    left = np.sum(p**2, axis=1)[:, None] * np.ones(len(combined))
    for foot in range(feet):
        left -= 2 * products[:, foot, combined[:, foot]]
        for other in range(feet):
            left += squares[:, foot, combined[:, foot], other, combined[:, other]]
    holds = 2.0 * width  # two shares a sample, of forces and of torques
    # Rounding may leave less than nothing where all is explained.
    return np.asarray(np.clip(left / holds, 0.0, 1.0).sum(axis=0))


def _power(grid: LagGrid) -> float:
    """Squares of the predicted torques over those of the measured ones, closest to 1 of all lags of the encoders."""
    now = int(np.argmin(np.abs(grid.wrenches)))
    measured = grid.measured[:, :, now].sum(axis=1)
    ratios = [
        float(np.sum(p[:, TORQUE] ** 2)) / max(float(np.sum(m[:, TORQUE] ** 2)), 1e-300)
        for p, m in zip(grid.predicted, measured, strict=True)
    ]
    return min(ratios, key=lambda ratio: abs(np.log(max(ratio, 1e-300))))
