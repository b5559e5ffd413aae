"""Delays of several sensors beside each other, where one delay common to all may not do.

Newton's law closes when every sensor is read at its own moment: what is missing of it at the moments recorded is, to
first order, each sensor's delay times how the balance changes with it. The common delay has its own estimate
(`estimation/delays/delay.py`); this one is for telling sensors apart, and for their delays where they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from plantar.conventions import Array
from plantar.estimation.delays.delay import GAIN_BAND, LEAST_EXPLAINED, LEAST_SHARE, MODEL_ERROR, banded
from plantar.estimation.orthonormal import orthonormal, without

ROUNDS = 3  # of weighing cells by what the solution leaves of them
FEWEST_CELLS = 6  # axes in bands that must close


@dataclass(frozen=True)
class Balance:
    """Newton's law of one recording over six axes: `predicted` (n, 6) less the sum of `measured` (sensors, n, 6).

    `by_delay` (delays, n, 6) is how that difference grows with each sensor's delay [per s]. Evenly sampled, without
    NaN, equally filtered. `model_errors` (draws, n, 6): as in `Pair`.
    """

    predicted: Array
    measured: Array
    by_delay: Array
    period: float
    model_errors: Array = field(default_factory=lambda: np.zeros((0, 0, 6)))

    @cached_property
    def cells(self) -> list[_Cell]:
        """Every axis in every band that closes, once they were asked for."""
        return _cells(self)


@dataclass(frozen=True)
class _Cell:
    """One axis in one band, gains of prediction and sensors taken off.

    What is `missing` (n,), how it grows with the delays, `columns` (n, delays), what drawn models would make of it,
    `wrong` (n, draws), and squares of the model's own error. `freedom`: how many independent values are left of n.
    """

    missing: Array
    columns: Array
    wrong: Array
    floor: float
    freedom: float


@dataclass(frozen=True)
class Delays:
    """`values` (delays,) [s], > 0: late; their `covariance`; `cells` took part."""

    values: Array
    covariance: Array
    cells: int


def estimate_delays(balances: Sequence[Balance], held: Array | None = None) -> Delays | None:
    """All delays together, or None where too few axes close or some delay shows nowhere.

    held: (c, delays), combinations of delays that are taken as zero.
    """
    cells = [cell for balance in balances for cell in balance.cells]
    if len(cells) < FEWEST_CELLS:
        return None
    count = len(balances[0].by_delay)
    free = np.eye(count) if held is None or not len(held) else _null_space(held)
    values = np.zeros(count)
    weights = np.array([cell.freedom / float(cell.missing @ cell.missing) for cell in cells])
    for _ in range(ROUNDS):
        information = sum(w * cell.columns.T @ cell.columns for w, cell in zip(weights, cells, strict=True))
        reduced = free.T @ information @ free
        scale = np.sqrt(np.diag(reduced))
        if not (scale > 0).all() or np.linalg.cond(reduced / np.outer(scale, scale)) > 1e6:
            return None
        product = sum(w * cell.columns.T @ cell.missing for w, cell in zip(weights, cells, strict=True))
        values = free @ np.linalg.solve(reduced, free.T @ product)
        left = [cell.missing - cell.columns @ values for cell in cells]
        weights = np.array(
            [cell.freedom / float(rest @ rest + cell.floor) for rest, cell in zip(left, cells, strict=True)]
        )
    inverse = free @ np.linalg.inv(reduced) @ free.T
    # Cells disagree by more than noise where the robot's model is wrong: each is one draw of that. What a wrong model
    # does to all of them at once does not show in it, and stands beside it.
    scores = np.array([w * cell.columns.T @ rest for w, rest, cell in zip(weights, left, cells, strict=True)])
    share = len(cells) / max(len(cells) - free.shape[1], 1)
    wrong = sum(w * cell.columns.T @ cell.wrong for w, cell in zip(weights, cells, strict=True))
    middle = share * scores.T @ scores + wrong @ wrong.T / max(wrong.shape[1], 1)
    return Delays(values, inverse @ middle @ inverse, len(cells))


def _null_space(held: Array) -> Array:
    """Columns (delays, f) that span all delays with held @ delays = 0."""
    _, sizes, rows = np.linalg.svd(held)
    return np.asarray(rows[int((sizes > 1e-9).sum()) :].T)


def _cells(balance: Balance) -> list[_Cell]:
    """Every axis in every band that closes."""
    errors = balance.model_errors if len(balance.model_errors) else np.zeros((0, *balance.predicted.shape))
    stacked = np.concatenate([balance.predicted[None], balance.measured, balance.by_delay, errors])
    sensors, delays, found = len(balance.measured), len(balance.by_delay), []
    flat = np.ascontiguousarray(stacked.transpose(1, 0, 2).reshape(stacked.shape[1], -1))
    enough = LEAST_SHARE * np.var(balance.measured.sum(axis=0), axis=0)
    for width, filtered, _, stride in banded(flat, balance.period):
        # Of a few seconds, a slow band holds fewer independent values than there are gains and delays: these explain
        # all of it, whatever they are.
        freedom = 2 * width * stride * balance.period * len(filtered) - sensors
        if freedom <= delays:
            continue
        band = filtered.reshape(-1, *stacked.shape[::2])
        for axis, least in zip(band.transpose(2, 0, 1), enough, strict=True):
            predicted, measured, others = axis[:, 0], axis[:, 1 : 1 + sensors], axis[:, 1 + sensors :]
            total = measured.sum(axis=1)
            gains = np.column_stack([predicted, measured[:, 1:] - measured[:, :1]])
            both = np.column_stack([predicted - total, others])
            clear = without(orthonormal(gains), both)
            missing, columns, wrong = clear[:, 0], clear[:, 1 : 1 + delays], clear[:, 1 + delays :]
            rest = without(orthonormal(columns), missing)
            gain = float(total @ predicted) / max(float(predicted @ predicted), 1e-300)
            explains = float(rest @ rest) < (1 - LEAST_EXPLAINED) * float(total @ total)
            if explains and GAIN_BAND[0] < gain < GAIN_BAND[1] and total @ total > least * len(total):
                floor = MODEL_ERROR**2 * float(predicted @ predicted)
                floor += float(np.sum(wrong**2)) / max(wrong.shape[1], 1)
                found.append(_Cell(missing, columns, wrong, floor, freedom))
    return found
