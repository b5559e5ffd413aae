"""Gains of the torque channels: what the feet's torques must be for the robot to move as it does.

A torque that reads a tenth too large makes stiffness and damping a tenth too large, and nothing in a foot's own torque
and angle shows it. The whole body does: forces, torques and their places must give the moments of eq. 1's base rows.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES, Array, Axis
from plantar.estimation.quantiles import MOST_FREEDOM
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.load_errors import LEAST_GAIN
from plantar.sensors.moments.moment_fit import MomentFit, Part, is_wrong

APART = 2.0  # times the deviation of the feet's mean: a foot's gain known so well is judged by itself
ALSO = 0.5  # of the share about one axis, from which on the other axis' share is nearer to it than to none
REVERSED = -1.5  # share: a torque of the wrong sign reads 200 % too little
WORTH_SAYING = 0.03  # share: what the force sensors' makers promise is seldom better
# Share up to which numbers are widened by a gain and keep their verdicts: simulated robots with right torques, under
# wrong URDFs and with late encoders, show up to 0.05.
MAY_BE_CHANCE = 0.06


class TorqueGain(NamedTuple):
    """By which share the feet's torques about an axis read too much on average, with its deviation, and each foot's.

    apart: whether each foot's is known about as well as the mean. Where both feet turn alike it is known far worse.
    """

    mean: float
    std: float
    shares: Mapping[str, float]
    apart: bool = False

    @property
    def reach(self) -> float:
        """By which share any foot's torque may be off: all that is missing is one foot's, where none is known apart."""
        beyond = NORMAL95 * self.std
        alone = len(self.shares) * (abs(self.mean) + beyond)
        return max(map(abs, self.shares.values())) + beyond if self.apart else alone


def torque_gains(robot: RobotModel, fit: MomentFit | None) -> dict[Axis, TorqueGain]:
    """The torques' gains about each axis about which the moments do not balance with gains as they should be."""
    if fit is None:
        return {}
    values, feet = fit.values, len(robot.feet)
    usual = max(robot.uncertainty.wrench_gain, LEAST_GAIN)
    parts = [*fit.parts, Part(usual**2 * np.eye(len(values)), MOST_FREEDOM)]
    mean = _mean_gains(np.sum([part.covariance for part in parts], axis=0), feet)
    weights = np.vstack([mean, np.eye(2 * feet, len(values))])
    shares = weights @ values
    parts = [Part(weights @ part.covariance @ weights.T, part.freedom) for part in parts]
    stds, axes = np.sqrt(np.sum([np.diag(part.covariance) for part in parts], axis=0)), len(ROTATIONAL_AXES)
    large = np.abs([_share(share) for share in shares]) > WORTH_SAYING
    wrong = large & [is_wrong(shares, parts, [place]) for place in range(len(shares))]
    # Where the feet turn alike, what nothing explains passes for one foot's torques against the other's.
    apart = (stds[axes:].reshape(axes, feet) < APART * stds[:axes, None]).all(axis=1)
    about = wrong[:axes] | (apart & wrong[axes:].reshape(axes, feet).any(axis=1))
    # One foot's torques that are off about both axes show less about each than about both together.
    if not about.any():
        about[:] = large[:axes].any() and is_wrong(shares, parts, list(range(axes)))
    # An amplifier, a unit or a place is wrong about both axes: the other one is in doubt unless it looks right itself.
    if about.any():
        wrong_by = shares[:axes][about].mean()
        about |= shares[:axes] * wrong_by > ALSO * wrong_by**2
    return {
        axis: TorqueGain(
            _share(shares[place]),
            float(stds[place]),
            {foot: _share(values[place * feet + number]) for number, foot in enumerate(robot.feet)},
            bool(apart[place]),
        )
        for place, axis in enumerate(ROTATIONAL_AXES)
        if about[place]
    }


def _mean_gains(covariance: Array, feet: int) -> Array:
    """Weights (axes, k) by which coefficients make the feet's mean gain about each axis, with the least variance.

    The mean, since the feet's difference is hardly known: both feet turn alike, so that a moment of a few newton-metres
    which nothing here explains passes for one foot's torques too large by half and the other's too small by half.
    """
    weights = np.zeros((len(ROTATIONAL_AXES), len(covariance)))
    for place, row in enumerate(weights):
        mine = slice(place * feet, (place + 1) * feet)
        best = np.linalg.solve(covariance[mine, mine], np.ones(feet))
        row[mine] = best / best.sum()
    return weights


def _share(missing: float) -> float:
    """By which share a torque reads too much that must be larger by the share `missing`."""
    return float(-missing / (1 + missing))


def torque_gain_notes(gains: Mapping[Axis, TorqueGain]) -> dict[Axis, Note]:
    """A note for each axis about which the feet's torques do not seem right; a warning where they cannot be."""
    notes = {}
    for axis, found in gains.items():
        opposite = any(share < REVERSED for share in found.shares.values())
        if found.apart or opposite:
            read = " and ".join(
                f"the {foot}'s read {1 + share:.2f} times" for foot, share in found.shares.items()
            )
            read += " what they should"
        else:
            read = (
                f"together they read {1 + found.mean:.2f} ± {NORMAL95 * found.std:.2f} times what they should (95 %; "
                f"one foot's alone may be off by {100 * found.reach:.0f} %)"
            )
        text = (
            f"{axis}: the feet's torques do not give the moments that the robot's motion needs: {read}, and stiffness "
            f"and damping follow them. Check {'sign, ' * opposite}unit and calibration of the torque channels, and in "
            "the robot file where each force sensor measures (wrench: xyz) and where the IMU sits (imu: link, xyz): a "
            "place that is wrong looks the same"
        )
        largest = max(map(abs, found.shares.values())) if found.apart else abs(found.mean)
        notes[axis] = Note("torque_gain", "warning" if largest > MAY_BE_CHANCE else "info", text)
    return notes
