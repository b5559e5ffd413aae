"""Zeros of the force sensors, read while their foot is in the air.

A lifted foot carries what hangs below its sensor and that part's inertia, a few newtons; what else the sensor reads is
its zero. Each swing shows it once, all swings of a recording its drift.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar.conventions import FORCE, SHOWN, TORQUE, Array, Mask
from plantar.estimation.errors_in_variables import NORMAL
from plantar.results.walk_rows import SwingZero
from plantar.signals.segments import runs

FEWEST_SWINGS = 2  # of a foot that nobody sees lifted: fewer may be a foot that slides along
FEWEST_FOR_DRIFT = 4  # swings: a line through fewer follows their scatter
SHORTEST_SWING = 0.1  # s of the middle of a swing: its first and last quarter may still touch the ground
LOADED = 0.5  # of the weight, that a foot carries in its stances: one that does not share it with the other
LARGEST_ZERO = 0.2  # of the weight: a foot that reads more at its lightest is not in the air
IN_AIR = 0.4  # of the way from air to stance: so high that a foot which only sways is seen to go on changing
FLAT = 0.015  # of the weight: what a foot reads in the middle of a swing hardly changes
ALIKE = 0.1  # of the weight: swings read so alike, drift and all; a robot at rest puts a quarter or more on a foot


@dataclass(frozen=True)
class AirZero:
    """A sensor's zero: `middle` (6,) [N, N·m] at the time `about` [s], `drift` (6,) [1/s], and by how much single
    swings `scatter` (6,) about that line; `when` (S,) [s] and what each swing `read`, (S, 6)."""

    middle: Array
    drift: Array
    scatter: Array
    about: float
    when: Array
    read: Array

    @property
    def swings(self) -> int:
        """How many swings show it."""
        return len(self.when)

    @property
    def text(self) -> str:
        """What was found, in a sentence."""
        x, y, z = self.middle[:3]
        differ = f"{self.swings} swings, which differ by {np.max(self.scatter[:3]):.2g} N"
        swings = differ if self.swings > 1 else "1 swing"
        return (
            f"in the air its force sensor reads {x:.3g}, {y:.3g}, {z:.3g} N ({swings}): taken off as its zero"
        )

    def at(self, time: Array) -> Array:
        """The zero (N, 6) at times (N,) [s]."""
        return np.asarray(self.middle + (time - self.about)[:, None] * self.drift)

    def rows(self, motion: str, foot: str) -> list[SwingZero]:
        """Each swing as a row of the result."""
        parts = (FORCE, TORQUE)
        return [
            SwingZero(
                motion, foot, float(time), *(_vector(six[part]) for six in (read, zero) for part in parts)
            )
            for time, read, zero in zip(self.when, self.read, self.at(self.when), strict=True)
        ]


def air_zero(
    time: Array, wrench: Array, force_z: Array, weight: float, lifted: Mask | None = None
) -> AirZero | None:
    """The zero of a sensor whose foot swings; None where it does not.

    time: (N,) [s]; wrench: as recorded, (N, 6); force_z: its vertical force (N,) [N]; weight: the robot's [N];
    lifted: where the sole is above that of another foot which carries the robot, (N,): a foot that sways reads little
    at times, too. None where nobody knows: then FEWEST_SWINGS have to look alike.
    """
    known = np.isfinite(force_z) & np.isfinite(wrench).all(axis=1)
    if not known.any():
        return None
    low, high = np.percentile(force_z[known], [2, 98])
    if high < LOADED * weight or abs(low) > LARGEST_ZERO * weight:
        return None
    light = known & (force_z < low + IN_AIR * (high - low))
    fewest = FEWEST_SWINGS if lifted is None else 1
    when, seen = _swings(time, wrench, force_z, light, lifted, low, weight)
    if lifted is not None and not len(when):  # before or after its swing the foot stands, with hardly a load
        when, seen = _swings(time, wrench, force_z, light & lifted, lifted, low, weight)
    if len(when) < fewest:
        return None
    about, drift = float(when.mean()), np.zeros(6)
    if len(seen) >= FEWEST_FOR_DRIFT:
        slope = _usual_slope(when, seen)
        left = seen - (when - about)[:, None] * slope
        uncertainty = np.std(left, axis=0) / np.sqrt(np.sum((when - about) ** 2))
        drift = np.where(np.abs(slope) > SHOWN * uncertainty, slope, 0.0)
    left = seen - (when - about)[:, None] * drift
    usual = np.median(left, axis=0)
    scatter = NORMAL * np.median(np.abs(left - usual), axis=0)
    return AirZero(usual, drift, scatter, about, when, seen)


def _swings(
    time: Array, wrench: Array, force_z: Array, light: Mask, lifted: Mask | None, low: float, weight: float
) -> tuple[Array, Array]:
    """When a foot swings that is `light`, (S,) [s], and what its sensor reads then, (S, 6)."""
    places, values = [], []
    for swing in runs(light):
        quarter = (swing.stop - swing.start) // 4
        middle = slice(swing.start + quarter, swing.stop - quarter)
        long_enough = time[middle.stop - 1] - time[middle.start] >= SHORTEST_SWING
        flat = long_enough and np.std(force_z[middle]) < FLAT * weight
        flat = flat and (lifted is None or lifted[middle].any())
        # A robot that stands still before its first step and after its last one reads the same for a while, too: all
        # that does, where no swing is long enough to be flat. So what counts is what the foot reads at its lightest.
        if flat and np.median(force_z[middle]) < low + ALIKE * weight:
            places.append(float(np.mean(time[middle])))
            values.append(np.median(wrench[middle], axis=0))
    return np.array(places), np.array(values)


def _vector(three: Array) -> tuple[float, float, float]:
    x, y, z = three.tolist()
    return x, y, z


def _usual_slope(when: Array, seen: Array) -> Array:
    """Median of the slopes between all pairs of swings (Theil and Sen), (6,): a swing that touches moves it little."""
    first, second = np.triu_indices(len(when), 1)
    return np.asarray(np.median((seen[second] - seen[first]) / (when[second] - when[first])[:, None], axis=0))
