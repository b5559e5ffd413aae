"""Gains of the force sensors beside the URDF's weight: what stands on the feet is what the robot weighs.

Stiffness and damping follow a sensor's gain exactly, and nothing in a foot's own torque and angle shows it. The weight
does: where it moves from foot to foot, it shows each foot's gain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import GRAVITY, Array, Axis
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.systematic import Cause
from plantar.feet.recording import Recording
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.moment_balance import TorqueGain

WINDOW = 1.0  # s, over which accelerations average out
CARRIED = 0.5  # of the weight: with less on its feet, the robot hangs or its sensors were zeroed under load
SCATTER = 0.02  # of the weight, by which a window's sum may be off: accelerations, zeros, a hand on the robot
ALIKE = 3.0  # deviations of a gain, by which a robot's force sensors differ where one of them has a fault
SURELY_ALIKE = 1e-4  # share: of sensors without any gain error, and a prior that stays finite
NORMAL95 = 1.96  # deviations that a 95 % interval reaches
LEAST_DEVIATION = 0.02  # of the weight: what a hand on the robot may carry of it through whole logs
WITH_OTHERS = 0.5  # deviations of a gain that counts beside another foot's that is off the same way
BEYOND_DOUBT = 3.0  # deviations of what the robot file allows for gains and masses


class GainError(NamedTuple):
    """By which `share` a sensor seems to read too much, and the `deviation` of that which the robot file allows."""

    share: float
    deviation: float

    @property
    def sure(self) -> bool:
        """Whether the robot file's uncertainty cannot explain it."""
        return abs(self.share) > BEYOND_DOUBT * self.deviation


def force_gain_errors(robot: RobotModel, recordings: Sequence[Recording]) -> dict[str, GainError]:
    """By foot, where its sensor reads more or less than the weight by more than one deviation of what may be.

    Beside such a foot, another that is off the same way counts from WITH_OTHERS deviations on: what a wrong mass or a
    common amplifier does shows more at one foot and less at the other.

    Gains 1/h are those for which the feet's forces add up to the weight, Σ h_i f_i = m g, in windows of all recordings;
    a prior holds the sensors alike where the weight does not move.
    """
    if not robot.feet or any(foot.contact == "always" for foot in robot.feet.values()):
        return {}
    weight = robot.mass * GRAVITY
    shares = np.vstack([_windows(recording, weight) for recording in recordings])
    if len(shares) == 0:
        return {}
    feet, own = len(robot.feet), robot.uncertainty.wrench_gain
    alike = (np.eye(feet) - 1 / feet) / max(ALIKE * own, SURELY_ALIKE)
    rows, targets = np.vstack([shares / SCATTER, alike]), np.repeat([1 / SCATTER, 0.0], [len(shares), feet])
    inverse = np.linalg.lstsq(rows, targets, rcond=None)[0]
    deviation = float(np.linalg.norm([own, _mass_deviation(robot), LEAST_DEVIATION]))
    found = {
        name: GainError(1 / float(gain) - 1, deviation)
        for name, gain in zip(robot.feet, inverse, strict=True)
        if gain > 0
    }
    beyond = {error.share > 0 for error in found.values() if abs(error.share) > deviation}
    least = WITH_OTHERS * deviation
    return {
        name: error
        for name, error in found.items()
        if (error.share > 0) in beyond and abs(error.share) > least
    }


def force_gain_notes(robot: RobotModel, errors: Mapping[str, GainError]) -> list[Note]:
    """One warning on the feet whose forces do not agree with the weight beyond doubt; none where all do."""
    sure = {foot: each for foot, each in errors.items() if each.sure}
    if not sure:
        return []
    feet = " and ".join(f"the {foot} foot's {100 * error.share:+.0f} %" for foot, error in sure.items())
    text = (
        f"vertical forces do not add up to the URDF's {robot.mass:.1f} kg: {feet}. Either the URDF's masses are wrong, "
        "or the force sensors' gains, which stiffness and damping follow (their intervals hold both), or their zeros. "
        "Weigh the robot, and read the sensors with the feet in the air"
    )
    return [Note("force_gain", "warning", text)]


def force_gain_causes(fit: AxisFit, errors: Mapping[str, GainError]) -> list[Cause]:
    """What a foot's numbers may be off by where its sensor's gain is in doubt: by all of it, or by nothing.

    Every term of a model that is linear in its torque follows the gain.
    """
    if fit.foot not in errors:
        return []
    error = errors[fit.foot]
    reach = abs(error.share / (1 + error.share)) + (0.0 if error.sure else error.deviation)
    return [Cause("force gain", fit.values, reach / NORMAL95)]


def torque_gain_causes(fit: AxisFit, gains: Mapping[Axis, TorqueGain]) -> list[Cause]:
    """The same where the torques' own gain about this axis is wrong."""
    return [Cause("torque gain", fit.values, gains[fit.axis].reach / NORMAL95)] if fit.axis in gains else []


def _windows(recording: Recording, weight: float) -> Array:
    """Mean vertical force of each foot over `weight`, in windows in which the feet carry the robot, (n, feet)."""
    forces = np.column_stack([state.force_z for state in recording.raw.values()]) / weight
    length = max(1, round(WINDOW / recording.period))
    whole = forces[: len(forces) // length * length].reshape(-1, length, forces.shape[1]).mean(axis=1)
    return np.asarray(whole[whole.sum(axis=1) > CARRIED])


def _mass_deviation(robot: RobotModel) -> float:
    """Standard deviation of the URDF's total mass over itself, each link's mass being off by itself."""
    masses = np.array([inertia.mass for inertia in robot.model.inertias])
    return robot.uncertainty.link_mass * float(np.linalg.norm(masses) / masses.sum())
