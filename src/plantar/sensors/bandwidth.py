"""Sensors behind a low-pass that others do not have: told by Newton's law, band by band.

A force sensor at 5 Hz beside encoders at 100 Hz reads less the faster the motion is. No delay makes up for that, and
damping, which fast motion shows, follows it. What is measured over what is predicted then falls with frequency.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import SURE, Array
from plantar.estimation.delays.lag_search import WINDOW
from plantar.notes import Note
from plantar.sensors.newton_euler import NewtonEulerResidual

Spectra = NDArray[np.complex128]

FILTERED = "filtered"
BAND = (0.5, 6.0)  # Hz: slower motion shows no low-pass, and Newton's law itself is looked at below 8 Hz
COHERENT = 0.9  # squared coherence, from which a frequency counts
FEWEST = 12  # axes and frequencies that do
# Of the logarithm of a gain at one frequency: masses and places of a URDF make as much.
LEAST_DEVIATION = 0.01
SLOWEST = 9.0  # Hz: behind a low-pass above it damping is off by less than some percent


class Fading(NamedTuple):
    """How the gain of what is measured over what is predicted falls: its logarithm by `slope` f², with `std` [s²]."""

    slope: float
    std: float

    @property
    def corner(self) -> float:
        """Of a low-pass of first order that fades so [Hz], on either side."""
        return float(1 / np.sqrt(2 * abs(self.slope)))


def fading(residuals: Sequence[NewtonEulerResidual]) -> Fading | None:
    """The slope over all axes and logs in which Newton's law closes; None where too little is coherent to tell."""
    spectra = [one for residual in residuals for one in _spectra(residual)]
    if not spectra:
        return None
    frequency, count = spectra[0][0], len(spectra)
    of_predicted, of_measured, between = (np.sum([one[1][k] for one in spectra], axis=0) for k in range(3))
    coherence = np.abs(between) ** 2 / np.maximum(of_predicted.real * of_measured.real, np.finfo(float).tiny)
    places, axes = np.nonzero(coherence > COHERENT)
    if len(places) < FEWEST:
        return None
    missing = 1 - coherence[places, axes]
    gains = 0.5 * np.log(of_measured.real[places, axes] / of_predicted.real[places, axes])
    # Chance, and noise on one side alone, which no averaging takes off.
    weights = 1 / (missing / count + (missing / 2) ** 2 + LEAST_DEVIATION**2)
    columns = np.column_stack([frequency[places] ** 2, axes[:, None] == np.unique(axes)])
    normal = columns.T @ (weights[:, None] * columns)
    if np.linalg.matrix_rank(normal) < len(normal):
        return None
    found = np.linalg.solve(normal, columns.T @ (weights * gains))
    misfit = float(weights @ (gains - columns @ found) ** 2) / max(len(gains) - len(found), 1)
    return Fading(float(found[0]), float(np.sqrt(max(misfit, 1.0) * np.linalg.inv(normal)[0, 0])))


def _spectra(residual: NewtonEulerResidual) -> list[tuple[Array, tuple[Spectra, Spectra, Spectra]]]:
    """Of each segment the frequencies (k,) [Hz], and both sides' powers and their product, (k, 6)."""
    pair, length = residual.pair, round(WINDOW / residual.pair.period)
    window, frequency = np.hanning(length)[:, None], np.fft.rfftfreq(length, pair.period)
    kept = (frequency >= BAND[0]) & (frequency <= BAND[1])
    found = []
    for start in range(0, len(pair.predicted) - length + 1, length // 2):
        rows = [side[start : start + length] for side in (pair.predicted, pair.measured)]
        predicted, measured = (np.fft.rfft((row - row.mean(axis=0)) * window, axis=0)[kept] for row in rows)
        powers = (predicted * predicted.conj(), measured * measured.conj(), measured * predicted.conj())
        found.append((np.asarray(frequency[kept]), powers))
    return found


def slow_filter(found: Fading | None) -> Fading | None:
    """What was found, where it is surely a low-pass so slow that damping is off."""
    if found is None or found.corner > SLOWEST or abs(found.slope) < SURE * found.std:
        return None
    return found


def fading_notes(found: Fading | None) -> list[Note]:
    """A warning where one side is behind a slow filter."""
    if found is None:
        return []
    faded, other = ("forces and torques", "IMU and encoders")[:: 1 if found.slope < 0 else -1]
    text = (
        f"{faded} fade beside {other} as motion gets faster, as behind a low-pass of {found.corner:.2g} Hz, and "
        "damping follows them (valid: filters far above the motion's frequencies, or the same one on all sensors; an "
        "IMU that sits elsewhere than the robot file says looks alike)"
    )
    return [Note(FILTERED, "warning", text)]
