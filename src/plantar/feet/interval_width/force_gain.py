"""Gains of the force sensors beside the URDF's weight: what stands on the feet is what the robot weighs.

Stiffness and damping follow a sensor's gain exactly, and nothing in a foot's own torque and angle shows it. The weight
does: where it moves from foot to foot, it shows each foot's gain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import erfc
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from plantar.contact.phases import HOISTED_SHARE
from plantar.conventions import GRAVITY, NORMAL95, SHOWN, Array, Axis
from plantar.feet.interval_width.cause import Cause
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.moments.torque_gains import TorqueGain

WINDOW = 2.0  # s, over whose Hann window accelerations average out that repeat once a second and faster
CARRIED = 0.5  # of the weight: with less on its feet, the robot hangs or its sensors were zeroed under load
SCATTER = 0.005  # of the weight, by which all of a recording's sums may be off: zeros of sensors
BENT = 0.002  # of the weight, by which its sums may follow the weight from foot to foot: sensors are not quite linear
HAND = 2.0  # times the scatter of a recording's sums: what a hand may carry on average that carries now more, now less
REWEIGHTED = 5  # rounds
LOADED = 0.03  # of the weight, by which a recording's sums are off beside gains that suit the others
STEADY = 0.02  # of the weight: scatter of a recording's sums while nobody holds the robot
ALIKE = 10.0  # deviations of a gain, by which a robot's force sensors differ where one of them has a fault
LEAST_GAIN = 1e-4  # share: of sensors without any gain error, for deviations and priors that stay finite
LEAST_DEVIATION = 0.02  # of the weight: what a hand on the robot may carry of it through whole logs
SAFE = 0.5  # deviations by which a share may be larger than it looks
HALVINGS = 50  # of an interval: what is left of it is rounding
FAULTY = 0.15  # of robots: their force sensors are off by more than the robot file says,
# By such a share (standard deviation): another unit of load, an old calibration, a wrong amplifier.
FAULT = 0.1


class GainError(NamedTuple):
    """By which `share` a sensor seems to read too much, and with which `std` it is told from the other feet's.

    And the deviations of a `usual` gain and of all `other` reasons for it.
    """

    share: float
    std: float
    usual: float
    other: float

    @property
    def sure(self) -> bool:
        """Whether the robot file's uncertainty cannot explain it."""
        return abs(self.share) > SHOWN * float(np.hypot(self.usual, self.other))

    @property
    def reach(self) -> float:
        """Share of a foot's numbers by which its sensor's gain puts them wrong, with 95 % probability.

        What is seen, d, is the sum of the gain's error and of all else. Most sensors are as good as the robot file
        says, FAULTY of them far worse; either kind of error has a normal distribution given d. That a gain is off
        by more than d and something hides it is left out: d and the usual error are all that is added.
        """
        # Nothing is missing, nothing is off.
        safe = 0.0 if self.sure else SAFE * min(self.std, abs(self.share))
        seen = abs(self.share / (1 + self.share)) + safe
        sizes = np.array([self.usual, FAULT])
        total = np.hypot(sizes, self.other)
        exponents = -0.5 * (seen / total) ** 2
        odds = np.array([1 - FAULTY, FAULTY]) * np.exp(exponents - exponents.max()) / total
        mean, std = seen * (sizes / total) ** 2, np.maximum(sizes * self.other / total, LEAST_GAIN)

        def outside(reach: float) -> float:
            ends = np.array([reach - mean, reach + mean]) / (np.sqrt(2) * std)
            beyond = [0.5 * (erfc(upper) + erfc(lower)) for upper, lower in ends.T]
            return float(odds @ beyond / odds.sum())

        low, high = 0.0, 1.0 + seen
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if outside(middle) > 0.05 else (low, middle)
        return min(high, float(np.linalg.norm([seen, NORMAL95 * self.std, NORMAL95 * self.usual])))


def force_gain_errors(robot: RobotModel, recordings: Sequence[Recording]) -> dict[str, GainError]:
    """By foot, where its sensor reads more or less than the weight.

    Or than all feet together where they are farther off and the weight moves too little to tell them apart: what a
    wrong mass or a common amplifier does then shows more at one foot and less at the other.

    Gains 1/h are those for which the feet's forces add up to the weight, Σ h_i f_i = m g, in windows of all recordings;
    a prior holds the sensors alike where the weight does not move.
    """
    if not robot.feet or any(foot.contact == "always" for foot in robot.feet.values()):
        return {}
    weight = robot.mass * GRAVITY
    windows = [each for each in (_windows(recording, weight) for recording in recordings) if len(each)]
    if not windows:
        return {}
    own, other = robot.uncertainty.wrench_gain, float(np.hypot(_mass_deviation(robot), LEAST_DEVIATION))
    apart = np.eye(len(robot.feet)) - 1 / len(robot.feet)
    inverse, covariance = _inverse_gains(windows, apart / max(ALIKE * own, LEAST_GAIN) ** 2)
    stds = np.sqrt(np.diag(apart @ covariance @ apart))
    told_apart = np.abs(apart @ inverse) > NORMAL95 * stds
    together = 1 / float(inverse.mean()) - 1
    errors = {}
    for name, gain, std, alone in zip(robot.feet, inverse, stds, told_apart, strict=True):
        if gain > 0:
            found = GainError(float(1 / gain - 1), float(std), own, other)
            doubted = not (alone or found.sure) and abs(together) > abs(found.share)
            errors[name] = found._replace(share=together) if doubted else found
    return errors


def _inverse_gains(windows: Sequence[Array], alike: Array) -> tuple[Array, Array]:
    """Inverse gains h (feet,) and their covariance: forces over weight (n, feet) of each recording sum up to 1.

    alike: prior precision (feet, feet).
    """
    inverse, covariance = _reweighted(windows, alike, [0.0] * len(windows))
    if max(abs(float((each @ inverse).mean()) - 1) for each in windows) < LOADED:
        return inverse, covariance
    # The robot carries a load in some of them, which is no gain: those that most agree with tell.
    sums = np.array([each.sum(axis=1).mean() for each in windows])
    return _reweighted(windows, alike, np.abs(sums / np.median(sums) - 1).tolist())


def _reweighted(windows: Sequence[Array], alike: Array, hands: Sequence[float]) -> tuple[Array, Array]:
    """The same where each recording's sums may at first be off by what `hands` carry, and later by what they miss."""
    loaded = any(hands)
    for _ in range(REWEIGHTED):
        precision, right = alike.copy(), np.zeros(len(alike))
        for each, hand in zip(windows, hands, strict=True):
            # What is wrong in one window is so in others of its recording: together they count once. Zeros are off
            # wherever the weight is.
            middle, variance = each.mean(axis=0), SCATTER**2 + hand**2
            precision += np.cov(each.T, bias=True) / (BENT**2 + hand**2) + np.outer(middle, middle) / variance
            right += middle / variance
        inverse = np.linalg.solve(precision, right)
        # A hand on the robot carries now more, now less.
        sums = [each @ inverse for each in windows]
        hands = [float(np.hypot(HAND * one.std(), loaded * (one.mean() - 1))) for one in sums]
    return np.asarray(inverse), np.asarray(np.linalg.inv(precision))


def force_gain_notes(robot: RobotModel, errors: Mapping[str, GainError]) -> list[Note]:
    """One warning on the feet whose forces do not agree with the weight beyond doubt; none where all do."""
    sure = {foot: each for foot, each in errors.items() if each.sure}
    if not sure:
        return []
    feet = " and ".join(f"the {foot} foot's {100 * error.share:+.0f} %" for foot, error in sure.items())
    zeros = "or their zeros: read the sensors with the feet in the air"
    whose, gains = (
        "the URDF's",
        "Either its masses are wrong, a load or a rope is not in it, or wrong are the force sensors' gains",
    )
    if robot.weighed is not None:
        whose, gains = "the weighed", "Wrong are the force sensors' gains"
    text = (
        f"vertical forces do not add up to {whose} {robot.mass:.1f} kg: {feet}. {gains}, which stiffness and damping "
        f"follow (their intervals hold both), {zeros}"
    )
    return [Note("force_gain", "warning", text)]


def force_gain_causes(fit: AxisFit, errors: Mapping[str, GainError]) -> list[Cause]:
    """What a foot's numbers may be off by, beyond the usual error of a gain, where its sensor's is in doubt.

    Every term of a model that is linear in its torque follows the gain.
    """
    error = errors.get(fit.foot)
    beyond = 0.0 if error is None else (error.reach / NORMAL95) ** 2 - error.usual**2
    return [Cause("force gain", fit.values, float(np.sqrt(beyond)))] if beyond > 0 else []


def gain_reaches(robot: RobotModel, errors: Mapping[str, GainError]) -> dict[str, float]:
    """Share by which each foot's force sensor may put a number wrong, with 95 % probability."""
    usual = NORMAL95 * robot.uncertainty.wrench_gain
    return {foot: max(errors[foot].reach, usual) if foot in errors else usual for foot in robot.feet}


def torque_gain_causes(fit: AxisFit, gains: Mapping[Axis, TorqueGain]) -> list[Cause]:
    """The same where the torques' own gain about this axis is wrong."""
    return [Cause("torque gain", fit.values, gains[fit.axis].reach / NORMAL95)] if fit.axis in gains else []


def _windows(recording: Recording, weight: float) -> Array:
    """Mean vertical force of each foot over `weight`, in windows in which the feet carry the robot, (n, feet)."""
    forces = np.column_stack([state.force_z for state in recording.raw.values()]) / weight
    half = max(1, round(WINDOW / 2 / recording.period))
    if len(forces) < 2 * half:
        return np.empty((0, forces.shape[1]))
    whole = sliding_window_view(forces, 2 * half, axis=0)[::half] @ (np.hanning(2 * half + 1)[1:] / half)
    carried = whole[whole.sum(axis=1) > CARRIED]
    apart = np.abs(carried.sum(axis=1) - np.median(carried.sum(axis=1))) if len(carried) else np.zeros(0)
    alone = carried[apart < HOISTED_SHARE]
    # A rope or a hand takes over a part of the weight for a while: where all else is alike, that is no gain.
    return np.asarray(alone if len(alone) and float(alone.sum(axis=1).std()) < STEADY else carried)


def _mass_deviation(robot: RobotModel) -> float:
    """Standard deviation of the total mass over itself: the balance's, or the URDF's, each link being off by itself."""
    if robot.weighed is not None:
        return robot.uncertainty.total_mass
    masses = np.array([inertia.mass for inertia in robot.model.inertias])
    return robot.uncertainty.link_mass * float(np.linalg.norm(masses) / masses.sum())
