"""Torques behind a slow low-pass: what its loss of fast motion makes of spring and damper.

Its lag is in the delay, but not what it takes off: seen at f² over its corner's, a torque lacks that share of what it
changes by. Slow tilts hardly show it; the steps of a walk move the spring by some per cent.
"""

from __future__ import annotations

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, UNIFORM, Array
from plantar.feet.interval_width.cause import Cause
from plantar.feet.recording import Recording
from plantar.feet.regression.tangent import Tangent
from plantar.sensors.bandwidth import Fading
from plantar.signals.filters import differentiate

NAME = "low-pass"


def fading_causes(tangent: Tangent, found: Fading | None) -> list[Cause]:
    """By anything up to what the `found` low-pass takes off; none without one.

    A gain whose logarithm is s f² makes of a torque τ, for s f² << 1, τ - s/(4π²) d²τ/dt².
    """
    if found is None:
        return []
    foot, column = tangent.fit.foot, ROTATIONAL_AXES.index(tangent.fit.axis)

    def bent(one: Recording) -> Array:
        torque = one.bushes[foot].torque[:, column]
        return np.nan_to_num(differentiate(differentiate(torque, one.period), one.period)) / (2 * np.pi) ** 2

    return [Cause(NAME, tangent.effect(tangent.rows(bent)), UNIFORM * abs(found.slope))]
