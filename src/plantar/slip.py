"""Does a sole slide? A sole that stands has no velocity, and two that stand cannot move against each other."""

from __future__ import annotations

import numpy as np

from plantar.contact import joined
from plantar.conventions import Array, Mask
from plantar.signals import differentiate, low_pass, runs

SLIP_CUTOFF = 10.0  # Hz: motion of the soles above it is noise
LEAST_SPEED = 0.002  # m/s, and for yaw at the lever of half a sole, rad/s times YAW_LEVER
YAW_LEVER = 0.1  # m
USUAL = 80  # percent of the samples are slower than the noise's usual speed, however much slides
NOISE_FACTOR = 2.6  # times that speed
LEAST_PATH = 0.0008  # m that a slide must cover
ELASTIC = 0.02  # rad: a bush gives that much about z, and neither pitch nor roll feels it
PAUSE = 0.1  # s: slides that are closer are one
REACH = 0.02  # s by which a slide is widened: its beginning and end are slow
DRIFT_WINDOW = (
    4.0  # s: what a sole's velocity does over it as a rule is drift; slides are shorter than half of it
)
DRIFT_RATE = 20.0  # Hz, enough for the drift
SHAKEN = 0.5  # s over which an integral gathers what shakes
IMPACT = 0.1  # s
LARGEST_JUMP = 0.01  # m/s: a velocity that jumps by more within an impact's time is unknown
SHORTEST_REST = 1.0  # s between two impacts: in less there is no telling a slide from a jump
BAND = 20.0  # Hz: no part of a robot that stands is shaken on purpose above it
RESISTED = 0.3  # least cosine between a slide and the friction against it: zeros and attitude turn the force
SMOOTH = 0.02  # friction over load, below which its direction is not known
ROBUST_STEPS = 5
OUTLYING = 4.7  # usual deviations: Tukey's biweight forgets what lies beyond


def sliding(position: Array, yaw: Array, both: Mask, period: float) -> Mask:
    """Samples in which two soles slide against each other.

    position: (N, 2), one sole's origin in the other's levelled frame [m]; yaw: (N,) between them [rad]; both: where
    both feet stand. Slides in common, of both soles alike, do not show.
    """
    return slides(apart_velocity(position, yaw, both, period), period) & both


def apart_velocity(position: Array, yaw: Array, both: Mask, period: float) -> Array:
    """Velocity of two soles against each other, (N, 3): x, y and yaw times YAW_LEVER [m/s]; NaN outside `both`."""
    apart = np.column_stack([position, YAW_LEVER * np.unwrap(np.nan_to_num(yaw))])
    apart[~both] = np.nan
    return np.asarray(differentiate(low_pass(apart, period, SLIP_CUTOFF), period))


def sole_twist(heading: Array, standing: Mask, period: float) -> Array:
    """How fast one sole turns on the floor, (N, 1): its heading's rate [rad/s] times YAW_LEVER; NaN in the air.

    heading: (N,) [rad]; the yaw of an IMU drifts, so that what it does over seconds is taken off.
    """
    turned = np.full(len(heading), np.nan)
    known = np.asarray(standing & np.isfinite(heading))
    for run in runs(np.asarray(np.isfinite(heading))):
        turned[run] = YAW_LEVER * np.unwrap(heading[run])
    rate = differentiate(low_pass(turned, period, SLIP_CUTOFF), period)
    rate[~known] = np.nan
    for run in runs(np.isfinite(rate)):
        rate[run] = _without_drift(rate[run], period)
    return rate[:, None]


def turning(heading: Array, standing: Mask, period: float) -> Mask:
    """Samples (N,) in which one sole turns on the floor, by more than a bush gives way about z."""
    twist = sole_twist(heading, standing, period)
    found = slides(twist, period) & standing
    for run in runs(found):
        found[run] = abs(np.nansum(twist[run])) * period > ELASTIC * YAW_LEVER
    return found


def sole_velocity(
    position: Array, heading: Array, acceleration: Array, rate: Array, standing: Mask, period: float
) -> tuple[Array, Array]:
    """Velocity of one sole over the floor, (N, 2) [m/s], in its heading's frame, and its noise (N,) [m/s].

    position: (N, 2), of the sole from the IMU in world axes [m]; heading: (N,) of the sole [rad]; acceleration: (N, 2),
    of the IMU in the world [m/s²]; rate: (N, 2), of the bush's pitch and roll [rad/s].

    The integral of the acceleration drifts: what the velocity is over seconds is taken off. So is what follows the
    bush's rates (a bush centre that the robot file has too high or too low), the acceleration (an IMU that is late) and
    the place (an attitude filter that takes slow accelerations for tilt). An impact makes the integral jump by what
    falls between two samples: NaN there and in the air, and what comes before is judged apart from what comes behind.
    """
    velocity, noise = np.full((len(heading), 2), np.nan), np.full(len(heading), np.nan)
    known = np.asarray(np.isfinite(np.column_stack([position, heading, acceleration])).all(axis=1))
    whole = np.where(known[:, None], np.column_stack([position, acceleration]), np.nan)
    smooth = low_pass(whole, period, SLIP_CUTOFF)
    place, push = smooth[:, :2], smooth[:, 2:]
    shaking = acceleration - low_pass(acceleration, period, min(BAND, 0.2 / period))
    moved = differentiate(place, period)
    pushed = differentiate(moved, period) + push
    known &= standing & np.isfinite(pushed).all(axis=1) & (_jump(shaking, period, IMPACT) < LARGEST_JUMP)
    if not known.any():
        return velocity, noise
    bias = np.median(pushed[known], axis=0)
    for run in runs(known):
        if (run.stop - run.start) * period < SHORTEST_REST:
            continue
        parts = (
            moved[run] + np.cumsum(push[run] - bias, axis=0) * period,
            np.nan_to_num(rate[run]),
            push[run],
            place[run],
        )
        turned = [part if k == 1 else _turned(part, -heading[run]) for k, part in enumerate(parts)]
        for axis in range(2):
            clear = [_without_drift(part[:, axis], period) for part in turned]
            velocity[run, axis] = _unexplained(clear[0], clear[1:])
        noise[run] = _jump(shaking[run], period, SHAKEN)
    return velocity, noise


def _jump(shaking: Array, period: float, reach: float) -> Array:
    """How far a velocity may have jumped, (N,) [m/s], by shaking (N, k) [m/s²] that is too fast for the samples.

    It is taken as white, over `reach` [s] before and behind; 0 where it is not known.
    """
    total = np.concatenate([[0.0], np.cumsum(np.sum(np.nan_to_num(shaking) ** 2, axis=1))])
    place, span = np.arange(len(shaking)), round(reach / period)
    last, first = np.minimum(place + span + 1, len(shaking)), np.maximum(place - span, 0)
    return np.asarray(period * np.sqrt(total[last] - total[first]))


def slides(velocity: Array, period: float, noise: Array | float = 0.0, friction: Array | None = None) -> Mask:
    """Samples (N,) in which a velocity (N, k) [m/s] stands out of its noise and covers a way; False where NaN.

    noise: its deviation [m/s] where that is known to change, (N,); what the speed is as a rule counts anyway.
    friction: the floor's horizontal force on the sole over its load, (N, 2), in the velocity's frame: it works against
    a slide.
    """
    speed = np.linalg.norm(velocity, axis=1)
    known = np.isfinite(speed)
    found = np.zeros(len(speed), dtype=bool)
    if not known.any():
        return found
    usual = max(LEAST_SPEED, NOISE_FACTOR * float(np.percentile(speed[known], USUAL)))
    fast = known & (speed > np.maximum(usual, 2 * np.nan_to_num(noise)))
    fast = joined(fast, round(PAUSE / period)) & known
    reach = round(REACH / period)
    for run in runs(fast):
        covered = np.sum(speed[run]) * period > LEAST_PATH
        if covered and (friction is None or _resisted(velocity[run], friction[run])):
            found[max(0, run.start - reach) : run.stop + reach] = True
    return np.asarray(found & known)


def _resisted(velocity: Array, friction: Array) -> bool:
    """Whether friction works against a slide (n, 2), as it must; less than SMOOTH is lost in the sensors' zeros."""
    size = np.linalg.norm(friction, axis=1)
    known = size[np.isfinite(size)]
    if not known.size or known.mean() < SMOOTH:
        return True
    work = float(np.nansum(velocity * friction))
    return work < -RESISTED * float(np.nansum(np.linalg.norm(velocity, axis=1) * size))


def _turned(vectors: Array, angle: Array) -> Array:
    """Vectors (N, 2) turned by `angle` (N,) [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = vectors.T
    return np.column_stack([c * x - s * y, s * x + c * y])


def _without_drift(values: Array, period: float) -> Array:
    """Values (n,) without their running median: it keeps jumps and trends, and does not see what is short."""
    from scipy.ndimage import median_filter  # costs start-up

    step = max(1, round(1 / DRIFT_RATE / period))
    places = np.arange(0, len(values), step)
    thinned = values[places]
    window = min(round(DRIFT_WINDOW / step / period), len(places)) | 1
    half = min(window // 2, len(places) - 1)
    padded = np.pad(thinned, half, mode="reflect", reflect_type="odd")
    drift = median_filter(padded, window, mode="nearest")[half : half + len(places)]
    return np.asarray(values - np.interp(np.arange(len(values)), places, drift))


def _unexplained(values: Array, columns: list[Array]) -> Array:
    """What a robust fit of `columns`, (n,) each, leaves of `values` (n,)."""
    regressor, weight = np.column_stack(columns), np.ones(len(values))
    left = values
    for _ in range(ROBUST_STEPS):
        weighted = regressor * weight[:, None]
        left = values - regressor @ np.linalg.lstsq(weighted, values * weight, rcond=None)[0]
        size = OUTLYING * 1.4826 * float(np.median(np.abs(left))) + 1e-12
        weight = np.clip(1 - (left / size) ** 2, 0.0, 1.0)
    return np.asarray(left)
