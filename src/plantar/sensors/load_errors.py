"""What gains, crosstalk and turned mounts of force sensors make of a foot's load.

A sensor that is turned by a degree reads a fiftieth of the load sideways. Of a robot that steps this jumps with every
step, as large as the forces of its motion: Newton's law would not close, as if somebody pushed. It is proportional to
the load, and no larger than sensors and mounts usually are off, so that it can be told from a push and taken off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.conventions import FORCE, TORQUE, Array
from plantar.estimation.delays.delay import LONGEST
from plantar.robot.uncertainty import Uncertainty

TURN = 0.02  # rad: deviation of a force sensor's mount; crosstalk makes as much
LEAST_GAIN = 0.01  # share, of the forces' gains and of what their places add: nuisances need a finite prior
# N.m/N, likewise, for crosstalk and millimetres between a sensor and where the file has it.
LEAST_BETWEEN = 0.003
LEAST = 1e-4  # N/N: what no sensor is better than, and what then the law misses by
APART = 1.0  # s, after which what the law misses is missed anew: a step's time
ROUNDS = 2  # the first one's misses still hold the errors themselves


@dataclass(frozen=True)
class FootLoads:
    """What all feet read, `readings` (n, 6 feet), and how that changes, `changes` (n, 6 feet) [1/s], with the size of
    each foot's force, `loads` (n, feet) [N], and its changes, `steps` (n, feet) [N/s].
    """

    readings: Array
    changes: Array
    loads: Array
    steps: Array

    @classmethod
    def of(cls, readings: Array, changes: Array) -> FootLoads:
        forces, slopes = (each.reshape(len(each), -1, 6)[..., FORCE] for each in (readings, changes))
        loads = np.linalg.norm(forces, axis=2)
        steps = np.sum(forces * slopes, axis=2) / np.maximum(loads, np.finfo(float).tiny)
        return cls(readings, changes, loads, steps)

    @property
    def directions(self) -> Array:
        """Of each foot's force where it carries most, in its sensor's frame, (feet, 3)."""
        forces = self.readings.reshape(len(self.readings), -1, 6)[..., FORCE]
        mean = np.einsum("nf,nfx->fx", self.loads, forces)
        size = np.linalg.norm(mean, axis=1, keepdims=True)
        return np.asarray(mean / np.maximum(size, np.finfo(float).tiny))

    def columns(self, transfers: Sequence[Array]) -> list[Array]:
        """What one newton for each newton of load, in each of a sensor's channels, adds to the law's rows: of each
        foot (6, n, 6). transfers: (n, 6, 6) of each foot, from its sensor's frame.
        """
        pairs = zip(transfers, self.loads.T, strict=True)
        return [(transfer * load[:, None, None]).transpose(2, 0, 1) for transfer, load in pairs]

    def changes_without(self, errors: Array) -> Array:
        """The changes without those of `errors` (feet, 6) for each newton of load."""
        return self.changes - (self.steps[..., None] * errors).reshape(self.changes.shape)


def load_errors(
    uncertainty: Uncertainty,
    directions: Array,
    columns: Array,
    late: Sequence[Array],
    missing: Array,
    period: float,
) -> Array:
    """What each foot's sensor reads for one newton of load, (feet, 6) [N/N, N.m/N], drawn towards nothing.

    directions (feet, 3): of each foot's mean force in its sensor's frame; columns (feet, 6, n, 6): what the law's rows
    gain from each of these errors; late (k, n, 6): what they gain from delays, as large as they like; missing (n, 6):
    the rows as measured, without the prediction; period [s] of the samples.
    """
    feet, count = len(columns), 6 * len(columns) + len(late)
    rows = np.concatenate([columns.reshape(6 * feet, *missing.shape), np.asarray(late), missing[None]])
    rows = np.ascontiguousarray(rows.transpose(2, 0, 1))
    products = rows @ rows.transpose(0, 2, 1)  # of the law's rows each, with what is missing last
    precision = np.zeros((count, count))
    for foot, direction in enumerate(directions):
        own = slice(6 * foot, 6 * foot + 6)
        precision[own, own] = np.linalg.inv(_prior(uncertainty, direction))
    precision[6 * feet :, 6 * feet :] = np.eye(len(late)) / LONGEST**2
    found, left = np.zeros(count), products[:, -1, -1]
    least = LEAST**2 * float(np.mean(columns**2)) + np.finfo(float).eps
    for _ in range(ROUNDS):
        weights = period / APART / (left / len(missing) + least)
        both = np.einsum("r,rij->ij", weights, products)
        found = np.linalg.solve(both[:-1, :-1] + precision, both[:-1, -1])
        share = np.append(-found, 1.0)
        left = products @ share @ share
    return found[: 6 * feet].reshape(feet, 6)


def _prior(uncertainty: Uncertainty, direction: Array) -> Array:
    """Covariance (6, 6) of what a sensor reads wrongly for one newton along `direction` (3,): a gain along it, a turn
    across it, and crosstalk.
    """
    across = TURN**2 + uncertainty.wrench_crosstalk**2
    along, between = (
        max(uncertainty.wrench_gain, LEAST_GAIN),
        max(uncertainty.wrench_crosstalk, LEAST_BETWEEN),
    )
    covariance = np.zeros((6, 6))
    covariance[FORCE, FORCE] = across * np.eye(3) + (along**2 - across) * np.outer(direction, direction)
    covariance[TORQUE, TORQUE] = between**2 * np.eye(3)
    return covariance
