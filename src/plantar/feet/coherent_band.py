"""Up to which frequency angle and torque of a walking robot's feet belong together.

A leg that swings shakes the foot in modes of its own, an estimator smooths the attitude, sensors are read apart: above
some frequency torque and angle no longer follow each other, whatever the bush. The fit's filter stays below it. That
frequency is where their coherence falls below one half, over windows within stances (P. D. Welch, IEEE Trans. Audio and
Electroacoustics 15, 1967).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.contact.deflection import BushState
from plantar.contact.stances import Stances
from plantar.conventions import Array
from plantar.feet.recording import Recording
from plantar.signals.segments import runs

WINDOW = 1.0  # s: about a stance; it resolves 1 Hz
COHERENT = 0.5  # of the torque's power explained by the angle, at least
FEWEST_WINDOWS = 12  # below it chance alone gives coherences of some tenths
LOWEST = 1.5  # Hz: steps of a second would be smoothed away below it

Spectrum = NDArray[np.complex128]


def coherent_band(recordings: Sequence[Recording]) -> float:
    """The highest frequency [Hz] up to which angle and torque of stepping feet are coherent, infinite where no foot
    steps or too few stances are long enough to tell."""
    spectra: list[Spectrum] = []
    for recording in recordings:
        for foot, stances in recording.stances.items():
            if stances is not None:
                spectra += _window_spectra(recording.raw[foot], stances, recording.period)
    if len(spectra) < FEWEST_WINDOWS:
        return np.inf
    shared = min(each.shape[-1] for each in spectra)  # of the slowest log
    return _crossing(_coherence(np.array([each[..., :shared] for each in spectra])))


def _window_spectra(raw: BushState, stances: Stances, period: float) -> list[Spectrum]:
    """Spectra (2 axes, 2 signals, frequencies) of angle and torque over windows within each stance."""
    width = round(WINDOW / period)
    taper, time = np.hanning(width)[None, :, None], np.linspace(-1.0, 1.0, width)
    both, found = np.stack([raw.deflection, raw.torque]), []
    for run in runs(np.asarray((stances.number >= 0) & np.isfinite(both).all(axis=(0, 2)))):
        for first in range(run.start, run.stop - width + 1, max(1, width // 2)):
            part = both[:, first : first + width]
            slope = np.einsum("n,snx->sx", time, part) / (time @ time)
            flat = part - part.mean(axis=1, keepdims=True) - time[None, :, None] * slope[:, None, :]
            found.append(np.fft.rfft(flat * taper, axis=1).transpose(2, 0, 1))
    return found


def _coherence(spectra: Spectrum) -> Array:
    """Mean over axes of the squared coherence, (frequencies,), of windows (w, axes, 2, frequencies), less its bias."""
    cross = np.abs(np.mean(spectra[:, :, 0].conj() * spectra[:, :, 1], axis=0)) ** 2
    power = np.mean(np.abs(spectra) ** 2, axis=0).prod(axis=1)
    squared = cross / np.maximum(power, np.finfo(float).tiny)
    return np.asarray(np.mean(squared - (1 - squared) / len(spectra), axis=0))


def _crossing(coherence: Array) -> float:
    """Where the coherence at 1, 2, ... / WINDOW first falls below COHERENT, between two of them by a straight line."""
    low = np.flatnonzero(coherence[1:] < COHERENT)
    if not low.size:
        return np.inf
    place = int(low[0]) + 1
    if place == 1:
        return LOWEST
    before, behind = float(coherence[place - 1]), float(coherence[place])
    return max(LOWEST, (place - 1 + (before - COHERENT) / (before - behind)) / WINDOW)
