"""A bush that the logs show far from its place, where the robot file's own doubt is too wide to call that a fault."""

from __future__ import annotations

import numpy as np

from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.place_notes import FARTHEST
from plantar.notes import Note

FAR_ARM = "bush_arm_far"


def far_arms(fit: AxisFit) -> list[Note]:
    """A warning where the torque's moment arm is longer than any oversight; none else.

    A torque that grows with the load looks like a bush aside of its place, and so does a force sensor that stands
    elsewhere or whose torque channels read a share of its force.
    """
    aside, above = np.abs(fit.moment_arms) > FARTHEST[:2]
    if not (aside or above):
        return []
    beside = "forward or backward" if fit.axis == "pitch" else "to the side"
    told = [f"{1e3 * abs(fit.moment_arms[0]):.0f} mm {beside}"] if aside else []
    told += [f"{1e3 * abs(fit.moment_arms[1]):.0f} mm above or below"] if above else []
    key = f"feet.{fit.foot}"
    text = (
        f"{fit.foot} {fit.axis}: the torque turns about a point {' and '.join(told)} of its place in the robot file. "
        f"Corrected, but no bush is so far off: measure {key}.wrench and {key}.bush first, the numbers depend on them"
    )
    return [Note(FAR_ARM, "warning", text)]
