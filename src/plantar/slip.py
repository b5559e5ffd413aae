"""Does a sole slide? In double support two soles that stand cannot move against each other."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array, Mask
from plantar.signals import differentiate, low_pass, runs

SLIP_CUTOFF = 6.0  # Hz: relative motion of the soles above it is noise
LEAST_SPEED = 0.006  # m/s, and for yaw at the lever of half a sole, rad/s times YAW_LEVER
YAW_LEVER = 0.1  # m
NOISE_FACTOR = 8.0  # times the usual speed, which is the noise's
LEAST_PATH = 0.0008  # m that a slide must cover
REACH = 0.05  # s by which a slide is widened: its beginning and end are slow


def sliding(position: Array, yaw: Array, both: Mask, period: float) -> Mask:
    """Samples in which two soles slide against each other.

    position: (N, 2), one sole's origin in the other's levelled frame [m]; yaw: (N,) between them [rad]; both: where
    both feet stand. Slides in common, of both soles alike, cannot be seen.
    """
    found = np.zeros(len(yaw), dtype=bool)
    apart = np.column_stack([position, YAW_LEVER * np.unwrap(np.nan_to_num(yaw))])
    apart[~both] = np.nan
    speed = np.linalg.norm(differentiate(low_pass(apart, period, SLIP_CUTOFF), period), axis=1)
    known = np.isfinite(speed)
    if not known.any():
        return found
    threshold = max(LEAST_SPEED, NOISE_FACTOR * float(np.median(speed[known])))
    reach = round(REACH / period)
    for run in runs(known & (speed > threshold)):
        if np.sum(speed[run]) * period > LEAST_PATH:
            found[max(0, run.start - reach) : run.stop + reach] = True
    return found & both
