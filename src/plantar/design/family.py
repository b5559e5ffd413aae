"""What a designed motion is made of: displacements of the body and the feet, sums of sines in two windows.

In the first half one foot carries more and is shown, in the second half the other: there everything is mirrored.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.motions.footsteps import REST
from plantar.motions.profile import window

# The centre of mass forward, across the line through the feet, left, along it, and up [m], the root link about x and y
# [rad], the arms [share of a swing], and each ankle about its bush's x and y [rad]: soft soles stay flat, so what an
# ankle turns is what its bush bends.
CHANNELS: Final = (
    "centre.x", "centre.y", "centre.z", "trunk.roll", "trunk.pitch", "arms",
    "left.roll", "left.pitch", "right.roll", "right.pitch",
)  # fmt: skip
# Of the mirror image: which channel stands in a channel's place, and its sign.
MIRRORED: Final = {
    "centre.x": ("centre.x", 1.0), "centre.y": ("centre.y", -1.0), "centre.z": ("centre.z", 1.0),
    "trunk.roll": ("trunk.roll", -1.0), "trunk.pitch": ("trunk.pitch", 1.0), "arms": ("arms", 1.0),
    "left.roll": ("right.roll", -1.0), "left.pitch": ("right.pitch", 1.0),
    "right.roll": ("left.roll", -1.0), "right.pitch": ("left.pitch", 1.0),
}  # fmt: skip
RAMP: Final = 4.0  # s in which each half swells and dies away
LINES: Final = 2  # sines of each channel
SHAPES: Final = 1 + 2 * LINES
"""Of each channel: a place to be at, and the sine and cosine of each line."""
# Hz, lowest and highest line of a channel. A foot is told its damping by what is quick, its stiffness by what is large;
# above 1.2 Hz joints and servos of large robots follow badly, and `identify feet` listens up to 5 Hz. The load is led
# from foot to foot slowly. Arms and trunk swing at 0.3 to 1 Hz, and the body goes up and down by some millimetres, as
# quickly as legs do: from that the delay of the sensors shows.
BANDS: Final = {
    "centre.x": (0.1, 0.6), "centre.y": (0.1, 0.6), "centre.z": (0.6, 2.4), "trunk.roll": (0.3, 1.0),
    "trunk.pitch": (0.3, 1.0), "arms": (0.3, 1.0), "left.roll": (0.1, 1.2), "left.pitch": (0.1, 1.2),
    "right.roll": (0.1, 1.2), "right.pitch": (0.1, 1.2),
}  # fmt: skip


@dataclass(frozen=True)
class Lines:
    """The frequencies of a motion of `duration` [s]: `frequencies` (channels, LINES) [Hz]."""

    duration: float
    frequencies: Array

    @classmethod
    def drawn(cls, duration: float, random: np.random.Generator) -> Lines:
        """One frequency in each part of a channel's band, on a grid on which no two channels share one.

        Sines of different frequencies, whole periods each, are orthogonal: no channel hides behind another.
        """
        step = 1.0 / (duration / 2 - REST)
        taken: set[int] = set()
        rows = []
        for channel in CHANNELS:
            low, high = BANDS[channel]
            edges = np.geomspace(low, high, LINES + 1)
            row = []
            for place in range(LINES):
                number = max(1, round(float(random.uniform(*edges[place : place + 2])) / step))
                while number in taken:
                    number += 1
                taken.add(number)
                row.append(number * step)
            rows.append(row)
        return cls(duration, np.array(rows))

    @property
    def size(self) -> int:
        """How many coefficients a motion has."""
        return len(CHANNELS) * SHAPES

    def time(self, rate: float) -> Array:
        """Times (N,) [s] from 0 to the end, `rate` [Hz]."""
        return np.arange(round(self.duration * rate) + 1) / rate

    def basis(self, time: Array) -> Array:
        """What one unit of each coefficient moves, (size, channels, N)."""
        middle = self.duration / 2
        halves = [
            self._shapes(time, REST, middle + RAMP / 2),
            self._shapes(time, middle - RAMP / 2, self.duration - REST),
        ]
        moved = np.zeros((len(CHANNELS), SHAPES, len(CHANNELS), time.size))
        for row, channel in enumerate(CHANNELS):
            image, sign = MIRRORED[channel]
            moved[row, :, row] += halves[0][row]
            moved[row, :, CHANNELS.index(image)] += sign * halves[1][row]
        return moved.reshape(self.size, len(CHANNELS), time.size)

    def _shapes(self, time: Array, begin: float, end: float) -> Array:
        """Place, sines and cosines of every channel in one window, (channels, SHAPES, N)."""
        angle = 2 * np.pi * self.frequencies[:, :, None] * (time - begin)
        still = np.ones((len(CHANNELS), 1, time.size))
        return np.concatenate([still, np.sin(angle), np.cos(angle)], axis=1) * window(time, begin, end, RAMP)

    def displacements(self, coefficients: Array, time: Array) -> Array:
        """The channels (channels, N) of a motion with coefficients (size,)."""
        return np.asarray(np.tensordot(coefficients, self.basis(time), 1))

    def without(self, coefficients: Array, channel: str) -> Array:
        """The coefficients (size,) of the same motion with one channel at rest."""
        kept = coefficients.reshape(len(CHANNELS), SHAPES).copy()
        kept[CHANNELS.index(channel)] = 0.0
        return kept.ravel()
