"""Torques behind a slow low-pass: what its loss of fast motion makes of spring and damper.

Its lag is in the delay, but not what it takes off: seen at f² over its corner's, a torque lacks that share of what it
changes by. Slow tilts hardly show it; the steps of a walk move the spring by some per cent.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, UNIFORM
from plantar.estimation import Block, effect_of, influences_of
from plantar.feet.interval_width.cause import Cause
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import recordings_of
from plantar.sensors.bandwidth import Fading
from plantar.signals.filters import differentiate

NAME = "low-pass"


def fading_causes(
    fit: AxisFit,
    blocks: Sequence[Block],
    recordings: Sequence[Recording],
    found: Fading | None,
    shared: bool,
) -> list[Cause]:
    """By anything up to what the `found` low-pass takes off; none without one. blocks: `tangent_blocks`.

    A gain whose logarithm is s f² makes of a torque τ, for s f² << 1, τ - s/(4π²) d²τ/dt².
    """
    if found is None:
        return []
    column = ROTATIONAL_AXES.index(fit.axis)
    changes = []
    for one in recordings_of(blocks, recordings):
        bent = differentiate(differentiate(one.bushes[fit.foot].torque[:, column], one.period), one.period)
        changes.append(np.nan_to_num(bent[one.rows(fit.foot)]) / (2 * np.pi) ** 2)
    effect = effect_of(influences_of(blocks, shared_offset=shared), changes)
    return [Cause(NAME, effect, UNIFORM * abs(found.slope))]
