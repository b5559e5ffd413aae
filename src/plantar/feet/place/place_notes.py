"""What is said of a bush, a force sensor or an IMU that is not where, or not as, the robot file says."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import NORMAL95, SHOWN, Array
from plantar.feet.regression.axis import AxisFit
from plantar.notes import Note

WORTH_SAYING = 0.005  # m: a centre that is nearer to its place is within what drawings get wrong
TURN_WORTH_SAYING = 0.02  # rad: of a mount, likewise
BUSH_WORTH_SAYING = 0.035  # of the other axis' torque in both axes: mounts a degree off show half as much
STEPS_WORTH_SAYING = 0.012  # rad, of what stances show: ten times what healthy feet do
# m, m, rad: corrected without doubting all the rest.
FARTHEST = np.array([0.04, 0.04, 0.12, 0.12, 0.12, 0.12])
PLACE = "bush_place"
FAR = "bush_place_far"
BUSH_TURNED = "bush_turned"
FAR_ARM = "bush_arm_far"


def place_notes(fit: AxisFit, place: Array, std: Array, prior: Array) -> list[Note]:
    """A warning where the centre is clearly elsewhere, or a sensor turned; none else.

    place, std, prior: (6,), of the centre aside and above [m], of the force sensor about the vertical and of the IMU
    about its x, y and z [rad].
    """
    least = np.array([WORTH_SAYING] * 2 + [TURN_WORTH_SAYING] * 4)
    aside, above, turned, *imu = np.abs(place) > np.maximum(SHOWN * np.hypot(prior, std), least)
    (x, z), (of_x, of_z) = 1e3 * place[:2], 1e3 * NORMAL95 * std[:2]
    degrees, of = np.degrees(np.abs(place)), np.degrees(NORMAL95 * std)
    told, key = [], f"feet.{fit.foot}"
    if aside:
        where = "forward or backward" if fit.axis == "pitch" else "to the side"
        told.append(f"about a point {abs(x):.1f} ± {of_x:.1f} mm {where} of {key}.bush and {key}.wrench")
    if above:
        where = "above" if z > 0 else "below"
        told.append(f"about a point {abs(z):.1f} ± {of_z:.1f} mm {where} {key}.bush and {key}.wrench")
    if turned:
        beside = f"{degrees[2]:.1f} ± {of[2]:.1f} deg beside {key}.wrench.rpy or imu.rpy"
        told.append(f"about an axis {beside}")
    for row, clear in enumerate(imu, start=3):
        if clear:
            told.append(
                f"as if the IMU were turned by {degrees[row]:.1f} ± {of[row]:.1f} deg about its {'xyz'[row - 3]} axis, "
                "beside imu.rpy"
            )
    if not told:
        return []
    text = f"{fit.foot} {fit.axis}: the torques turn {'; '.join(told)} (95 %): corrected"
    if (np.abs(place) > FARTHEST).any():
        return [Note(FAR, "warning", f"{text}, but that is far for an oversight; check the robot file")]
    return [Note(PLACE, "warning", f"{text}; check the robot file")]


def turned_bush(foot: str, pitch: float, roll: float, least: float) -> Note | None:
    """A warning where the other axis' torque shows in both axes with one sign: the bush's own axes are elsewhere.

    A turned sensor gives each axis a share of the other's torque with opposite signs, a turned bush, of two
    stiffnesses, with the same one. pitch, roll: the shares of the other's torque; least: smaller ones say nothing.
    """
    of_sensor, of_bush = (pitch - roll) / 2, (pitch + roll) / 2
    if abs(of_bush) < max(least, abs(of_sensor)):
        return None
    text = (
        f"{foot}: pitch's torque shows in roll and roll's in pitch as if the bush were turned about the "
        f"vertical: check feet.{foot}.bush.rpy"
    )
    return Note(BUSH_TURNED, "warning", text)


def far_arms(fits: Sequence[AxisFit]) -> list[Note]:
    """One warning on the axes whose torque has a moment arm longer than any oversight; none where there is none.

    A torque that grows with the load looks like a bush aside of its place, and so does a force sensor that stands
    elsewhere or whose torque channels read a share of its force.
    """
    told = [(fit, where) for fit in fits if (where := _where(fit))]
    if not told:
        return []
    axes = ", ".join(f"{fit.foot} {fit.axis} {where}" for fit, where in told)
    keys = ", ".join(
        f"feet.{foot}.wrench and feet.{foot}.bush" for foot in dict.fromkeys(fit.foot for fit, _ in told)
    )
    text = (
        f"the torque turns about a point far from the bush's place in the robot file: {axes}. Corrected, but no bush "
        f"is so far off: measure {keys} first, the numbers depend on them"
    )
    return [Note(FAR_ARM, "warning", text)]


def _where(fit: AxisFit) -> str:
    """How far from its place, where that is farther than any oversight."""
    aside, above = np.abs(fit.moment_arms) > FARTHEST[:2]
    beside = "forward or backward" if fit.axis == "pitch" else "to the side"
    told = [f"{1e3 * abs(fit.moment_arms[0]):.0f} mm {beside}"] if aside else []
    told += [f"{1e3 * abs(fit.moment_arms[1]):.0f} mm above or below"] if above else []
    return " and ".join(told)
