"""Both sides of Newton's law in its six rows, and the segment of a log in which they agree.

Force sensors' errors that follow the load are taken off first: of a robot that steps they are as large as its motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from plantar.conventions import FORCE, Array
from plantar.estimation.delays.delay import LEAST_CLOSED, Pair, unexplained
from plantar.robot.uncertainty import Uncertainty
from plantar.sensors.load_errors import FootLoads, load_errors
from plantar.signals.filters import low_pass
from plantar.signals.segments import longest_run

SLOW = 0.05  # Hz: below it both sides differ by postures and drifting zeros
# Hz, likewise, where standing soles say how the robot accelerates: an attitude that wanders leans more below it, and
# what is differentiated twice is noise above it.
STOOD = (0.15, 4.0)
WINDOW = 2.0  # s, in which the forces must follow from the prediction
ROUNDS = 2  # over all samples first, which tells where nobody pushes, then over these


class Closed(NamedTuple):
    """The samples `calm` in which the law holds, as a `pair` of all feet together; of each foot what its sensor
    `measured` and its `rates` (feet, n, 6), without the sensors' errors, which together are what was `taken` (n, 6).
    """

    calm: slice
    pair: Pair
    measured: Array
    rates: Array
    taken: Array


@dataclass(frozen=True)
class NewtonSides:
    """What feet read, `loads`, with the `transfers` (n, 6, 6) that carry each foot's readings to the law's rows, what
    is `predicted` (n, 6) there, and how that less what feet read changes with the moment at which encoders are read,
    `by_encoders` (n, 6); `band`: as of `moving`, which these two are.
    """

    loads: FootLoads
    transfers: Sequence[Array]
    predicted: Array
    by_encoders: Array
    period: float
    band: Sequence[float]

    def closed(self, uncertainty: Uncertainty, label: str, shortest: int) -> Closed | None:
        """The longest segment in which the law holds; None where that has fewer than `shortest` samples."""
        loads, transfers, period, band = self.loads, self.transfers, self.period, self.band
        measured = moving(carried(transfers, loads.readings), period, band)
        rates = moving(carried(transfers, loads.changes), period, band)
        by_load = np.array([moving([*columns], period, band) for columns in loads.columns(transfers)])
        calm, taken = slice(0, len(self.predicted)), np.zeros_like(measured)
        for _ in range(ROUNDS):
            missing = measured[:, calm].sum(axis=0) - self.predicted[calm]
            late = [rates[:, calm].sum(axis=0), self.by_encoders[calm]]
            errors = load_errors(uncertainty, loads.directions, by_load[..., calm, :], late, missing, period)
            taken = np.einsum("fk,fknr->fnr", errors, by_load)
            calm = longest_closed((measured - taken).sum(axis=0), rates.sum(axis=0), self.predicted, period)
            if calm.stop - calm.start < shortest:
                return None
        own, taken = (measured - taken)[:, calm], taken[:, calm].sum(axis=0)
        own_rates = moving(carried(transfers, loads.changes_without(errors)), period, band)[:, calm]
        pair = Pair(label, own.sum(axis=0), own_rates.sum(axis=0), self.predicted[calm], period)
        return Closed(calm, pair, own, own_rates, taken)


def carried(transfers: Sequence[Array], readings: Array) -> list[Array]:
    """Each foot's part (n, 6) of the law's rows; readings: (n, 6 feet)."""
    split = readings.reshape(len(readings), -1, 6).transpose(1, 0, 2)
    return [(one @ own[..., None])[..., 0] for one, own in zip(transfers, split, strict=True)]


def moving(sides: Sequence[Array], period: float, band: Sequence[float]) -> Array:
    """Sides (k, n, 6) in a `band` [Hz] from what postures and drifting zeros do to them to what is noise."""
    rows = np.hstack(sides)
    quick = low_pass(rows, period, band[1]) if np.isfinite(band[1]) else rows
    return (quick - low_pass(rows, period, band[0])).reshape(len(rows), -1, 6).transpose(1, 0, 2)


def longest_closed(measured: Array, rate: Array, predicted: Array, period: float) -> slice:
    """The longest segment in which nobody pushes and nothing strikes: there the forces follow from the prediction."""
    width = round(WINDOW / period)
    usual, count = float(np.mean(np.sum(measured[:, FORCE] ** 2, axis=1))), len(measured) // width
    windows = [side[: count * width, FORCE].reshape(count, width, -1) for side in (measured, rate, predicted)]
    power = np.sum(windows[0] ** 2, axis=(1, 2)) / width
    follows = unexplained(*windows) / width < (1 - LEAST_CLOSED) * np.maximum(power, usual)
    return longest_run(np.repeat(follows, width))
