"""How a device reads a signal: noise at its own rate, a low-pass filter, and a bus that holds the last value."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfilt, sosfilt_zi

from plantar.conventions import Array

RATE: Final = 1000.0  # Hz, of the devices' own samples
ORDER: Final = 2  # of their low-pass filters (Butterworth)


def device_reading(
    values: Array, time: Array, white: float, cutoff: float, hold: float, random: np.random.Generator
) -> Array:
    """What a log holds at `time` (N,) of a signal `values` (N,) that a device read.

    The device adds white noise of deviation `white` to each of its samples and filters them causally at `cutoff` [Hz]
    (0: not); its bus passes a new value every `hold` [s] (0: each), which the log repeats.
    """
    if not cutoff and not hold:
        return values + (random.normal(0, white, values.shape) if white else 0.0)
    count = round((time[-1] - time[0]) * RATE) + 1
    own = time[0] + np.arange(count) / RATE
    read = CubicSpline(time, values)(own) + (random.normal(0, white, count) if white else 0.0)
    if cutoff:
        sections = butter(ORDER, cutoff, fs=RATE, output="sos")
        read = sosfilt(sections, read, zi=sosfilt_zi(sections) * values[0])[0]
    place = np.clip(np.round((time - time[0]) * RATE).astype(np.intp), 0, count - 1)
    step = max(1, round(hold * RATE))
    return np.asarray(read[place - place % step])
