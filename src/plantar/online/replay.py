"""A log as the estimator saw it: estimates at each sample, and the parameters it ended with."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from plantar.conventions import DAMPING_UNIT, ROTATIONAL_AXES, STIFFNESS_UNIT, Array, Axis, Mask
from plantar.online.estimates import FIELDS, Contact, Estimated, Flag, FootEstimate, foot_estimate
from plantar.results.feet_rows import Parameter, Verdict

# Half width of the 95 % interval over the value, less than in a batch result: 99 in 100 such dampings are within 8 %.
USABLE = {"stiffness": 0.1, "damping": 0.06, "slip_torque": 0.1}
UNKNOWN = 10.0  # the same, from which on a value says nothing
TOLD = 1e-3  # half width over the compliance, that no log reaches: it was told
AS_TOLD = "as in the batch result, not learnt here"
LEVEL = "horizontal forces under changing load have not shown it"
WALK = "walk, or sway with the weight on one foot and the other"
MEMORY = (Flag.PITCH_MEMORY, Flag.ROLL_MEMORY)
REMEMBERS = "the rubber has hysteresis: motions of another size have another stiffness"
UNTESTED = (Flag.PITCH_UNTESTED, Flag.ROLL_UNTESTED)
SMALL = "motions too small to show hysteresis: in larger ones the stiffness may be lower"
REST = "motions too small to test the slip torque that was given, on which this stiffness depends"
FARTHER = "bend the foot beyond its slip angle to either side, as walking does"
LATE = {
    Flag.LATE_WRENCH: "torques follow deflections as if the force sensors' delay were not the one that was given",
    Flag.LATE_IMU: "torques follow deflections as if the IMU were behind the encoders, or before them",
}
BELOW = "negative, which no bush is: force sensors that are late look like this"
TELL_DELAY = (
    "say how late they are (--wrench-delay), or let `identify feet` find it and give its result (--result)"
)
IDENTIFY = "run `plantar identify feet` on logs of this robot, and give its result (--result)"


@dataclass(frozen=True)
class Replay:
    """A log of N samples that passed through the estimator.

    time: (N,) [s]; feet: their names; rows: (N, feet, fields), see `column`; latency: of each step, (N,) [s].
    """

    time: Array = field(repr=False)
    feet: tuple[str, ...]
    rows: Array = field(repr=False)
    latency: Array = field(repr=False)

    def column(self, foot: str, name: str) -> Array:
        """One of `plantar.online.estimates.FIELDS` through the log, (N,), such as `pitch.deflection` [rad]."""
        return self.rows[:, self.feet.index(foot), FIELDS.index(name)]

    def stands(self, foot: str) -> Mask:
        """Where the foot is known to stand, (N,): a reading that is missing leaves its contact as it was."""
        away = self.column(foot, "flags").astype(int) & Flag.NOT_STANDING
        return np.asarray((self.column(foot, "contact") == Contact.STANCE) & (away == 0))

    def estimate(self, foot: str, sample: int = -1) -> FootEstimate:
        """A foot's estimate at a sample; the last one if left out."""
        return foot_estimate(self.rows[sample, self.feet.index(foot)])

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Stiffness, damping and slip torque of each foot and axis at the end, as in `result.json`; of z stiffness."""
        return tuple(self._parameters())

    @property
    def latency_us(self) -> dict[str, float]:
        """Median, 99.9 % quantile and largest time of a step [µs]."""
        median, p999 = np.percentile(self.latency, [50, 99.9])
        return {
            "median": 1e6 * float(median),
            "p999": 1e6 * float(p999),
            "max": 1e6 * float(self.latency.max()),
        }

    def _parameters(self) -> Iterator[Parameter]:
        for foot in self.feet:
            last = self.estimate(foot)
            found_axes = zip(ROTATIONAL_AXES, (last.pitch, last.roll), MEMORY, UNTESTED, strict=True)
            for axis, found, memory, untested in found_axes:
                stiffness = _parameter(foot, axis, "stiffness", STIFFNESS_UNIT[axis], found.stiffness)
                damping = _parameter(foot, axis, "damping", DAMPING_UNIT[axis], found.damping)
                modelled, small = bool(found.slip_torque.std), bool(last.flags & untested)
                late = [reason for flag, reason in LATE.items() if last.flags & flag]
                if late:
                    stiffness, damping = (_weakened(row, late[0], IDENTIFY) for row in (stiffness, damping))
                elif small and modelled:
                    stiffness = _weakened(stiffness, REST, FARTHER)
                elif small or last.flags & memory:
                    reason = REMEMBERS if last.flags & memory else SMALL
                    stiffness, damping = (_weakened(row, reason, IDENTIFY) for row in (stiffness, damping))
                yield from (stiffness, damping)
                if modelled:
                    yield _parameter(foot, axis, "slip_torque", "N.m", found.slip_torque)
            yield _vertical(foot, last.compliance)


def _vertical(foot: str, compliance: Estimated) -> Parameter:
    """The vertical stiffness: one over the slide's compliance, whose interval turns round."""
    value, half = compliance.value, compliance.half_width
    row = partial(Parameter, foot, "z", "stiffness", STIFFNESS_UNIT["z"])
    if value > 0.0 and half <= TOLD * value:
        return row(1 / value, None, None, None, "weak", AS_TOLD)
    if half >= value:
        return row(None, None, None, None, "unidentifiable", LEVEL, WALK)
    reason = _too_wide("stiffness", half / value)
    interval = (1 / (value + half), 1 / (value - half))
    return row(1 / value, compliance.std / value**2, interval, None, "weak" if reason else "usable", reason)


def _too_wide(name: str, share: float) -> str:
    """Why a number whose interval is `share` of it to either side may not be used; empty where it may."""
    if share <= USABLE[name]:
        return ""
    return f"± {100 * share:.3g} % so far; enough from ± {100 * USABLE[name]:.0f} % on"


def _weakened(row: Parameter, reason: str, advice: str) -> Parameter:
    verdict: Verdict = "weak" if row.verdict == "usable" else row.verdict
    return replace(row, verdict=verdict, reason=reason, advice=advice)


def _parameter(foot: str, axis: Axis, name: str, unit: str, found: Estimated) -> Parameter:
    value, half = found.value, found.half_width
    row = partial(Parameter, foot, axis, name, unit)
    if half >= UNKNOWN * abs(value):
        return row(None, None, None, None, "unidentifiable", "nothing has excited it yet")
    interval = (value - half, value + half)
    if value + half < 0.0:
        return row(value, found.std, interval, None, "unidentifiable", BELOW, TELL_DELAY)
    reason = _too_wide(name, half / abs(value))
    verdict: Verdict = "unidentifiable" if half >= abs(value) else "weak" if reason else "usable"
    return row(value, found.std, interval, None, verdict, reason)
