"""May this number be used? A verdict per parameter, its reason, and the motion to record next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar.conventions import Axis
from plantar.results.feet import ValidationRow, Verdict
from plantar.results.feet_rows import USABLE_WIDTH, WEAK_WIDTH

LEAST_SECONDS = 3.0  # of used samples
LEAST_EXCITATION = 1e-7  # rad rms: no sensor tells as little, it is rounding
SHORT_SECONDS = 10.0  # likewise: in less, what is slower than 0.1 Hz, as drift is, has not shown itself
LEAST_EXPLAINED = 0.3  # share of the torque's variance that the model must explain
GOOD_EXPLAINED = 0.8  # likewise, for a number to be usable
LATE = "find out how late the force sensors are (arm sweeps of 0.3 to 1 Hz, or --wrench-delay); check signs and filters"
SIGNS = "check sign and rpy of this foot's wrench, link and rpy of the IMU, signs of the joints: no motion helps here"
NOISY = 0.13  # of the slip angle: of simulated robots with more noise of the angle one in three had a wrong slip angle
# Share of its slope that a spring may lose as it bends. Rubber hardens; a sole that begins to turn about its edge takes
# the same torque at larger angles.
SOFTENED = 0.3
LEANING = 0.05  # of the time: shorter leans hardly move what comes behind them

SWAY = {
    "pitch": "sway the robot forward and backward",
    "roll": "sway the robot left and right",
    "z": "shift the weight from foot to foot",
}


@dataclass(frozen=True)
class Evidence:
    """What one fit shows: used `seconds`, rms of deflection [rad], share of variance explained, `lag` of the torque [s]
    that would make damping as negative (0 where it is not beyond doubt), the motion that contradicts the others (None
    where they agree), the share of the time in which the sole leans, where the model has a memory that has to go
    through that, why a model that could not be chosen is nearer to the truth (None where none is), and `noise` of a
    standing foot's angle, as much as there can be, over the slip angle of a memory. `softened`: the share of its slope
    that the spring has lost where it is bent most."""

    seconds: float
    excitation: float
    explained: float
    lag: float
    contradicted: ValidationRow | None = None
    leaning: float = 0.0
    caution: str | None = None
    noise: float = 0.0
    softened: float = 0.0

    @property
    def doubt(self) -> str | None:
        """Why the spring may be another, or have taken from an element beside it; None where neither shows."""
        if self.softened > SOFTENED:
            lost = f"the spring loses {100 * self.softened:.0f} % of its slope as it bends"
            return f"{lost}, as where a sole tips whose outline (sole: polygon) is told too large"
        if self.noise > NOISY:
            share = f"{100 * self.noise:.0f} % of the slip angle"
            return f"the angle's noise may be {share}, and hysteresis depends on the angle itself"
        return self.caution


def judge(
    foot: str, axis: Axis, term: str, value: float, interval: tuple[float, float], evidence: Evidence
) -> tuple[Verdict, str, str | None]:
    """Verdict, reason, and advice (None where none is needed) for one stiffness or damping."""
    advice = _advice(foot, axis, term)
    half = (interval[1] - interval[0]) / 2
    width = half / abs(value) if value else np.inf
    motion = f"{np.degrees(evidence.excitation):.2g} deg rms of {axis}"
    if evidence.excitation < LEAST_EXCITATION:
        return "unidentifiable", f"nothing moves: {motion}", advice
    if evidence.seconds < LEAST_SECONDS:
        return "unidentifiable", f"only {evidence.seconds:.1f} s of samples can be used", advice
    if value <= 0 and interval[1] <= 0:
        late = f", as of a torque read {1e3 * evidence.lag:.0f} ms late or more" if evidence.lag else ""
        said = f"{term} is negative{late}: something other than the bush produces this torque"
        return "unidentifiable", said, LATE if late else SIGNS
    if not np.isfinite(half):
        return "unidentifiable", "its 95 % interval could not be worked out", advice
    if interval[0] <= 0:
        return "unidentifiable", f"the 95 % interval reaches zero; the motion gave {motion}", advice
    if evidence.explained < LEAST_EXPLAINED:
        share = f"{100 * max(evidence.explained, 0):.0f} %"
        return "unidentifiable", f"the model explains {share} of the torque's variance", advice
    if width > WEAK_WIDTH:
        return (
            "unidentifiable",
            f"the 95 % interval is ±{100 * width:.0f} %; the motion gave {motion}",
            advice,
        )
    if evidence.lag:
        late = f"damping is negative, as of a torque read {1e3 * evidence.lag:.0f} ms late or more"
        return "weak", f"{late}: something other than the bush contributes to this torque", LATE
    if evidence.contradicted is not None:
        row = evidence.contradicted
        return (
            "weak",
            f"misses {row.motion} by {row.mean_abs_error:.2g} N.m on average, where a constant misses by "
            f"{row.zero_mean_abs:.2g} (both beside slow drift), although the model holds in other motions",
            f"check in {row.motion} the encoders between IMU and foot, and whether anything touched the robot",
        )
    if evidence.leaning > LEANING:
        return (
            "weak",
            f"the sole leans for {100 * evidence.leaning:.0f} % of the time, where hysteresis cannot be followed",
            f"{_advice(foot, axis, term)}: the centre of pressure has to stay inside the sole",
        )
    if evidence.doubt is not None:
        return "weak", evidence.doubt, _advice_in_doubt(foot, axis, evidence)
    if evidence.seconds < SHORT_SECONDS:
        told = (
            f"only {evidence.seconds:.1f} s of samples are used, too short to tell slow drift from the foot"
        )
        return "weak", f"{told} (valid: {SHORT_SECONDS:.0f} s or more)", advice
    if width > USABLE_WIDTH:
        return "weak", f"the 95 % interval is ±{100 * width:.0f} %; the motion gave {motion}", advice
    if evidence.explained < GOOD_EXPLAINED:
        return (
            "weak",
            f"the model explains only {100 * evidence.explained:.0f} % of the torque's variance",
            advice,
        )
    return "usable", f"95 % interval ±{100 * width:.2g} %, {evidence.seconds:.0f} s used", None


def judge_term(
    value: float, interval: tuple[float, float], evidence: Evidence
) -> tuple[Verdict, str, str | None]:
    """Verdict and reason for a further term of a richer model."""
    half = (interval[1] - interval[0]) / 2
    width = half / abs(value) if value else np.inf
    if not interval[0] * interval[1] > 0 or not np.isfinite(width):
        return "unidentifiable", "the 95 % interval reaches zero", None
    if evidence.doubt is not None:
        return "weak", evidence.doubt, None
    return ("usable" if width < 2 * USABLE_WIDTH else "weak"), f"95 % interval ±{100 * width:.2g} %", None


def _advice_in_doubt(foot: str, axis: Axis, evidence: Evidence) -> str:
    """What takes the `doubt` away."""
    if evidence.softened > SOFTENED:
        return f"measure the {foot} sole's outline for the robot file, or sway by smaller angles"
    if evidence.noise > NOISY:
        return "use an attitude that wanders less: beside its errors the slip angle is small in any motion"
    return f"{SWAY[axis]} with its weight on the {foot} foot, by larger angles"


def _advice(foot: str, axis: Axis, term: str) -> str:
    pace = "faster, at 0.3 to 1 Hz" if term == "damping" else "slowly and by some degrees, at 0.1 to 0.5 Hz"
    return f"{SWAY[axis]} with its weight on the {foot} foot, {pace}, for 30 s or more, without lifting the sole's edge"
