"""A force sensor with hysteresis: what it reads stays behind at each turn of the motion, at any speed.

torque = K·angle + C·rate - hysteresis·sign(rate) + offset. Rubber with dry friction pushes the other way: of a passive
bush, the term is never negative. Spring and damper alone take it for less damping.
"""

from __future__ import annotations

import numpy as np

from plantar.conventions import NORMAL95, ROTATIONAL_AXES
from plantar.feet.assess.late_recordings import RATE
from plantar.feet.fit.hidden_memory import has_memory
from plantar.feet.place.misread_joints import PART
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.notes import Note

# Of the fast rate (98th percentile), within which its sign changes: behind a filter it is no step.
SOFT = 0.02
SURE = 4.0  # deviations of the hysteresis: of healthy feet it is below 3
HYSTERESIS = "sensor_hysteresis"


def hysteresis_notes(tangent: Tangent, wide: AxisFit) -> list[Note]:
    """A warning where a standing foot's torque stays behind its angle by the same amount at any speed, and that moves
    its damping far within the interval of `wide`: there is more behind it.
    """
    if tangent.steps or has_memory(wide.model):
        return []
    column = ROTATIONAL_AXES.index(wide.axis)
    rates = tangent.rows(lambda one: one.bushes[wide.foot].rate[:, column])
    fast = float(np.percentile(np.abs(np.concatenate(rates)), 98))
    if fast == 0:
        return []
    signs = [np.tanh(rate / (SOFT * fast))[:, None] for rate in rates]
    found = tangent.beside(signs).least_squares
    behind = -float(found.values[-1])
    if behind < SURE * float(found.std[-1]):
        return []
    moved = float(found.values[RATE] - tangent.least_squares.values[RATE])
    if abs(moved) < PART * NORMAL95 * float(wide.std[RATE]):
        return []
    text = (
        f"{wide.foot} {wide.axis}: the torque stays {behind:.2g} N.m behind at each turn of the motion, at any speed: "
        "hysteresis of the force sensor, which makes the damping too small (valid: a sensor whose hysteresis is small "
        "beside its torques; or larger motions)"
    )
    return [Note(HYSTERESIS, "warning", text)]
