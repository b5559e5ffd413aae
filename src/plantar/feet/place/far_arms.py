"""A bush that the logs show far from its place, where the robot file's own doubt is too wide to call that a fault."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.feet.place.place_notes import FARTHEST
from plantar.feet.regression.axis import AxisFit
from plantar.notes import Note

FAR_ARM = "bush_arm_far"


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
