"""Speeds that a standing sole would not have: slip indicators, and the samples in which one is sure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plantar.contact.phases import joined
from plantar.conventions import SURE, Array, Mask
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.medians import running_median
from plantar.signals.segments import runs

SLIP_CUTOFF = 10.0  # Hz: motion of the soles above it is noise
RINGING = 0.07  # by which this filter overshoots a step, within a period of the cutoff
LEAST_SPEED = 0.002  # m/s, and for yaw at the moment arm of half a sole, rad/s times YAW_MOMENT_ARM
YAW_MOMENT_ARM = 0.1  # m, by which yaw [rad] counts beside the soles' distance [m]
USUAL = 80  # percent of the samples are slower than the noise's usual speed, however much slides
USUAL_SPEED = 1.794  # that percentile of a plane vector's length, in deviations of its components
QUIETEST = 1e-6  # m/s: less is no noise
POSSIBLE = 3.5  # deviations: part of a slide that is sure elsewhere
LEAST_PATH = 0.0009  # m that a slide must cover
ELASTIC = 0.02  # rad: a bush gives that much about z, and neither pitch nor roll feels it
PAUSE = 0.1  # s: slides that are closer are one
# s: what a sole's velocity does over it as a rule is drift; slides are shorter than half of it.
DRIFT_WINDOW = 4.0
DRIFT_RATE = 20.0  # Hz, enough for the drift
RESISTED = 0.3  # least cosine between a slide and the friction against it: zeros and attitude turn the force
SMOOTH = 0.05  # friction over load, below which its direction is not known


@dataclass(frozen=True)
class SlipIndicator:
    """A speed (N,) [m/s] that a sole at rest would not have, NaN where it is not known, and its deviation (N,)."""

    speed: Array
    deviation: Array

    def clearness(self, samples: slice) -> float:
        """How many deviations the speed reaches in these samples."""
        share = self.speed[samples] / np.maximum(self.deviation[samples], QUIETEST)
        return float(np.max(np.nan_to_num(share), initial=0.0))


def as_usual(speed: Array) -> SlipIndicator:
    """A speed (N,) that is noise as a rule."""
    return SlipIndicator(speed, np.full(len(speed), usual_deviation(speed)))


def usual_deviation(speed: Array) -> float:
    """Deviation of the components behind a speed (N,) that is noise as a rule; 0 where none is known."""
    known = speed[np.isfinite(speed)]
    return float(np.percentile(known, USUAL)) / USUAL_SPEED if known.size else 0.0


def slides(indicators: Sequence[SlipIndicator], way: Array, period: float) -> Mask:
    """Samples (N,) in which a sole slides.

    One slip indicator is sure of it somewhere, each sample of it is possible to one, and it covers LEAST_PATH.
    way: (N,), the speed [m/s] at which it does; the ringing of its filter beside what is fast counts as rest.
    """
    way = np.nan_to_num(way)
    ringing = RINGING * _largest_around(way, round(1 / SLIP_CUTOFF / period))
    possible, sure = (np.zeros(len(way), dtype=bool) for _ in range(2))
    for indicator in indicators:
        speed, least = np.nan_to_num(indicator.speed), np.maximum(LEAST_SPEED, ringing)
        possible |= speed > np.maximum(least, POSSIBLE * indicator.deviation)
        sure |= speed > np.maximum(least, SURE * indicator.deviation)
    found = np.zeros(len(way), dtype=bool)
    for run in runs(joined(possible, round(PAUSE / period))):
        found[run] = sure[run].any() and way[run].sum() * period > LEAST_PATH
    return found


def apart_speed(position: Array, yaw: Array, both: Mask, period: float) -> SlipIndicator:
    """Speed of two soles against each other, of x, y and yaw times YAW_MOMENT_ARM. Slides in common do not show.

    position: (N, 2), one sole's origin in the other's levelled frame [m]; yaw: (N,) between them [rad]; both: where
    both feet stand.
    """
    apart = np.column_stack([position, YAW_MOMENT_ARM * np.unwrap(np.nan_to_num(yaw))])
    apart[~both] = np.nan
    velocity = differentiate(low_pass(apart, period, SLIP_CUTOFF), period)
    return as_usual(np.sqrt(np.einsum("ni,ni->n", velocity, velocity)))


def twist_speed(heading: Array, standing: Mask, period: float) -> Array:
    """How fast one sole turns on the floor, (N,): its heading's rate [rad/s] times YAW_MOMENT_ARM; NaN in the air.

    heading: (N,) [rad]; the yaw of an IMU drifts, so that what it does over seconds is taken off.
    """
    turned = np.full(len(heading), np.nan)
    known = np.asarray(standing & np.isfinite(heading))
    for run in runs(np.asarray(np.isfinite(heading))):
        turned[run] = YAW_MOMENT_ARM * np.unwrap(heading[run])
    rate = differentiate(low_pass(turned, period, SLIP_CUTOFF), period)
    rate[~known] = np.nan
    for run in runs(np.isfinite(rate)):
        rate[run] = _without_drift(rate[run], period)
    return np.asarray(rate)


def turning(twist: Array, period: float) -> Mask:
    """Samples (N,) in which one sole turns on the floor, by more than a bush gives way about z; `twist_speed`.

    They are sure throughout: beside them it may be the bush that turns back.
    """
    speed = np.abs(twist)
    found = slides([SlipIndicator(speed, SURE / POSSIBLE * as_usual(speed).deviation)], speed, period)
    for run in runs(found):
        found[run] = abs(np.nansum(twist[run])) * period > ELASTIC * YAW_MOMENT_ARM
    return found


def unresisted(indicator: SlipIndicator, velocity: Array, friction: Array, period: float) -> Mask:
    """Samples (N,) in which a velocity (N, 2) [m/s] stands out that friction does not work against, as it must.

    friction: (N, 2), the floor's horizontal force on the sole over its load, in the velocity's axes; less than SMOOTH
    is lost in the sensors' zeros, and no slip indicator against a slide.
    """
    fast = np.nan_to_num(indicator.speed) > np.maximum(LEAST_SPEED, POSSIBLE * indicator.deviation)
    found = np.zeros(len(fast), dtype=bool)
    for run in runs(joined(np.asarray(fast), round(PAUSE / period))):
        size = np.linalg.norm(friction[run], axis=1)
        known = np.isfinite(size)
        if not known.any() or size[known].mean() < SMOOTH:
            continue
        work = float(np.nansum(velocity[run] * friction[run]))
        found[run] = work > -RESISTED * float(np.nansum(np.linalg.norm(velocity[run], axis=1) * size))
    return found


def _largest_around(values: Array, reach: int) -> Array:
    """The largest of the values (n,) up to `reach` samples from each."""
    wide, width, spanned = np.pad(values, reach, mode="edge"), 2 * reach + 1, 1
    while spanned < width:
        step = min(spanned, width - spanned)
        wide, spanned = np.maximum(wide[:-step], wide[step:]), spanned + step
    return wide


def _without_drift(values: Array, period: float) -> Array:
    """Values (n,) without their running median: it keeps jumps and trends, and does not see what is short."""
    step = max(1, round(1 / DRIFT_RATE / period))
    places = np.arange(0, len(values), step)
    thinned = values[places]
    window = min(round(DRIFT_WINDOW / step / period), len(places)) | 1
    half = min(window // 2, len(places) - 1)
    padded = np.pad(thinned, half, mode="reflect", reflect_type="odd")
    around = np.pad(padded, window // 2, mode="edge")[half : half + len(places) + window - 1]
    drift = running_median(around, window)
    return np.asarray(values - np.interp(np.arange(len(values)), places, drift))
