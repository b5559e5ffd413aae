"""Delays of several sensors beside each other, where one delay common to all may not do.

Newton's law closes when every sensor is read at its own moment: what is missing of it at the moments recorded is, to
first order, each sensor's delay times how the balance changes with it. The common delay has its own estimate
(`estimation/delay.py`); this one is for telling sensors apart, and for their delays where they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import Array
from plantar.estimation.delay import BAND_EDGES, GAIN_BAND, LEAST_EXPLAINED, MODEL_ERROR, SAMPLES_PER_CYCLE
from plantar.signals.filters import low_pass

ROUNDS = 3  # of weighing cells by what the solution leaves of them
FEWEST_CELLS = 6  # axes in bands that must close


@dataclass(frozen=True)
class Balance:
    """Newton's law of one recording over six axes: `predicted` (n, 6) less the sum of `measured` (sensors, n, 6).

    `by_delay` (delays, n, 6) is how that difference grows with each sensor's delay [per s]. Evenly sampled, without
    NaN, equally filtered.
    """

    predicted: Array
    measured: Array
    by_delay: Array
    period: float


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
    cells = [cell for balance in balances for cell in _cells(balance)]
    if len(cells) < FEWEST_CELLS:
        return None
    count = len(balances[0].by_delay)
    free = np.eye(count) if held is None or not len(held) else _null_space(held)
    values = np.zeros(count)
    weights = np.array([len(missing) / float(missing @ missing) for missing, _, _ in cells])
    for _ in range(ROUNDS):
        information = sum(w * columns.T @ columns for w, (_, columns, _) in zip(weights, cells, strict=True))
        reduced = free.T @ information @ free
        scale = np.sqrt(np.diag(reduced))
        if not (scale > 0).all() or np.linalg.cond(reduced / np.outer(scale, scale)) > 1e6:
            return None
        product = sum(
            w * columns.T @ missing for w, (missing, columns, _) in zip(weights, cells, strict=True)
        )
        values = free @ np.linalg.solve(reduced, free.T @ product)
        left = [missing - columns @ values for missing, columns, _ in cells]
        weights = np.array(
            [len(rest) / float(rest @ rest + floor) for rest, (_, _, floor) in zip(left, cells, strict=True)]
        )
    inverse = free @ np.linalg.inv(reduced) @ free.T
    # Cells disagree by more than noise where the robot's model is wrong: each is one draw of that.
    scores = np.array(
        [w * columns.T @ rest for w, rest, (_, columns, _) in zip(weights, left, cells, strict=True)]
    )
    share = len(cells) / max(len(cells) - free.shape[1], 1)
    return Delays(values, share * inverse @ (scores.T @ scores) @ inverse, len(cells))


def _null_space(held: Array) -> Array:
    """Columns (delays, f) that span all delays with held @ delays = 0."""
    _, sizes, rows = np.linalg.svd(held)
    return np.asarray(rows[int((sizes > 1e-9).sum()) :].T)


def _cells(balance: Balance) -> list[tuple[Array, Array, float]]:
    """Every axis in every band that closes, with gains of prediction and sensors taken off.

    Each is what is missing (n,), how it grows with the delays (n, delays), and squares of the model's own error.
    """
    stacked = np.concatenate([balance.predicted[None], balance.measured, balance.by_delay])
    sensors, period, found = len(balance.measured), balance.period, []
    flat = np.ascontiguousarray(stacked.transpose(1, 0, 2).reshape(stacked.shape[1], -1))
    edges = [edge for edge in BAND_EDGES if edge < 0.4 / period]
    layers = [low_pass(flat, period, edge) for edge in edges]
    for place, edge in enumerate(edges[1:]):
        thin = slice(None, None, max(1, int(1 / (SAMPLES_PER_CYCLE * edge * period))))
        band = (layers[place + 1] - layers[place])[thin].reshape(-1, *stacked.shape[::2])
        for axis in band.transpose(2, 0, 1):
            predicted, measured, columns = axis[:, 0], axis[:, 1 : 1 + sensors], axis[:, 1 + sensors :]
            total = measured.sum(axis=1)
            gains = np.column_stack([predicted, measured[:, 1:] - measured[:, :1]])
            both = np.column_stack([predicted - total, columns])
            clear = both - gains @ np.linalg.lstsq(gains, both, rcond=None)[0]
            missing, columns = clear[:, 0], clear[:, 1:]
            rest = missing - columns @ np.linalg.lstsq(columns, missing, rcond=None)[0]
            gain = float(total @ predicted) / max(float(predicted @ predicted), 1e-300)
            if (
                float(rest @ rest) < (1 - LEAST_EXPLAINED) * float(total @ total)
                and GAIN_BAND[0] < gain < GAIN_BAND[1]
            ):
                found.append((missing, columns, MODEL_ERROR**2 * float(predicted @ predicted)))
    return found
