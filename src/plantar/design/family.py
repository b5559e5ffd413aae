"""What a designed motion is made of: displacements of the body and the feet, each a sum of sines in a window."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.motions.profile import window

# The centre of mass forward, left and up [m], the root link about x and y [rad], the arms [share of a swing], and each
# ankle about its bush's x and y [rad]: soft soles stay flat, so what an ankle turns is what its bush bends.
CHANNELS: Final = (
    "centre.x", "centre.y", "centre.z", "trunk.roll", "trunk.pitch", "arms",
    "left.roll", "left.pitch", "right.roll", "right.pitch",
)  # fmt: skip
REST: Final = 2.0  # s of standing still before and after
RAMP: Final = 4.0  # s in which the motion swells and dies away
LINES: Final = 3  # sines of each channel
# Hz, lowest and highest line of a channel. A foot is told its damping by what is quick, its stiffness by what is large;
# above 1.2 Hz joints and servos of large robots follow badly, and `identify feet` listens up to 5 Hz. The load is led
# from foot to foot slowly. Arms and trunk swing at 0.3 to 1 Hz: from that the delay of the sensors shows.
BANDS: Final = {
    "centre.x": (0.08, 0.5), "centre.y": (0.05, 0.5), "centre.z": (0.1, 0.6), "trunk.roll": (0.3, 1.0),
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
        step = 1.0 / (duration - 2 * REST - RAMP)
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

    def time(self, rate: float) -> Array:
        """Times (N,) [s] from 0 to the end, `rate` [Hz]."""
        return np.arange(round(self.duration * rate) + 1) / rate

    def shapes(self, time: Array) -> Array:
        """Sine and cosine of every line in the window, (channels, 2·LINES, N)."""
        eased = window(time, REST, self.duration - REST, RAMP)
        angle = 2 * np.pi * self.frequencies[:, :, None] * (time - REST)
        return np.concatenate([np.sin(angle), np.cos(angle)], axis=1) * eased

    @cached_property
    def size(self) -> int:
        """How many coefficients a motion has."""
        return len(CHANNELS) * 2 * LINES

    def displacements(self, coefficients: Array, time: Array) -> Array:
        """The channels (channels, N) of a motion with coefficients (size,)."""
        table = coefficients.reshape(len(CHANNELS), 2 * LINES)
        return np.asarray(np.einsum("cl,cln->cn", table, self.shapes(time)))
